#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>

#include "core/error.hpp"

namespace sweepscope {

/// A regular file that is read from the front, with its size known before anything is believed that is
/// written in it.
class InputFile {
 public:
  /// Refuses, in one sentence, what does not exist, is a folder or a device, is empty, or may not be read.
  static Result<InputFile> open(const std::filesystem::path& path);

  std::uint64_t size() const { return size_; }
  std::uint64_t position() const { return position_; }
  std::uint64_t left() const { return size_ - position_; }
  /// Fills `bytes` as far as the file goes, and gives how many there were.
  std::size_t read(std::span<std::byte> bytes);
  /// Moves to a place, at most to the end.
  void seek(std::uint64_t position);

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_{nullptr, std::fclose};
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
};

}  // namespace sweepscope
