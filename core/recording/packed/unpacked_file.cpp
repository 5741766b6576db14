#include "core/recording/packed/unpacked_file.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include "core/io/input_file.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

constexpr std::array kZstdMagic{std::byte{0x28}, std::byte{0xb5}, std::byte{0x2f}, std::byte{0xfd}};

using OutputFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
using Context = std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)>;

tl::unexpected<Error> no_room(const fs::path& packed, const fs::path& unpacked) {
  return failure(ExitCode::kWrongUsage,
                 fmt::format("{}: cannot be unpacked into {}: {}; set TMPDIR to a folder with room",
                             packed.string(), unpacked.parent_path().string(), std::strerror(errno)));
}

enum class Unpacking { kWhole, kDamaged, kTooShort, kTooLong, kNoRoom, kInterrupted };

struct UnpackingEnd {
  Unpacking how;
  std::uint64_t unpacked_bytes;
};

UnpackingEnd unpack_into(std::FILE* output, InputFile& input, std::uint64_t max_bytes, const Job& job) {
  const Context context(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (!context) throw std::bad_alloc();
  std::vector<std::byte> packed(ZSTD_DStreamInSize()), plain(ZSTD_DStreamOutSize());
  std::uint64_t unpacked_bytes = 0;
  std::size_t hint = 0;
  while (const std::size_t got = input.read(packed)) {
    ZSTD_inBuffer in{packed.data(), got, 0};
    // After a full buffer the context may still hold a part of the frame; called again after a frame's end,
    // it would expect the next frame.
    for (bool more = true; more;) {
      ZSTD_outBuffer out{plain.data(), plain.size(), 0};
      hint = ZSTD_decompressStream(context.get(), &out, &in);
      if (ZSTD_isError(hint)) return {Unpacking::kDamaged, unpacked_bytes};
      unpacked_bytes += out.pos;
      if (unpacked_bytes > max_bytes) return {Unpacking::kTooLong, unpacked_bytes};
      if (std::fwrite(plain.data(), 1, out.pos, output) != out.pos)
        return {Unpacking::kNoRoom, unpacked_bytes};
      more = in.pos < in.size || (out.pos == out.size && hint != 0);
      if (job.cancelled()) return {Unpacking::kInterrupted, unpacked_bytes};
    }
    job.report("unpacking", static_cast<double>(input.position()) / static_cast<double>(input.size()));
  }
  return {hint == 0 ? Unpacking::kWhole : Unpacking::kTooShort, unpacked_bytes};
}

}  // namespace

bool begins_zstd(std::span<const std::byte> bytes) {
  return bytes.size() > kZstdMagic.size() &&
         std::memcmp(bytes.data(), kZstdMagic.data(), kZstdMagic.size()) == 0;
}

Result<UnpackedFile> UnpackedFile::unpack(const fs::path& packed, const Job& job, std::uint64_t max_bytes) {
  UnpackingLimit limit(packed);
  return unpack(packed, limit, job, max_bytes);
}

Result<UnpackedFile> UnpackedFile::unpack(const fs::path& packed, UnpackingLimit& limit, const Job& job,
                                          std::uint64_t max_bytes) {
  auto input = InputFile::open(packed);
  if (!input) return tl::unexpected(input.error());
  auto temporary = TemporaryFile::create();
  if (!temporary) return tl::unexpected(temporary.error());
  UnpackedFile file(std::move(*temporary));
  OutputFile output(std::fopen(file.path().c_str(), "wb"), std::fclose);
  if (!output) return no_room(packed, file.path());
  const auto [end, unpacked_bytes] = unpack_into(output.get(), *input, limit.max_bytes(max_bytes), job);
  if (auto error = limit.take(unpacked_bytes)) return tl::unexpected(std::move(*error));
  if (end == Unpacking::kInterrupted)
    return failure(ExitCode::kInterrupted, fmt::format("{}: reading was interrupted", packed.string()));
  if (end == Unpacking::kTooLong)
    return unreadable(fmt::format("{}: unpacks to more than {} bytes, the limit; cut it into parts",
                                  packed.string(), max_bytes));
  if (end == Unpacking::kNoRoom || std::fclose(output.release()) != 0) return no_room(packed, file.path());
  if (end == Unpacking::kDamaged)
    file.problem_ = "its zstd data is damaged; the part before the damage was read";
  if (end == Unpacking::kTooShort)
    file.problem_ = "its zstd data ends too early; the part that exists was read";
  return file;
}

}  // namespace sweepscope
