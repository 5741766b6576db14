#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "core/simulation/scenes/scene.hpp"

namespace sweepscope::test {

/// Writes one of the project's scenes as a mesh (PLY), so that a rig can stand in it anywhere. Throws
/// std::runtime_error if there is no such scene or the file cannot be written.
inline void write_scene_mesh(const std::string& scene_name, const std::filesystem::path& file) {
  const auto scene = simulation::make_scene(scene_name);
  if (!scene) throw std::runtime_error("there is no scene " + scene_name);
  const auto& triangles = scene->mesh.triangles;
  std::ofstream out(file);
  out << "ply\nformat ascii 1.0\nelement vertex " << 3 * triangles.size()
      << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const simulation::Triangle& t : triangles)
    for (const auto* p : {&t.a, &t.b, &t.c}) out << fmt::format("{} {} {}\n", p->x(), p->y(), p->z());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    out << fmt::format("3 {} {} {}\n", 3 * i, 3 * i + 1, 3 * i + 2);
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace sweepscope::test
