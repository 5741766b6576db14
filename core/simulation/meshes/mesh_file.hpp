#pragma once

#include <filesystem>
#include <string_view>

#include "core/error.hpp"
#include "core/simulation/meshes/mesh.hpp"

namespace sweepscope::simulation {

/// Collects the vertices and faces of a mesh file.
class MeshBuilder {
 public:
  // Embree proposes triangles in single precision, which resolves less than 1 mm up to this distance.
  static constexpr double kFarthest_m = 5000;
  static constexpr std::size_t kMaxTriangles = 20'000'000;
  static constexpr std::size_t kMaxCorners = 1000;  // of a polygon

  /// The problem, or empty.
  std::string add_vertex(const Vector3d& p_m);
  /// A flat convex polygon, its corners counted from 0. Triangles without an area are left out.
  std::string add_face(std::span<const std::int64_t> corners);

  std::size_t vertices() const { return vertices_.size(); }
  /// Fails if there is no triangle.
  Result<Mesh> finish(std::string_view name);

 private:
  std::vector<Vector3d> vertices_;
  Mesh mesh_;
};

/// The formats, each over the whole file in memory. PLY: ascii or binary of either byte order, vertices (x,
/// y, z of any number type) before faces (a list vertex_indices or vertex_index); other elements and
/// properties are skipped. OBJ: v and f, with v/vt/vn and relative indices; other lines are skipped. Metres,
/// z up.
Result<Mesh> parse_ply_mesh(std::string_view bytes, std::string_view name);
Result<Mesh> parse_obj_mesh(std::string_view text, std::string_view name);

/// Reads a .ply or .obj file, by its extension.
Result<Mesh> read_mesh(const std::filesystem::path& file);
Result<Mesh> parse_mesh(std::string_view bytes, const std::filesystem::path& file);

}  // namespace sweepscope::simulation
