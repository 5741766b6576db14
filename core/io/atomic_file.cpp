#include "core/io/atomic_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/io/unfinished_files.hpp"

namespace sweepscope {

namespace {

constexpr std::string_view kBeside = ".part";

// Where the bytes go first: beside the file that links lead to. What is there and no regular file, such as
// /dev/stdout or a named pipe, cannot be replaced: it is written as the bytes come.
std::filesystem::path first_path(const std::filesystem::path& path) {
  std::error_code error;
  const auto target = std::filesystem::canonical(path, error);
  if (error) return path.string().append(kBeside);
  if (!std::filesystem::is_regular_file(target, error)) return target;
  return target.string().append(kBeside);
}

// The regular file's own path; empty where it is written in place.
std::filesystem::path target_of(const std::filesystem::path& part) {
  const std::string path = part.string();
  return path.ends_with(kBeside) ? path.substr(0, path.size() - kBeside.size()) : std::string();
}

void discard(const std::filesystem::path& part) {
  if (target_of(part).empty()) return;
  std::remove(part.c_str());
  forget_unfinished(part);
}

bool is_folder(const std::filesystem::path& path) {
  std::error_code ignored;
  return path.filename().empty() || std::filesystem::is_directory(path, ignored);
}

tl::unexpected<Error> refused_folder(const std::filesystem::path& path) {
  return failure(ExitCode::kWrongUsage, fmt::format("{}: cannot be written: it is a folder", path.string()));
}

tl::unexpected<Error> failed_to(std::string_view done, const std::filesystem::path& path) {
  const int reason = errno;
  return failure(ExitCode::kWrongUsage,
                 fmt::format("{}: cannot be {}: {}", path.string(), done, std::strerror(reason)));
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path), part_path_(first_path(path)) {
  if (!target_of(part_path_).empty()) remember_unfinished(part_path_);
  file_.reset(std::fopen(part_path_.c_str(), "wb"));
  if (!file_) forget_unfinished(part_path_);
}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  file_.reset();
  discard(part_path_);
}

Result<AtomicFile> AtomicFile::create(const std::filesystem::path& path) {
  if (is_folder(path)) return refused_folder(path);
  AtomicFile file(path);
  if (!file.file_) return failed_to("created", path);
  return file;
}

Result<void> AtomicFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
    return failed_to("written", path_);
  return {};
}

Result<void> AtomicFile::commit() {
  const std::filesystem::path target = target_of(part_path_);
  if (std::fflush(file_.get()) != 0) return failed_to("written", path_);
  // Some file systems say only now that they are full.
  if (!target.empty() && fsync(fileno(file_.get())) != 0) return failed_to("written", path_);
  if (std::fclose(file_.release()) != 0 ||
      (!target.empty() && std::rename(part_path_.c_str(), target.c_str()) != 0)) {
    auto error = failed_to("written", path_);
    discard(part_path_);
    return error;
  }
  forget_unfinished(part_path_);
  return {};
}

Result<void> check_writable(const std::filesystem::path& path) {
  if (is_folder(path)) return refused_folder(path);
  const std::filesystem::path part = first_path(path);
  if (target_of(part).empty()) return {};
  const std::filesystem::path folder = part.has_parent_path() ? part.parent_path() : ".";
  if (access(folder.c_str(), W_OK | X_OK) != 0) return failed_to("created", path);
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
