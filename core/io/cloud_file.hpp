#pragma once

#include <filesystem>
#include <string_view>

#include "core/error.hpp"
#include "core/geometry/map_cloud.hpp"

namespace sweepscope {

/// Writes the map as binary PCD or binary little-endian PLY, by the path's extension (.pcd or .ply; anything
/// else is ExitCode::kWrongUsage). Fields: x y z (float, m), intensity (float), time (double, s), sweep
/// (uint32).
Result<void> write_cloud(const std::filesystem::path& path, const MapCloud& cloud);

/// Reads a PCD file (ascii, binary or binary_compressed) or a PLY file (ascii or binary little endian); the
/// first bytes decide which of the two. x, y and z are required; intensity, time and sweep default to 0;
/// other fields and points with a position that is not finite are skipped. Sizes in headers are checked
/// against the size of the file before anything is allocated.
Result<MapCloud::Ptr> read_cloud(const std::filesystem::path& path);

/// The same from memory; `name` stands for the file in error messages.
Result<MapCloud::Ptr> parse_cloud(std::string_view bytes, std::string_view name);

}  // namespace sweepscope
