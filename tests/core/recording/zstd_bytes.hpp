#pragma once

#include <gtest/gtest.h>
#include <zstd.h>

#include <string>

namespace sweepscope::test {

/// One frame of Zstandard, as rosbag2 packs files and messages.
inline std::string packed_by_zstd(const std::string& plain) {
  std::string packed(ZSTD_compressBound(plain.size()), '\0');
  const std::size_t bytes = ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), 1);
  EXPECT_FALSE(ZSTD_isError(bytes));
  packed.resize(bytes);
  return packed;
}

}  // namespace sweepscope::test
