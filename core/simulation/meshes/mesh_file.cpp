#include "core/simulation/meshes/mesh_file.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "core/io/atomic_file.hpp"

namespace sweepscope::simulation {

std::string MeshBuilder::add_vertex(const Vector3d& p_m) {
  if (!p_m.allFinite()) return "a coordinate is not a finite number";
  if (p_m.cwiseAbs().maxCoeff() > kFarthest_m)
    return fmt::format("a vertex lies more than {:g} m from the origin (a mesh is in metres)", kFarthest_m);
  vertices_.push_back(p_m);
  return {};
}

std::string MeshBuilder::add_face(std::span<const std::int64_t> corners) {
  if (corners.size() < 3) return fmt::format("a face has {} corners, not 3 or more", corners.size());
  if (corners.size() > kMaxCorners)
    return fmt::format("a face has {} corners, more than {}", corners.size(), kMaxCorners);
  for (const std::int64_t corner : corners)
    if (corner < 0 || std::cmp_greater_equal(corner, vertices_.size()))
      return fmt::format("a face names vertex {} (counted from 0), but there are {}", corner,
                         vertices_.size());
  if (mesh_.triangles.size() + corners.size() - 2 > kMaxTriangles)
    return fmt::format("there are more than {} triangles", kMaxTriangles);
  const auto vertex = [&](std::size_t i) { return vertices_[static_cast<std::size_t>(corners[i])]; };
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const Triangle t{vertex(0), vertex(i - 1), vertex(i)};
    if ((t.b - t.a).cross(t.c - t.a).squaredNorm() > 0) mesh_.triangles.push_back(t);
  }
  return {};
}

Result<Mesh> MeshBuilder::finish(std::string_view name) {
  if (mesh_.triangles.empty()) return unreadable(fmt::format("{}: holds no triangle with an area", name));
  return std::move(mesh_);
}

Result<Mesh> parse_mesh(std::string_view bytes, const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (ending == ".ply") return parse_ply_mesh(bytes, file.string());
  if (ending == ".obj") return parse_obj_mesh(bytes, file.string());
  return unreadable(fmt::format("{}: a mesh is a .ply or .obj file", file.string()));
}

Result<Mesh> read_mesh(const std::filesystem::path& file) {
  const Result<std::string> bytes = read_file(file);
  if (!bytes) return tl::unexpected(bytes.error());
  return parse_mesh(*bytes, file);
}

}  // namespace sweepscope::simulation
