#include "core/recording/ros2/mcap_extras.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/io/input_file.hpp"

namespace sweepscope {
namespace {

constexpr std::uint64_t kMaxHeader_bytes = std::uint64_t{1} << 20;
constexpr std::size_t kBlock_bytes = std::size_t{1} << 20;

bool is_extra(McapOp op) {
  return op == McapOp::kAttachment || op == McapOp::kMetadata || static_cast<std::uint8_t>(op) >= 0x80;
}

std::string profile_of(InputFile& file, std::uint64_t bytes) {
  std::string content(std::min(bytes, kMaxHeader_bytes), '\0');
  content.resize(file.read(std::as_writable_bytes(std::span(content))));
  return std::string(McapFields(std::as_bytes(std::span(content))).text());
}

}  // namespace

Result<McapExtras> find_mcap_extras(const std::filesystem::path& path) {
  auto file = InputFile::open(path);
  if (!file) return tl::unexpected(file.error());
  McapExtras extras;
  file->seek(std::min<std::uint64_t>(kMcapMagic.size(), file->size()));
  std::array<std::byte, kMcapRecordHeader_bytes> header;
  while (file->read(header) == header.size()) {
    McapFields fields(header);
    const auto op = static_cast<McapOp>(fields.number<std::uint8_t>());
    const auto bytes = fields.number<std::uint64_t>();
    const std::uint64_t at = file->position();
    if (op == McapOp::kDataEnd || op == McapOp::kFooter || bytes > file->left()) break;
    if (op == McapOp::kHeader) extras.profile = profile_of(*file, bytes);
    if (is_extra(op)) extras.records.push_back({op, at, bytes});
    file->seek(at + bytes);
  }
  return extras;
}

Result<void> read_mcap_extra(const std::filesystem::path& path, const McapExtra& extra,
                             std::uint64_t max_bytes,
                             const std::function<Result<void>(std::string_view)>& write) {
  auto file = InputFile::open(path);
  if (!file) return tl::unexpected(file.error());
  file->seek(extra.at);
  std::uint64_t left = std::min(extra.bytes, max_bytes);
  std::string block(std::min<std::uint64_t>(left, kBlock_bytes), '\0');
  while (left > 0) {
    block.resize(std::min<std::uint64_t>(left, block.size()));
    if (file->read(std::as_writable_bytes(std::span(block))) != block.size())
      return unreadable(fmt::format("{}: cannot be read at byte {}", path.string(), file->position()));
    if (auto written = write(block); !written) return written;
    left -= block.size();
  }
  return {};
}

}  // namespace sweepscope
