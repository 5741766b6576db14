#include "core/recording/ros1/ros1_record.hpp"

#include <bit>

#include "core/numbers.hpp"

namespace sweepscope {

static_assert(std::endian::native == std::endian::little, "bags are little-endian");

namespace {

/// Takes a length and as many bytes off the front; empty where there are not so many.
std::optional<std::span<const std::byte>> take_counted(std::span<const std::byte>& bytes) {
  if (bytes.size() < 4) return std::nullopt;
  const std::size_t length = load<std::uint32_t>(bytes);
  if (length > bytes.size() - 4) return std::nullopt;
  const std::span<const std::byte> counted = bytes.subspan(4, length);
  bytes = bytes.subspan(4 + length);
  return counted;
}

}  // namespace

std::optional<BagFields> BagFields::parse(std::span<const std::byte> bytes) {
  std::span<const std::byte> rest = bytes;
  while (!rest.empty()) {
    const auto field = take_counted(rest);
    if (!field || as_text(*field).find('=') == std::string_view::npos) return std::nullopt;
  }
  return BagFields(bytes);
}

std::optional<std::span<const std::byte>> BagFields::find(std::string_view name) const {
  std::span<const std::byte> rest = bytes_;
  while (const auto field = take_counted(rest)) {
    const std::string_view text = as_text(*field);
    if (text.size() > name.size() && text[name.size()] == '=' && text.starts_with(name)) {
      return field->subspan(name.size() + 1);
    }
  }
  return std::nullopt;
}

std::optional<std::string_view> BagFields::text(std::string_view name) const {
  const auto value = find(name);
  if (!value) return std::nullopt;
  return as_text(*value);
}

std::optional<std::int64_t> BagFields::time_ns() const {
  const auto value = find("time");
  if (!value || value->size() != 8) return std::nullopt;
  return load<std::uint32_t>(*value) * kSecond_ns + load<std::uint32_t>(value->subspan(4));
}

std::optional<BagOp> BagFields::op() const {
  const auto value = number<std::uint8_t>("op");
  if (!value) return std::nullopt;
  return static_cast<BagOp>(*value);
}

std::optional<BagRecord> parse_record(std::span<const std::byte> bytes) {
  std::span<const std::byte> rest = bytes;
  const auto header = take_counted(rest);
  if (!header) return std::nullopt;
  const auto fields = BagFields::parse(*header);
  const auto data = take_counted(rest);
  if (!fields || !data) return std::nullopt;
  return BagRecord{*fields, *data, bytes.size() - rest.size()};
}

}  // namespace sweepscope
