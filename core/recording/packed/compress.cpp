#include "core/recording/packed/compress.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <array>
#include <cstring>
#include <new>

namespace sweepscope {
namespace {

constexpr int kZstdLevel = 3;
constexpr int kBz2Level = 9;

std::string bz2(std::string_view bytes) {
  std::string out(bytes.size() + bytes.size() / 100 + 600, '\0');  // libbz2's own bound
  auto length = static_cast<unsigned>(out.size());
  // libbz2 reads from its source only, though its type does not say so.
  const int code = BZ2_bzBuffToBuffCompress(out.data(), &length, const_cast<char*>(bytes.data()),
                                            static_cast<unsigned>(bytes.size()), kBz2Level, 0, 30);
  if (code != BZ_OK) throw std::bad_alloc();
  out.resize(length);
  return out;
}

std::string lz4(std::string_view bytes) {
  LZ4F_preferences_t preferences{};
  preferences.frameInfo.blockSizeID = LZ4F_max1MB;
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  std::string out(LZ4F_compressFrameBound(bytes.size(), &preferences), '\0');
  const std::size_t length =
      LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), &preferences);
  if (LZ4F_isError(length)) throw std::bad_alloc();
  out.resize(length);
  return out;
}

std::string zstd(std::string_view bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t length = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kZstdLevel);
  if (ZSTD_isError(length)) throw std::bad_alloc();
  out.resize(length);
  return out;
}

constexpr std::size_t kSlices = 8;
using CrcTables = std::array<std::array<std::uint32_t, 256>, kSlices>;

/// For eight bytes a step: table k is that of a byte with k zero bytes after it.
constexpr CrcTables crc_tables() {
  constexpr std::uint32_t kPolynomial = 0xEDB88320;
  CrcTables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? kPolynomial : 0);
    tables[0][byte] = crc;
  }
  for (std::size_t k = 1; k < kSlices; ++k)
    for (std::size_t byte = 0; byte < 256; ++byte)
      tables[k][byte] = (tables[k - 1][byte] >> 8) ^ tables[0][tables[k - 1][byte] & 0xFF];
  return tables;
}

}  // namespace

std::string compressed(Compression compression, std::string_view bytes) {
  switch (compression) {
    case Compression::kNone:
      break;
    case Compression::kBz2:
      return bz2(bytes);
    case Compression::kLz4:
      return lz4(bytes);
    case Compression::kZstd:
      return zstd(bytes);
  }
  return std::string(bytes);
}

std::uint32_t crc32_of(std::span<const std::byte> bytes) {
  static constexpr CrcTables kTables = crc_tables();
  std::uint32_t crc = 0xFFFFFFFF;
  while (bytes.size() >= kSlices) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), sizeof word);
    word ^= crc;
    crc = 0;
    for (std::size_t k = 0; k < kSlices; ++k) crc ^= kTables[kSlices - 1 - k][(word >> (8 * k)) & 0xFF];
    bytes = bytes.subspan(kSlices);
  }
  for (const std::byte byte : bytes)
    crc = (crc >> 8) ^ kTables[0][(crc ^ static_cast<std::uint32_t>(byte)) & 0xFF];
  return ~crc;
}

}  // namespace sweepscope
