#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>

#include "core/error.hpp"

namespace sweepscope {

/// A regular file that is read from the front. Its size is known, so that lengths in the file can be checked
/// against it.
class InputFile {
 public:
  /// Fails, with one sentence, if the file does not exist, is a folder or a device, is empty, or cannot be
  /// read.
  static Result<InputFile> open(const std::filesystem::path& path);

  std::uint64_t size() const { return size_; }
  std::uint64_t position() const { return position_; }
  std::uint64_t left() const { return size_ - position_; }
  /// Fills `bytes` as far as the file goes; returns the number of bytes.
  std::size_t read(std::span<std::byte> bytes);
  /// Moves to a position, at most the end of the file.
  void seek(std::uint64_t position);

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_{nullptr, std::fclose};
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
};

}  // namespace sweepscope
