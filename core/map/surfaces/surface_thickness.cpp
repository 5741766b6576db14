#include "core/map/surfaces/surface_thickness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>

#include "core/map/surfaces/surface_column.hpp"
#include "core/map/surfaces/voxel_grid.hpp"
#include "core/numbers.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

constexpr int kLevels = 3;  // of neighbourhoods, from the largest to the smallest
constexpr std::uint32_t kNoSeed = VoxelLevel::kNone;
constexpr std::size_t kBlock = 256;  // cubes

// A map while its surfaces are found.
struct Work {
  const VoxelGrid& grid;
  ColumnOptions options;
  std::vector<LocalSurface> surfaces;  // in the order of the cloud
  std::vector<char> open;              // in that of the grid: a smaller neighbourhood may give a surface

  LocalSurface& surface(std::uint32_t i) { return surfaces[grid.index[i]]; }
  const LocalSurface& surface(std::uint32_t i) const { return surfaces[grid.index[i]]; }
  Eigen::Vector3f point_m(std::uint32_t i) const { return {grid.x_m[i], grid.y_m[i], grid.z_m[i]}; }
  bool is_open(std::uint32_t i) const { return open[i] != 0; }
};

// What the points contain about their sweeps.
ColumnOptions column_options(const MapCloud& cloud, const ThicknessOptions& options) {
  ColumnOptions columns;
  bool odd = false, even = false;
  columns.sweeps_known = false;
  for (const MapPoint& p : cloud) {
    (p.sweep % 2 == 0 ? even : odd) = true;
    columns.sweeps_known = columns.sweeps_known || p.sweep != cloud.front().sweep;
  }
  columns.reach_m = options.reach_m;
  columns.both_directions = options.both_directions || (odd && even);
  return columns;
}

// Of a cube's points that have no surface yet the one nearest to their middle.
std::uint32_t seed_of(const Work& work, const VoxelLevel& level, std::uint32_t cell) {
  Eigen::Vector3f sum_m = Eigen::Vector3f::Zero();  // from the cube's first point
  float count = 0;
  const Eigen::Vector3f first_m = work.point_m(level.begin(cell));
  for (std::uint32_t i = level.begin(cell); i < level.begin(cell + 1); ++i)
    if (work.is_open(i)) sum_m += work.point_m(i) - first_m, count += 1;
  if (count == 0) return kNoSeed;
  const Eigen::Vector3f middle_m = first_m + sum_m / count;
  std::uint32_t nearest = kNoSeed;
  float nearest_m2 = std::numeric_limits<float>::infinity();
  for (std::uint32_t i = level.begin(cell); i < level.begin(cell + 1); ++i) {
    if (!work.is_open(i)) continue;
    const float m2 = (work.point_m(i) - middle_m).squaredNorm();
    if (m2 < nearest_m2) nearest_m2 = m2, nearest = i;
  }
  return nearest;
}

// A patch for each cube that holds a point without a surface; `done` is called after each block of cubes.
template <typename Done>
std::vector<SurfacePatch> patches_of(const Work& work, const VoxelLevel& level, const Job& job,
                                     const Done& done) {
  std::vector<SurfacePatch> patches(level.cells());
  for_each_block(level.cells(), kBlock, [&](const auto& block) {
    if (job.cancelled()) return;
    SurfaceColumn column(work.grid, level, work.options);
    for (std::uint32_t cell = block.begin(); cell < block.end(); ++cell)
      if (const std::uint32_t seed = seed_of(work, level, cell); seed != kNoSeed)
        patches[cell] = column.patch_at(seed);
    done(block.size());
  });
  return patches;
}

// The flat patches that may hold a cube's points.
struct Around {
  std::array<const SurfacePatch*, 27> patches;
  std::size_t count = 0;
};

Around patches_around(const std::vector<SurfacePatch>& patches, const VoxelLevel& level, std::uint32_t cell) {
  Around around;
  const VoxelLevel::Place place = level.place(cell);
  const auto x = level.beside(0, place), y = level.beside(1, place), z = level.beside(2, place);
  for (const std::uint64_t of_z : z)
    for (const std::uint64_t of_y : y)
      for (const std::uint64_t of_x : x) {
        const std::uint32_t other = level.find(of_x | of_y | of_z);
        if (other != VoxelLevel::kNone && patches[other].kind == SurfaceKind::kFlat)
          around.patches[around.count++] = &patches[other];
      }
  return around;
}

// The mean of the patches that hold the point, weighted by its distance from their middles.
LocalSurface surface_at(const Eigen::Vector3f& p_m, const Around& around, float margin_m) {
  LocalSurface surface;
  float weights = 0, weighted_m = 0, greatest = 0;
  for (const SurfacePatch* patch : std::span(around.patches.data(), around.count)) {
    const Eigen::Vector3f from_middle_m = p_m - patch->middle_m;
    const float height_m = patch->normal.dot(from_middle_m);
    if (height_m < patch->from_m - margin_m || height_m > patch->to_m + margin_m) continue;
    const float beside_m2 = from_middle_m.squaredNorm() - height_m * height_m;
    const float weight = 1 - beside_m2 / (patch->radius_m * patch->radius_m);
    if (weight <= 0) continue;
    weights += weight;
    weighted_m += weight * patch->thickness_m;
    if (weight > greatest) greatest = weight, surface.normal = patch->normal;
  }
  if (weights == 0) return surface;
  surface.thickness_m = weighted_m / weights;
  surface.kind = SurfaceKind::kFlat;
  return surface;
}

bool any_open(const Work& work, const VoxelLevel& level, std::uint32_t cell) {
  for (std::uint32_t i = level.begin(cell); i < level.begin(cell + 1); ++i)
    if (work.is_open(i)) return true;
  return false;
}

void assign(Work& work, const std::vector<SurfacePatch>& patches, const VoxelLevel& level, const Job& job) {
  constexpr double kMarginInNoise = 2.5;  // patches know a sample of their points
  const auto margin_m = static_cast<float>(kMarginInNoise * work.options.range_noise_m);
  for_each_block(level.cells(), kBlock, [&](const auto& block) {
    if (job.cancelled()) return;
    for (std::uint32_t cell = block.begin(); cell < block.end(); ++cell) {
      if (!any_open(work, level, cell)) continue;
      const Around around = patches_around(patches, level, cell);
      for (std::uint32_t i = level.begin(cell); i < level.begin(cell + 1); ++i) {
        if (!work.is_open(i)) continue;
        const LocalSurface found = surface_at(work.point_m(i), around, margin_m);
        if (found.kind == SurfaceKind::kFlat)
          work.surface(i) = found;
        else if (patches[cell].kind == SurfaceKind::kEdge)
          work.surface(i).kind = SurfaceKind::kEdge;
        // Where there are too few points in a large neighbourhood there are too few in a small one.
        work.open[i] = found.kind != SurfaceKind::kFlat && patches[cell].kind != SurfaceKind::kUnknown;
      }
    }
  });
}

// The noise of a single sweep across flat surfaces: the median over a sample of cubes.
double range_noise_m(const Work& work, const VoxelLevel& level) {
  constexpr std::uint32_t kSamples = 2048;
  const std::uint32_t stride = 1 + level.cells() / kSamples;
  std::vector<double> noise_m((level.cells() + stride - 1) / stride);
  for_each_block(noise_m.size(), 64, [&](const auto& block) {
    SurfaceColumn column(work.grid, level, work.options);
    for (std::size_t k = block.begin(); k < block.end(); ++k)
      noise_m[k] = column.range_noise_at_m(seed_of(work, level, static_cast<std::uint32_t>(k) * stride));
  });
  std::erase_if(noise_m, [](double value_m) { return std::isnan(value_m); });
  constexpr double kMax_m = 0.05;  // a map without flat surfaces has more
  return std::min(kMax_m, median(std::move(noise_m)));
}

enum class CubeKind : std::uint8_t { kOther, kEdge, kFlat };
struct Cube {
  CubeKind kind = CubeKind::kOther;
  float thickness_m = 0;
};

Cube cube_of(const Work& work, const VoxelLevel& level, std::uint32_t cell) {
  Cube cube;
  double sum_m = 0, count = 0;
  for (std::uint32_t i = level.begin(cell); i < level.begin(cell + 1); ++i) {
    const LocalSurface& surface = work.surface(i);
    if (surface.kind == SurfaceKind::kFlat) sum_m += double(surface.thickness_m), count += 1;
    if (surface.kind == SurfaceKind::kEdge) cube.kind = CubeKind::kEdge;
  }
  if (count > 0) cube = {CubeKind::kFlat, static_cast<float>(sum_m / count)};
  return cube;
}

std::optional<MapThickness> thickness_of_map(const Work& work, const VoxelLevel& finest) {
  std::vector<Cube> cubes(finest.cells());
  for_each_block(finest.cells(), kBlock, [&](const auto& block) {
    for (std::uint32_t cell = block.begin(); cell < block.end(); ++cell)
      cubes[cell] = cube_of(work, finest, cell);
  });
  std::vector<float> thickness_m;
  double edges = 0;
  for (const Cube& cube : cubes) {
    if (cube.kind == CubeKind::kFlat) thickness_m.push_back(cube.thickness_m);
    edges += cube.kind == CubeKind::kEdge ? 1 : 0;
  }
  if (thickness_m.empty()) return std::nullopt;
  MapThickness map;
  map.flat_part = static_cast<double>(thickness_m.size()) / static_cast<double>(cubes.size());
  map.edge_part = edges / static_cast<double>(cubes.size());
  map.median_m = double(quantile(thickness_m, 0.5));
  map.p90_m = double(quantile(thickness_m, 0.9));
  return map;
}

}  // namespace

std::string in_words(const MapThickness& map) {
  return fmt::format("median thickness {:.0f} mm, 90 % under {:.0f} mm", map.median_m * 1e3, map.p90_m * 1e3);
}

SurfaceThickness surface_thickness(const MapCloud& cloud, const ThicknessOptions& options, const Job& job) {
  SurfaceThickness found;
  if (cloud.empty()) return found;
  found.surfaces.resize(cloud.size());
  if (job.cancelled()) return found;
  const VoxelGrid grid(cloud, options.min_radius_m);
  Work work{grid, column_options(cloud, options), std::move(found.surfaces),
            std::vector<char>(cloud.size(), 1)};
  for (int doublings = kLevels - 1; doublings >= 0 && !job.cancelled(); --doublings) {
    const VoxelLevel level = grid.level(doublings);
    if (doublings == kLevels - 1) work.options.range_noise_m = range_noise_m(work, level);
    std::atomic<std::size_t> cells{0};
    const auto patches = patches_of(work, level, job, [&](std::size_t count) {
      const double part = double(cells += count) / level.cells();
      job.report("thickness", (kLevels - 1 - doublings + part) / kLevels);
    });
    assign(work, patches, level, job);
  }
  found.map = thickness_of_map(work, grid.level(0));
  found.surfaces = std::move(work.surfaces);
  return found;
}

}  // namespace sweepscope
