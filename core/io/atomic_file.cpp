#include "core/io/atomic_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace sweepscope {

AtomicFile::AtomicFile(const std::filesystem::path& path)
    : path_(path), part_path_(path.string() + ".part"), file_(std::fopen(part_path_.c_str(), "wb")) {}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  file_.reset();
  std::remove(part_path_.c_str());
}

tl::unexpected<Error> AtomicFile::failed(std::string_view doing) const {
  const int reason = errno;
  return failure(ExitCode::kWrongUsage,
                 fmt::format("{}: cannot be {}: {}", path_.string(), doing, std::strerror(reason)));
}

Result<AtomicFile> AtomicFile::create(const std::filesystem::path& path) {
  std::error_code ignored;
  if (path.filename().empty() || std::filesystem::is_directory(path, ignored)) {
    return failure(ExitCode::kWrongUsage,
                   fmt::format("{}: cannot be written: it is a folder", path.string()));
  }
  AtomicFile file(path);
  if (!file.file_) return file.failed("created");
  return file;
}

Result<void> AtomicFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) return failed("written");
  return {};
}

Result<void> AtomicFile::commit() {
  if (std::fflush(file_.get()) != 0) return failed("written");
  if (std::fclose(file_.release()) != 0 || std::rename(part_path_.c_str(), path_.c_str()) != 0) {
    auto error = failed("written");
    std::remove(part_path_.c_str());
    return error;
  }
  return {};
}

Result<void> write_file(const std::filesystem::path& path, std::string_view bytes) {
  return AtomicFile::create(path).and_then([&](AtomicFile&& file) -> Result<void> {
    if (auto written = file.write(bytes); !written) return written;
    return file.commit();
  });
}

Result<std::string> read_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return unreadable(fmt::format("{}: no such file", path.string()));
  if (!std::filesystem::is_regular_file(status)) {
    return unreadable(fmt::format("{}: not a regular file", path.string()));
  }
  const auto size = std::filesystem::file_size(path, error);
  std::ifstream stream(path, std::ios::binary);
  if (error || !stream) {
    return unreadable(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
  }
  std::string bytes(size, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

}  // namespace sweepscope
