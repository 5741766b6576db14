#include "core/recording/packed/compress.hpp"

#include <bzlib.h>
#include <libdeflate.h>
#include <lz4frame.h>
#include <zstd.h>

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
  return libdeflate_crc32(0, bytes.data(), bytes.size());  // several times as fast as zlib's
}

}  // namespace sweepscope
