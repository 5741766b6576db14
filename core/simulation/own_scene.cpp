#include "core/simulation/own_scene.hpp"

#include <utility>

#include "core/io/atomic_file.hpp"
#include "core/io/content_hash.hpp"
#include "core/simulation/meshes/mesh_file.hpp"

namespace sweepscope::simulation {

Result<LoadedScene> load_own_scene(const OwnScene& own) {
  LoadedScene loaded;
  const Result<std::string> bytes = read_file(own.mesh);
  if (!bytes) return tl::unexpected(bytes.error());
  loaded.mesh_hash = content_hash(*bytes);
  auto mesh = parse_mesh(*bytes, own.mesh);
  if (!mesh) return tl::unexpected(mesh.error());
  loaded.scene.mesh = std::move(*mesh);
  if (own.trajectory.empty()) {
    loaded.scene.motion = Stand{own.placement.at_m.value_or(Vector3d::Zero()), own.placement.yaw_deg, 0};
    return loaded;
  }
  auto path = read_path(own.trajectory, own.placement, own.from_s);
  if (!path) return tl::unexpected(path.error());
  auto hash = file_content_hash(own.trajectory);
  if (!hash) return tl::unexpected(hash.error());
  loaded.trajectory_hash = *hash;
  loaded.scene.motion = std::move(*path);
  return loaded;
}

}  // namespace sweepscope::simulation
