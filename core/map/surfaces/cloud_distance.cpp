#include "core/map/surfaces/cloud_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/map/surfaces/voxel_grid.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

constexpr int kRings = 2;  // cubes from a point's own to the cap

// A cube of points to search, and where it lies.
struct CubeToSearch {
  std::uint32_t begin = 0, end = 0;
  std::array<float, 3> low_m, high_m;
};

// Distances for the points of one cube after the other; they share the cubes to search.
class CubeSearch {
 public:
  CubeSearch(const VoxelGrid& to, const VoxelLevel& level, double cap_m)
      : to_(to), level_(level), cap_m2_(static_cast<float>(cap_m * cap_m)) {}

  void enter(const VoxelLevel::Place& place) {
    place_ = place;
    candidates_.clear();
    rings_ = 0;
    gather_ring(0);
    gather_ring(1);
  }

  float distance_m(const std::array<float, 3>& p_m) {
    float min_m2 = cap_m2_;
    std::size_t next = 0;
    for (int ring = 0; ring <= kRings; ++ring) {
      if (ring > 1 && gap_to_ring_m2(p_m, ring) >= min_m2) break;
      if (ring >= rings_) gather_ring(ring);
      for (; next < ring_end_[ring]; ++next) look_in(candidates_[next], p_m, min_m2);
    }
    return std::sqrt(min_m2);
  }

 private:
  void gather_ring(int ring) {
    for (int dz = -ring; dz <= ring; ++dz)
      for (int dy = -ring; dy <= ring; ++dy) {
        const bool face = std::abs(dz) == ring || std::abs(dy) == ring;
        for (int dx = -ring; dx <= ring; dx += face ? 1 : 2 * ring)
          gather({place_[0] + dx, place_[1] + dy, place_[2] + dz});
      }
    ring_end_[ring] = candidates_.size();
    rings_ = ring + 1;
  }

  void gather(const VoxelLevel::Place& place) {
    const std::uint32_t cell = level_.find(place);
    if (cell == VoxelLevel::kNone) return;
    CubeToSearch& candidate = candidates_.emplace_back();
    candidate.begin = level_.begin(cell);
    candidate.end = level_.begin(cell + 1);
    for (int axis = 0; axis < 3; ++axis) {
      candidate.low_m[axis] = static_cast<float>(place[axis] * level_.cell_m());
      candidate.high_m[axis] = static_cast<float>((place[axis] + 1) * level_.cell_m());
    }
  }

  float gap_to_ring_m2(const std::array<float, 3>& p_m, int ring) const {
    float min_m = std::numeric_limits<float>::max();
    for (int axis = 0; axis < 3; ++axis) {
      const auto low_m = static_cast<float>((place_[axis] - ring + 1) * level_.cell_m());
      const auto high_m = static_cast<float>((place_[axis] + ring) * level_.cell_m());
      min_m = std::min({min_m, p_m[axis] - low_m, high_m - p_m[axis]});
    }
    return std::max(0.0f, min_m) * std::max(0.0f, min_m);
  }

  void look_in(const CubeToSearch& candidate, const std::array<float, 3>& p_m, float& min_m2) const {
    float gap_m2 = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float gap_m =
          std::max({0.0f, candidate.low_m[axis] - p_m[axis], p_m[axis] - candidate.high_m[axis]});
      gap_m2 += gap_m * gap_m;
    }
    if (gap_m2 >= min_m2) return;
    for (std::uint32_t i = candidate.begin; i < candidate.end; ++i) {
      const float x = to_.x_m[i] - p_m[0], y = to_.y_m[i] - p_m[1], z = to_.z_m[i] - p_m[2];
      min_m2 = std::min(min_m2, x * x + y * y + z * z);
    }
  }

  const VoxelGrid& to_;
  const VoxelLevel& level_;
  float cap_m2_;
  VoxelLevel::Place place_{};
  std::vector<CubeToSearch> candidates_;  // by ring
  std::array<std::size_t, kRings + 1> ring_end_{};
  int rings_ = 0;  // gathered
};

}  // namespace

std::vector<float> distances_to_m(const MapCloud& from, const MapCloud& to, const DistanceOptions& options) {
  std::vector<float> distances_m(from.size(), static_cast<float>(options.cap_m));
  if (to.empty() || from.empty()) return distances_m;
  const double cell_m = options.cap_m / kRings;
  const VoxelGrid asking(from, cell_m), grid(to, cell_m);
  const VoxelLevel cubes = asking.level(0), level = grid.level(0);
  for_each_block(cubes.cells(), 256, [&](const auto& block) {
    CubeSearch search(grid, level, options.cap_m);
    for (std::uint32_t cube = block.begin(); cube < block.end(); ++cube) {
      search.enter(cubes.place(cube));
      for (std::uint32_t i = cubes.begin(cube); i < cubes.begin(cube + 1); ++i)
        distances_m[asking.index[i]] = search.distance_m({asking.x_m[i], asking.y_m[i], asking.z_m[i]});
    }
  });
  return distances_m;
}

}  // namespace sweepscope
