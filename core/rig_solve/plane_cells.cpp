#include "core/rig_solve/plane_cells.hpp"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/geometry/morton.hpp"
#include "core/loam/path/least_squares.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

using Keys = std::span<const MortonKey>;

struct Plane {
  Eigen::Vector3d centre_m, normal;
  Eigen::Matrix<double, 3, 2> along_m;  // deviations along it, the narrow direction first
  double flat_m = 0;                    // and across it
};

// If there is a plane `before`, points are weighted by their distance from it.
Plane fitted(std::span<const Eigen::Vector3d> points_m, Keys keys, const Plane* before, double width_m) {
  const Eigen::Vector3d& origin = points_m[keys.front().index];
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double sum = 0;
  for (const MortonKey& key : keys) {
    const Eigen::Vector3d& p = points_m[key.index];
    const double weight =
        before == nullptr ? 1.0 : cauchy_weight(before->normal.dot(p - before->centre_m), width_m);
    const Eigen::Vector3d d = p - origin;
    mean += weight * d;
    squares.noalias() += weight * d * d.transpose();
    sum += weight;
  }
  mean /= sum;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(squares / sum - mean * mean.transpose());
  const Eigen::Vector3d deviation_m = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  Plane plane{origin + mean, solver.eigenvectors().col(0), {}, deviation_m[0]};
  plane.along_m = solver.eigenvectors().rightCols<2>() * deviation_m.tail<2>().asDiagonal();
  return plane;
}

std::optional<PlaneCell> as_plane(std::span<const Eigen::Vector3d> points_m, Keys keys, double edge_m,
                                  const PlaneCellOptions& options) {
  constexpr double kMinWidth = 0.12;  // of the edge: narrower ones are lines
  constexpr int kReweightings = 2;    // the first from all points, the second from those near the plane
  if (keys.size() < options.min_points) return std::nullopt;
  const double width_m = 2 * options.flatness_m;
  Plane plane = fitted(points_m, keys, nullptr, width_m);
  if (plane.flat_m > 4 * options.flatness_m) return std::nullopt;
  for (int i = 0; i < kReweightings; ++i) plane = fitted(points_m, keys, &plane, width_m);
  if (plane.flat_m > options.flatness_m || plane.along_m.col(0).norm() < kMinWidth * edge_m)
    return std::nullopt;
  std::size_t near = 0;
  for (const MortonKey& key : keys)
    near += std::abs(plane.normal.dot(points_m[key.index] - plane.centre_m)) < 3 * options.flatness_m;
  if (double(near) < options.min_near * double(keys.size())) return std::nullopt;
  PlaneCell cell{{}, plane.centre_m, plane.normal, plane.along_m, plane.flat_m};
  cell.points.reserve(keys.size());
  for (const MortonKey& key : keys) cell.points.push_back(key.index);
  return cell;
}

// The keys of one cube of a level, from the first of `keys`.
Keys cube(Keys keys, int level) {
  const std::uint64_t code = keys.front().code >> (3 * level);
  std::size_t end = 1;
  while (end < keys.size() && keys[end].code >> (3 * level) == code) ++end;
  return keys.first(end);
}

void cut(std::span<const Eigen::Vector3d> points_m, Keys keys, int level, const PlaneCellOptions& options,
         std::vector<PlaneCell>& cells) {
  if (keys.size() < options.min_points) return;
  if (auto cell = as_plane(points_m, keys, std::ldexp(options.min_edge_m, level), options)) {
    cells.push_back(std::move(*cell));
    return;
  }
  if (level == 0) return;
  while (!keys.empty()) {
    const Keys part = cube(keys, level - 1);
    cut(points_m, part, level - 1, options, cells);
    keys = keys.subspan(part.size());
  }
}

}  // namespace

std::vector<PlaneCell> plane_cells(std::span<const Eigen::Vector3d> points_m,
                                   const PlaneCellOptions& options) {
  if (points_m.empty()) return {};
  std::vector<std::array<float, 3>> places_m;
  places_m.reserve(points_m.size());
  Eigen::Vector3d min_m = points_m.front();
  for (const Eigen::Vector3d& p : points_m) {
    places_m.push_back({float(p.x()), float(p.y()), float(p.z())});
    min_m = min_m.cwiseMin(p);
  }
  std::vector<std::uint32_t> all(points_m.size());
  std::iota(all.begin(), all.end(), 0u);
  const std::array<float, 3> origin_m{float(min_m.x()), float(min_m.y()), float(min_m.z())};
  const std::vector<MortonKey> keys = along_morton_curve(places_m, all, origin_m, options.min_edge_m);
  std::vector<Keys> cubes;
  for (Keys rest = keys; !rest.empty(); rest = rest.subspan(cubes.back().size()))
    cubes.push_back(cube(rest, options.levels));
  std::vector<std::vector<PlaneCell>> of_cube(cubes.size());
  for_each_task(cubes.size(),
                [&](std::size_t i) { cut(points_m, cubes[i], options.levels, options, of_cube[i]); });
  std::vector<PlaneCell> cells;
  for (auto& some : of_cube)
    for (PlaneCell& cell : some) cells.push_back(std::move(cell));
  return cells;
}

}  // namespace sweepscope
