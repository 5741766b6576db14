#include "core/recording/packed/decompress.hpp"

#include <bzlib.h>
#include <gtest/gtest.h>
#include <lz4frame.h>

#include <algorithm>

namespace sweepscope {
namespace {

using Bytes = std::vector<std::byte>;

Bytes pack(Compression compression, const Bytes& plain) {
  Bytes packed(plain.size() + plain.size() / 50 + 1000);
  if (compression == Compression::kBz2) {
    auto bytes = static_cast<unsigned>(packed.size());
    EXPECT_EQ(BZ2_bzBuffToBuffCompress(reinterpret_cast<char*>(packed.data()), &bytes,
                                       reinterpret_cast<char*>(const_cast<std::byte*>(plain.data())),
                                       static_cast<unsigned>(plain.size()), 9, 0, 0),
              BZ_OK);
    packed.resize(bytes);
  } else {
    packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), plain.data(), plain.size(), nullptr));
  }
  return packed;
}

Bytes sample_bytes(std::size_t bytes) {
  Bytes plain(bytes);
  std::uint32_t state = 1;
  for (std::byte& byte : plain) byte = static_cast<std::byte>((state = state * 1664525 + 1013904223) >> 29);
  return plain;
}

class Decompress : public testing::TestWithParam<Compression> {};
INSTANTIATE_TEST_SUITE_P(Each, Decompress, testing::Values(Compression::kBz2, Compression::kLz4));

TEST_P(Decompress, GivesBackWhatWasPacked) {
  const Bytes plain = sample_bytes(3'000'000);
  Bytes buffer;
  const auto result = decompress(GetParam(), pack(GetParam(), plain), 6'000'000, buffer);
  EXPECT_EQ(result.problem, "");
  EXPECT_TRUE(std::ranges::equal(result.bytes, plain));
}

TEST_P(Decompress, AcceptsExactlyTheLimit) {
  const Bytes plain = sample_bytes(100'000);
  Bytes buffer;
  const auto result = decompress(GetParam(), pack(GetParam(), plain), plain.size(), buffer);
  EXPECT_EQ(result.problem, "");
  EXPECT_EQ(result.bytes.size(), plain.size());
}

TEST_P(Decompress, NeverTakesMoreThanTheLimit) {
  constexpr std::size_t kMax_bytes = 3'000'000;
  const Bytes bomb = pack(GetParam(), Bytes(20'000'000));
  ASSERT_LT(bomb.size(), 400'000U);
  Bytes buffer;
  const auto result = decompress(GetParam(), bomb, kMax_bytes, buffer);
  EXPECT_EQ(result.problem, "it unpacks to more than 3000000 bytes");
  EXPECT_EQ(result.bytes.size(), kMax_bytes);
  EXPECT_LE(buffer.capacity(), kMax_bytes);
}

TEST_P(Decompress, GivesWhatCameBeforeTheCut) {
  const Bytes plain = sample_bytes(3'000'000);
  Bytes packed = pack(GetParam(), plain);
  packed.resize(packed.size() / 2);
  Bytes buffer;
  const auto result = decompress(GetParam(), packed, 6'000'000, buffer);
  EXPECT_NE(result.problem, "");
  EXPECT_GT(result.bytes.size(), 0U);
  EXPECT_TRUE(std::equal(result.bytes.begin(), result.bytes.end(), plain.begin()));
}

TEST_P(Decompress, SaysWhatIsNoCompressedData) {
  Bytes buffer;
  const auto result = decompress(GetParam(), sample_bytes(1000), 6'000'000, buffer);
  EXPECT_NE(result.problem.find("is damaged"), std::string::npos);
  const auto empty = decompress(GetParam(), Bytes(), 6'000'000, buffer);
  EXPECT_NE(empty.problem.find("ends too early"), std::string::npos);
}

}  // namespace
}  // namespace sweepscope
