#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/geometry/map_cloud.hpp"

namespace sweepscope {

/// A number as PCD and PLY files store it, little endian.
enum class ScalarType { kI8, kU8, kI16, kU16, kI32, kU32, kI64, kU64, kF32, kF64 };

std::size_t size_of(ScalarType type);
/// The number that begins at `bytes`.
double load_scalar(ScalarType type, const char* bytes);
/// The type with that name in a PLY header; empty for any other word.
std::optional<ScalarType> ply_scalar_type(std::string_view word);

/// One named column of a table of points; `count` numbers follow each other in it.
struct PointField {
  std::string name;
  ScalarType type = ScalarType::kF32;
  std::size_t count = 1;

  std::size_t bytes() const { return size_of(type) * count; }
};

/// How a file lays out its points: the fields of a record, in order.
struct PointLayout {
  std::vector<PointField> fields;

  std::size_t record_bytes() const;
  std::size_t values_per_record() const;
};

/// The columns that make a MapPoint, as indices of PointLayout::fields.
enum MapColumn : std::size_t { kX, kY, kZ, kIntensity, kTime, kSweep, kMapColumns };

/// Finds the columns by name; absent if the file has no such field. Fails if x, y or z is missing.
Result<std::array<std::optional<std::size_t>, kMapColumns>> find_map_columns(const PointLayout& layout,
                                                                             std::string_view name);

/// Collects records as map points.
class MapPointCollector {
 public:
  explicit MapPointCollector(std::size_t expected) : cloud_(new MapCloud) { cloud_->reserve(expected); }
  /// `values` in the order of MapColumn. A point whose position is not finite is skipped.
  void add(const std::array<double, kMapColumns>& values);
  MapCloud::Ptr finish();

 private:
  MapCloud::Ptr cloud_;
};

/// Points whose field f of record i begins at `bytes[begin(f) + i * stride(f)]`; all must lie within `bytes`.
struct BinaryTable {
  std::string_view bytes;
  std::vector<std::size_t> begin, stride;  // per field of the layout
};

/// Record after record, as in a binary PCD or PLY file; or column after column, as in a compressed PCD file.
BinaryTable rows_of(std::string_view bytes, const PointLayout& layout);
BinaryTable columns_of(std::string_view bytes, const PointLayout& layout, std::size_t points);

Result<MapCloud::Ptr> read_binary_points(const BinaryTable& table, const PointLayout& layout,
                                         std::size_t points, std::string_view name);

/// Records as words separated by blanks; every record must be complete. `text` begins at the file's line
/// `lines_before + 1`.
Result<MapCloud::Ptr> read_ascii_points(std::string_view text, const PointLayout& layout, std::size_t points,
                                        std::size_t lines_before, std::string_view name);

/// The two formats, each over the whole file in memory.
Result<MapCloud::Ptr> parse_pcd(std::string_view bytes, std::string_view name);
Result<MapCloud::Ptr> parse_ply(std::string_view bytes, std::string_view name);

}  // namespace sweepscope
