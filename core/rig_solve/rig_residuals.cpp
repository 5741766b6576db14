#include "core/rig_solve/rig_residuals.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "core/geometry/pose.hpp"
#include "core/numbers.hpp"
#include "core/rig_solve/plane_cells.hpp"
#include "core/rig_solve/rig_cloud.hpp"
#include "core/rig_solve/surfaces.hpp"

namespace sweepscope {
namespace {

// A point that lies on a surface, by its places in the clouds of both rigs.
struct PointOnSurface {
  std::size_t before, after, surface;
};

struct SurfacePlane {
  Eigen::Vector3d centre_m, normal;
};

SurfacePlane plane_through(std::span<const Eigen::Vector3d> points_m) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points_m) mean += p;
  mean /= double(points_m.size());
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points_m) squares.noalias() += (p - mean) * (p - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(squares);
  return {mean, solver.eigenvectors().col(0)};
}

// The surface of each point of the cloud that lies on one, near its plane; -1 for the others.
std::vector<int> surface_of_points(const RigCloud& cloud, double loss_width_m) {
  PlaneCellOptions cell_options;
  cell_options.flatness_m = loss_width_m / 2;
  const std::vector<PlaneCell> cells = plane_cells(cloud.p_m, cell_options);
  const std::vector<Surface> surfaces = surfaces_of(cells, loss_width_m);
  std::vector<int> of_point(cloud.p_m.size(), -1);
  for (std::size_t s = 0; s < surfaces.size(); ++s)
    for (const std::uint32_t cell : surfaces[s].cells)
      for (const std::uint32_t i : cells[cell].points)
        if (std::abs(surfaces[s].normal.dot(cloud.p_m[i] - surfaces[s].centre_m)) < 2 * loss_width_m)
          of_point[i] = static_cast<int>(s);
  return of_point;
}

// Sorted by surface, so that each surface's points lie next to each other.
std::vector<PointOnSurface> points_on_surfaces(const RigCloud& before, const RigCloud& after,
                                               double loss_width_m) {
  const std::vector<int> of_point = surface_of_points(after, loss_width_m);
  std::vector<PointOnSurface> points;
  std::size_t b = 0;
  for (std::size_t a = 0; a < after.feature.size(); ++a) {
    while (b < before.feature.size() && before.feature[b] < after.feature[a]) ++b;
    if (b == before.feature.size()) break;
    if (before.feature[b] == after.feature[a] && of_point[a] >= 0)
      points.push_back({b, a, static_cast<std::size_t>(of_point[a])});
  }
  std::ranges::stable_sort(points, {}, &PointOnSurface::surface);
  return points;
}

// Distances of the points from the plane of their surface, which is fitted to these places of theirs;
// positive on the far side.
std::vector<double> residuals_m(const RigCloud& cloud, std::span<const PointOnSurface> points,
                                std::size_t PointOnSurface::*place) {
  constexpr std::size_t kMinOnSurface = 30;  // as of PlaneCellOptions
  std::vector<double> result(points.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    std::vector<Eigen::Vector3d> of_surface_m;
    for (; end < points.size() && points[end].surface == points[begin].surface; ++end)
      of_surface_m.push_back(cloud.p_m[points[end].*place]);
    if (of_surface_m.size() < kMinOnSurface) continue;
    const SurfacePlane plane = plane_through(of_surface_m);
    // The laser is near the origin of the base frame compared with any wall.
    const double outwards = plane.normal.dot(plane.centre_m) < 0 ? -1 : 1;
    for (std::size_t i = begin; i < end; ++i)
      result[i] = outwards * plane.normal.dot(of_surface_m[i - begin] - plane.centre_m);
  }
  return result;
}

double beam_rad(const Mount& mount, const Feature& feature) {
  const Eigen::Vector3d p_in_laser_m = rotation_from_rpy(mount.laser_in_motor_rpy_deg).conjugate() *
                                       (feature.p_in_motor_m.cast<double>() - mount.laser_in_motor_xyz_m);
  return std::atan2(p_in_laser_m.y(), p_in_laser_m.x());
}

AngleRange range_of(const std::vector<double>& angles_rad) {
  const auto [min, max] = std::ranges::minmax(angles_rad);
  return {min, max};
}

std::size_t bin_of(double angle_rad, const AngleRange& range, std::size_t count) {
  const double length_rad = range.to_rad - range.from_rad;
  const double share = length_rad > 0 ? (angle_rad - range.from_rad) / length_rad : 0;
  return std::min(count - 1, static_cast<std::size_t>(share * double(count)));
}

// Where each point belongs in the grid, the same for both rigs.
struct Places {
  AngleRange motor, beam;
  std::size_t columns = 1;
  std::vector<std::size_t> bins;
};

Places places_of(const OffsetProblem& problem, const RigCloud& cloud, std::span<const PointOnSurface> points,
                 const ResidualGridOptions& options) {
  std::vector<double> angles_rad, beams_rad;
  for (const PointOnSurface& point : points) {
    // A motor that turns one way shows the same angle in every turn.
    angles_rad.push_back(std::remainder(cloud.angle_rad[point.after], 2 * std::numbers::pi));
    beams_rad.push_back(beam_rad(problem.recording->rig.mount,
                                 problem.features->planes.features[cloud.feature[point.after]]));
  }
  Places places{range_of(angles_rad), range_of(beams_rad), 1, {}};
  // Narrower columns would be empty where every sweep sees the same angles.
  const double scans =
      (places.motor.to_rad - places.motor.from_rad) / std::max(1e-3, problem.line_spacing_rad);
  places.columns = std::clamp<std::size_t>(static_cast<std::size_t>(scans), 1, options.columns);
  for (std::size_t i = 0; i < points.size(); ++i)
    places.bins.push_back(bin_of(beams_rad[i], places.beam, options.rows) * places.columns +
                          bin_of(angles_rad[i], places.motor, places.columns));
  return places;
}

ResidualGrid grid_of(const Places& places, const std::vector<double>& residuals_m,
                     const ResidualGridOptions& options) {
  std::vector<std::vector<double>> in_bin_m(places.columns * options.rows);
  for (std::size_t i = 0; i < residuals_m.size(); ++i)
    if (!std::isnan(residuals_m[i])) in_bin_m[places.bins[i]].push_back(residuals_m[i]);
  ResidualGrid grid{places.motor, places.beam, places.columns, options.rows, {}};
  for (auto& values_m : in_bin_m)
    grid.residual_m.push_back(values_m.size() < options.min_points ? std::numeric_limits<double>::quiet_NaN()
                                                                   : median(std::move(values_m)));
  return grid;
}

// Of those that are known.
double deviation_of_known_m(std::vector<double> values_m) {
  std::erase_if(values_m, [](double value_m) { return std::isnan(value_m); });
  for (double& value_m : values_m) value_m = std::abs(value_m);
  return kSigmaPerMedianDeviation * median(std::move(values_m));
}

}  // namespace

double ResidualGrid::rms_m() const {
  double squares_m2 = 0, count = 0;
  for (const double value_m : residual_m) {
    if (std::isnan(value_m)) continue;
    squares_m2 += value_m * value_m;
    count += 1;
  }
  return count > 0 ? std::sqrt(squares_m2 / count) : 0;
}

RigResiduals rig_residuals(const OffsetProblem& problem, const RigUnknowns& before, const RigUnknowns& after,
                           const ResidualGridOptions& options) {
  const RigCloud with_before = place_with_rig(problem, before, {}),
                 with_after = place_with_rig(problem, after, {});
  const std::vector<PointOnSurface> points =
      points_on_surfaces(with_before, with_after, options.loss_width_m);
  if (points.empty()) return {};
  const Places places = places_of(problem, with_after, points, options);
  const std::vector<double> before_m = residuals_m(with_before, points, &PointOnSurface::before),
                            after_m = residuals_m(with_after, points, &PointOnSurface::after);
  return {grid_of(places, before_m, options), grid_of(places, after_m, options),
          deviation_of_known_m(before_m), deviation_of_known_m(after_m)};
}

}  // namespace sweepscope
