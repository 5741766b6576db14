#include "core/io/cloud_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "core/io/atomic_file.hpp"
#include "core/io/point_records.hpp"

namespace sweepscope {
namespace {

static_assert(std::endian::native == std::endian::little, "clouds are written as they lie in memory");

std::string pcd_header(std::size_t points) {
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\n"
      "VERSION 0.7\n"
      "FIELDS x y z intensity time sweep\n"
      "SIZE 4 4 4 4 8 4\n"
      "TYPE F F F F F U\n"
      "COUNT 1 1 1 1 1 1\n"
      "WIDTH {0}\n"
      "HEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\n"
      "POINTS {0}\n"
      "DATA binary\n",
      points);
}

std::string ply_header(std::size_t points) {
  return fmt::format(
      "ply\n"
      "format binary_little_endian 1.0\n"
      "comment sweepscope " SWEEPSCOPE_VERSION
      ", metres and seconds\n"
      "element vertex {}\n"
      "property float x\n"
      "property float y\n"
      "property float z\n"
      "property float intensity\n"
      "property double time\n"
      "property uint sweep\n"
      "end_header\n",
      points);
}

template <typename T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

Result<void> write_records(AtomicFile& file, const MapCloud& cloud) {
  constexpr std::size_t kBlockBytes = 1 << 20;
  std::string block;
  block.reserve(kBlockBytes + 64);
  for (const MapPoint& point : cloud) {
    append(block, point.x);
    append(block, point.y);
    append(block, point.z);
    append(block, point.intensity);
    append(block, point.time_s);
    append(block, point.sweep);
    if (block.size() >= kBlockBytes) {
      if (auto written = file.write(block); !written) return written;
      block.clear();
    }
  }
  return file.write(block);
}

}  // namespace

Result<void> write_cloud(const std::filesystem::path& path, const MapCloud& cloud) {
  const std::string extension = path.extension().string();
  if (extension != ".pcd" && extension != ".ply") {
    return failure(ExitCode::kWrongUsage, path.string() + ": a map is written as .pcd or .ply");
  }
  return AtomicFile::create(path).and_then([&](AtomicFile&& file) -> Result<void> {
    const std::string header = extension == ".pcd" ? pcd_header(cloud.size()) : ply_header(cloud.size());
    if (auto written = file.write(header); !written) return written;
    if (auto written = write_records(file, cloud); !written) return written;
    return file.commit();
  });
}

Result<MapCloud::Ptr> parse_cloud(std::string_view bytes, std::string_view name) {
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r\n")) return parse_ply(bytes, name);
  if (bytes.starts_with("# .PCD") || bytes.starts_with("VERSION")) return parse_pcd(bytes, name);
  return unreadable(fmt::format("{}: is neither a PCD nor a PLY file", name));
}

Result<MapCloud::Ptr> read_cloud(const std::filesystem::path& path) {
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return tl::unexpected(bytes.error());
  return parse_cloud(*bytes, path.string());
}

}  // namespace sweepscope
