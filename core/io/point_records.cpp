#include "core/io/point_records.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "core/io/text_cursor.hpp"

namespace sweepscope {
namespace {

struct Scalar {
  std::size_t size;
  double (*load)(const char* bytes);
};

template <typename T>
constexpr Scalar scalar() {
  return {sizeof(T), [](const char* bytes) {
            T value;
            std::memcpy(&value, bytes, sizeof value);
            return static_cast<double>(value);
          }};
}

/// In the order of ScalarType.
constexpr Scalar kScalars[] = {scalar<std::int8_t>(),   scalar<std::uint8_t>(),  scalar<std::int16_t>(),
                               scalar<std::uint16_t>(), scalar<std::int32_t>(),  scalar<std::uint32_t>(),
                               scalar<std::int64_t>(),  scalar<std::uint64_t>(), scalar<float>(),
                               scalar<double>()};

std::uint32_t to_sweep(double value) {
  constexpr double kMax = std::numeric_limits<std::uint32_t>::max();
  return value >= 0 && value <= kMax ? static_cast<std::uint32_t>(value) : 0;  // NaN is 0 too
}

}  // namespace

double load_scalar(ScalarType type, const char* bytes) {
  return kScalars[static_cast<std::size_t>(type)].load(bytes);
}

std::size_t size_of(ScalarType type) {
  return kScalars[static_cast<std::size_t>(type)].size;
}

std::size_t PointLayout::record_bytes() const {
  std::size_t sum = 0;
  for (const PointField& field : fields) sum += field.bytes();
  return sum;
}

std::size_t PointLayout::values_per_record() const {
  std::size_t sum = 0;
  for (const PointField& field : fields) sum += field.count;
  return sum;
}

Result<std::array<std::optional<std::size_t>, kMapColumns>> find_map_columns(const PointLayout& layout,
                                                                             std::string_view name) {
  constexpr std::array<std::string_view, kMapColumns> kNames{"x", "y", "z", "intensity", "time", "sweep"};
  std::array<std::optional<std::size_t>, kMapColumns> found;
  for (std::size_t column = 0; column < kMapColumns; ++column) {
    for (std::size_t f = 0; f < layout.fields.size(); ++f) {
      if (layout.fields[f].name == kNames[column] && layout.fields[f].count == 1) found[column] = f;
    }
    if (column <= kZ && !found[column]) {
      return unreadable(fmt::format("{}: the header names no field {}", name, kNames[column]));
    }
  }
  return found;
}

void MapPointCollector::add(const std::array<double, kMapColumns>& values) {
  MapPoint point;
  point.x = static_cast<float>(values[kX]);
  point.y = static_cast<float>(values[kY]);
  point.z = static_cast<float>(values[kZ]);
  if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z)) return;
  point.intensity = static_cast<float>(values[kIntensity]);
  point.time_s = values[kTime];
  point.sweep = to_sweep(values[kSweep]);
  cloud_->points.push_back(point);
}

MapCloud::Ptr MapPointCollector::finish() {
  cloud_->width = static_cast<std::uint32_t>(cloud_->size());
  cloud_->height = 1;
  cloud_->is_dense = true;
  return cloud_;
}

BinaryTable rows_of(std::string_view bytes, const PointLayout& layout) {
  BinaryTable table{bytes, {}, {}};
  std::size_t begin = 0;
  for (const PointField& field : layout.fields) {
    table.begin.push_back(begin);
    table.stride.push_back(layout.record_bytes());
    begin += field.bytes();
  }
  return table;
}

BinaryTable columns_of(std::string_view bytes, const PointLayout& layout, std::size_t points) {
  BinaryTable table{bytes, {}, {}};
  std::size_t begin = 0;
  for (const PointField& field : layout.fields) {
    table.begin.push_back(begin);
    table.stride.push_back(field.bytes());
    begin += field.bytes() * points;
  }
  return table;
}

Result<MapCloud::Ptr> read_binary_points(const BinaryTable& table, const PointLayout& layout,
                                         std::size_t points, std::string_view name) {
  const auto columns = find_map_columns(layout, name);
  if (!columns) return tl::unexpected(columns.error());
  MapPointCollector collector(points);
  for (std::size_t i = 0; i < points; ++i) {
    std::array<double, kMapColumns> values{};
    for (std::size_t column = 0; column < kMapColumns; ++column) {
      if (const auto f = (*columns)[column]) {
        values[column] =
            load_scalar(layout.fields[*f].type, table.bytes.data() + table.begin[*f] + i * table.stride[*f]);
      }
    }
    collector.add(values);
  }
  return collector.finish();
}

Result<MapCloud::Ptr> read_ascii_points(std::string_view text, const PointLayout& layout, std::size_t points,
                                        std::size_t lines_before, std::string_view name) {
  const auto columns = find_map_columns(layout, name);
  if (!columns) return tl::unexpected(columns.error());
  const std::size_t words_per_record = layout.values_per_record();
  std::vector<std::size_t> first_word;  // of each field
  for (std::size_t words = 0; const PointField& field : layout.fields) {
    first_word.push_back(words);
    words += field.count;
  }
  // A word and the blank after it take two bytes at least: no header can make this allocate more than the
  // file.
  MapPointCollector collector(std::min(points, text.size() / (2 * words_per_record) + 1));
  TextCursor lines(text);
  std::vector<double> words(words_per_record);
  for (std::size_t i = 0; i < points; ++i) {
    const auto line = lines.next_line();
    if (!line) {
      return unreadable(
          fmt::format("{}: the header promises {} points, the file ends after {}", name, points, i));
    }
    TextCursor cursor(*line);
    for (double& word : words) {
      const auto number = cursor.next_number();
      if (!number) {
        return unreadable(fmt::format("{}: line {}: a point is {} numbers", name, lines_before + lines.line(),
                                      words_per_record));
      }
      word = *number;
    }
    std::array<double, kMapColumns> values{};
    for (std::size_t column = 0; column < kMapColumns; ++column) {
      if (const auto f = (*columns)[column]) values[column] = words[first_word[*f]];
    }
    collector.add(values);
  }
  return collector.finish();
}

}  // namespace sweepscope
