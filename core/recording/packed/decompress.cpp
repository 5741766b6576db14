#include "core/recording/packed/decompress.hpp"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

namespace sweepscope {
namespace {

constexpr std::size_t kFirstBuffer_bytes = std::size_t{1} << 20;

/// The part of a buffer that is still free. It grows by doubling, so that a header's claim alone allocates
/// nothing.
class Output {
 public:
  Output(std::vector<std::byte>& buffer, std::size_t max_bytes) : buffer_(buffer), max_bytes_(max_bytes) {}

  std::span<std::byte> free_space() {
    if (used_ == buffer_.size()) {
      const std::size_t bytes = std::min(max_bytes_, std::max(kFirstBuffer_bytes, 2 * buffer_.size()));
      buffer_.reserve(bytes);  // exactly, where resize() alone would take up to twice what was there
      buffer_.resize(bytes);
    }
    return std::span(buffer_).first(std::min(buffer_.size(), max_bytes_)).subspan(used_);
  }
  void take(std::size_t bytes) { used_ += bytes; }
  bool full() const { return used_ == max_bytes_; }
  std::span<const std::byte> bytes() const { return std::span(buffer_).first(used_); }

 private:
  std::vector<std::byte>& buffer_;
  std::size_t max_bytes_;
  std::size_t used_ = 0;
};

std::string too_long(std::size_t max_bytes) {
  return fmt::format("it unpacks to more than {} bytes", max_bytes);
}

Decompressed unpack_bz2(std::span<const std::byte> block, std::size_t max_bytes,
                        std::vector<std::byte>& buffer) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) return {{}, "bz2 could not be started"};
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> end(&stream, BZ2_bzDecompressEnd);
  // libbz2 reads from next_in only, though its type does not say so.
  stream.next_in = const_cast<char*>(reinterpret_cast<const char*>(block.data()));
  stream.avail_in = static_cast<unsigned>(block.size());
  Output output(buffer, max_bytes);
  while (true) {
    // Once full, one byte more tells an end that is due from a block that is longer than it may be.
    char overflow = 0;
    const bool full = output.full();
    const std::span<std::byte> space =
        full ? std::as_writable_bytes(std::span(&overflow, 1)) : output.free_space();
    stream.next_out = reinterpret_cast<char*>(space.data());
    stream.avail_out = static_cast<unsigned>(space.size());
    const int code = BZ2_bzDecompress(&stream);
    const std::size_t written = space.size() - stream.avail_out;
    if (full && written > 0) return {output.bytes(), too_long(max_bytes), true};
    output.take(written);
    if (code == BZ_STREAM_END) return {output.bytes(), ""};
    if (code != BZ_OK) return {output.bytes(), "its bz2 data is damaged"};
    if (stream.avail_in == 0 && written == 0) return {output.bytes(), "its bz2 data ends too early"};
  }
}

Decompressed unpack_lz4(std::span<const std::byte> block, std::size_t max_bytes,
                        std::vector<std::byte>& buffer) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)))
    return {{}, "lz4 could not be started"};
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> end(context,
                                                                         LZ4F_freeDecompressionContext);
  Output output(buffer, max_bytes);
  while (true) {
    char overflow = 0;
    const bool full = output.full();
    const std::span<std::byte> space =
        full ? std::as_writable_bytes(std::span(&overflow, 1)) : output.free_space();
    std::size_t written = space.size();
    std::size_t eaten = block.size();
    // Not LZ4F_decompressOptions_t::stableDst: the buffer moves as it grows.
    const std::size_t hint = LZ4F_decompress(context, space.data(), &written, block.data(), &eaten, nullptr);
    if (LZ4F_isError(hint)) return {output.bytes(), "its lz4 data is damaged"};
    if (full && written > 0) return {output.bytes(), too_long(max_bytes), true};
    output.take(written);
    block = block.subspan(eaten);
    if (hint == 0) return {output.bytes(), ""};
    if (eaten == 0 && written == 0) return {output.bytes(), "its lz4 data ends too early"};
  }
}

Decompressed unpack_zstd(std::span<const std::byte> block, std::size_t max_bytes,
                         std::vector<std::byte>& buffer) {
  const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (!context) return {{}, "zstd could not be started"};
  Output output(buffer, max_bytes);
  ZSTD_inBuffer input{block.data(), block.size(), 0};
  while (true) {
    char overflow = 0;
    const bool full = output.full();
    const std::span<std::byte> space =
        full ? std::as_writable_bytes(std::span(&overflow, 1)) : output.free_space();
    ZSTD_outBuffer written{space.data(), space.size(), 0};
    const std::size_t eaten_before = input.pos;
    const std::size_t hint = ZSTD_decompressStream(context.get(), &written, &input);
    if (ZSTD_isError(hint)) return {output.bytes(), "its zstd data is damaged"};
    if (full && written.pos > 0) return {output.bytes(), too_long(max_bytes), true};
    output.take(written.pos);
    if (hint == 0 && input.pos == input.size) return {output.bytes(), ""};
    if (input.pos == eaten_before && written.pos == 0)
      return {output.bytes(), "its zstd data ends too early"};
  }
}

}  // namespace

std::optional<Compression> compression_named(std::string_view name) {
  if (name == "none") return Compression::kNone;
  if (name == "bz2") return Compression::kBz2;
  if (name == "lz4") return Compression::kLz4;
  return std::nullopt;
}

Decompressed decompress(Compression compression, std::span<const std::byte> block, std::size_t max_bytes,
                        std::vector<std::byte>& buffer) {
  switch (compression) {
    case Compression::kNone:
      return {block, ""};
    case Compression::kBz2:
      return unpack_bz2(block, max_bytes, buffer);
    case Compression::kLz4:
      return unpack_lz4(block, max_bytes, buffer);
    case Compression::kZstd:
      return unpack_zstd(block, max_bytes, buffer);
  }
  return {{}, "its compression is unknown"};
}

std::string BagPlace::text() const {
  return chunk_byte ? fmt::format("byte {} of the chunk at byte {}", *chunk_byte, file_byte)
                    : fmt::format("byte {}", file_byte);
}

}  // namespace sweepscope
