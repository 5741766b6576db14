#pragma once

#include <filesystem>
#include <string>

namespace sweepscope {

/// Writes one of the project's scenes as a mesh (PLY), so that a rig can stand in it anywhere. Throws
/// std::runtime_error if there is no such scene or the file cannot be written.
void write_scene_mesh(const std::string& scene_name, const std::filesystem::path& file);

}  // namespace sweepscope
