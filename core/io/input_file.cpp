#include "core/io/input_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace sweepscope {

Result<InputFile> InputFile::open(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found)
    return unreadable(fmt::format("{}: no such file", path.string()));
  if (error) return unreadable(fmt::format("{}: {}", path.string(), error.message()));
  if (fs::is_directory(status)) {
    return unreadable(fmt::format("{}: is a folder, not a file", path.string()));
  }
  if (!fs::is_regular_file(status))
    return unreadable(fmt::format("{}: is not a regular file", path.string()));
  InputFile input;
  input.file_.reset(std::fopen(path.c_str(), "rb"));
  if (!input.file_) return unreadable(fmt::format("{}: {}", path.string(), std::strerror(errno)));
  input.size_ = fs::file_size(path, error);
  if (error) return unreadable(fmt::format("{}: {}", path.string(), error.message()));
  if (input.size_ == 0) return unreadable(fmt::format("{}: is empty", path.string()));
  return input;
}

std::size_t InputFile::read(std::span<std::byte> bytes) {
  const std::size_t wanted = static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), left()));
  const std::size_t got = std::fread(bytes.data(), 1, wanted, file_.get());
  position_ += got;
  return got;
}

void InputFile::seek(std::uint64_t position) {
  position = std::min(position, size_);
  if (position == position_) return;
  if (fseeko(file_.get(), static_cast<off_t>(position), SEEK_SET) == 0) position_ = position;
}

}  // namespace sweepscope
