#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <random>

#include "core/map/map_cloud.hpp"
#include "core/offset/estimate.hpp"

namespace sweepscope::test {

/// A hall with a ceiling, a hexagonal pillar and stairs at both ends, as a rig that walks along x sees it.
/// Each sweep is rolled by the same error with alternating sign, as a wrong offset does.
class HallMap {
 public:
  HallMap(double roll_error_rad, std::size_t points, std::size_t sweeps = 80)
      : roll_error_rad_(roll_error_rad), points_(points), sweeps_(sweeps) {}

  MapCloud::Ptr make() {
    MapCloud::Ptr cloud(new MapCloud);
    cloud->reserve(points_);
    while (cloud->size() < points_) {
      const std::size_t sweep = cloud->size() * sweeps_ / points_;
      const double along = (static_cast<double>(sweep) + 0.5) / static_cast<double>(sweeps_);
      const Eigen::Vector3d sensor(kLength * (along - 0.5) * 0.8, -3, 0);
      const Eigen::Vector3d in_rig = surface_point() - sensor;
      if (in_rig.norm() > 18 || drawn() > 1.2 * std::exp(-in_rig.norm() / 9)) continue;
      const double roll = sweep % 2 == 0 ? roll_error_rad_ : -roll_error_rad_;
      const Eigen::Vector3d noise(drawn() - 0.5, drawn() - 0.5, drawn() - 0.5);
      const Eigen::Vector3d place =
          sensor + Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()) * in_rig + 0.03 * noise;
      MapPoint point;
      point.x = static_cast<float>(place.x());
      point.y = static_cast<float>(place.y());
      point.z = static_cast<float>(place.z());
      point.intensity = 0;
      point.sweep = static_cast<std::uint32_t>(sweep);
      point.time_s = 0.5 * (static_cast<double>(sweep) + 0.5);
      cloud->push_back(point);
    }
    return cloud;
  }

 private:
  static constexpr double kLength = 44, kWidth = 16, kFloor = -1.3, kCeiling = 3.7, kPillarRadius = 0.8;

  double drawn() { return static_cast<double>(random_() >> 8) / (1U << 24); }
  double within(double from, double to) { return from + (to - from) * drawn(); }

  Eigen::Vector3d surface_point() {
    const double what = drawn();
    if (what < 0.25) return {within(-kLength / 2, kLength / 2), within(-kWidth / 2, kWidth / 2), kFloor};
    if (what < 0.5) return {within(-kLength / 2, kLength / 2), within(-kWidth / 2, kWidth / 2), kCeiling};
    if (what < 0.75) {
      return {within(-kLength / 2, kLength / 2), drawn() < 0.5 ? -kWidth / 2 : kWidth / 2,
              within(kFloor, kCeiling)};
    }
    if (what < 0.8)
      return {drawn() < 0.5 ? -kLength / 2 : kLength / 2, within(-kWidth / 2, kWidth / 2),
              within(kFloor, kCeiling)};
    if (what < 0.9) return pillar_point();
    return stair_point();
  }

  Eigen::Vector3d pillar_point() {
    const int side = static_cast<int>(6 * drawn());
    const double a = M_PI / 3 * side, b = M_PI / 3 * (side + 1), t = drawn();
    return {kPillarRadius * ((1 - t) * std::cos(a) + t * std::cos(b)),
            kPillarRadius * ((1 - t) * std::sin(a) + t * std::sin(b)), within(kFloor, kCeiling)};
  }

  Eigen::Vector3d stair_point() {
    constexpr double kTread = 0.3, kRise = 0.17;
    const double sign = drawn() < 0.5 ? -1 : 1;
    const int step = static_cast<int>(20 * drawn());
    const double front = 12 + kTread * step, y = within(1, 6);
    if (drawn() < 0.5) return {sign * within(front, front + kTread), y, kFloor + kRise * (step + 1)};
    return {sign * front, y, kFloor + kRise * (step + drawn())};
  }

  double roll_error_rad_;
  std::size_t points_, sweeps_;
  std::mt19937 random_{1};
};

/// A curve such as the stationary method draws, with one offset that failed.
inline Estimate stationary_curve() {
  Estimate estimate;
  estimate.recording = "hall.bag";
  estimate.method = Method::kStationary;
  estimate.identifiable = true;
  estimate.offset_s = 0.024;
  estimate.sigma_s = 0.00006;
  for (int ms = 19; ms <= 29; ++ms) {
    CurvePoint point;
    point.offset_s = 1e-3 * ms;
    if (ms != 28) {
      const double error = 1e-3 * (ms - 24);
      point.signed_rotation_rad = 2 * 2 * M_PI * error;
      point.rotation_rad = std::abs(*point.signed_rotation_rad) + 0.002;
      point.translation_m = 0.003 + std::abs(error);
      point.d = std::hypot(*point.rotation_rad, *point.translation_m);
    }
    estimate.curve.push_back(point);
  }
  estimate.criteria = {{"d", 0.024, *estimate.curve[5].d}};
  return estimate;
}

/// Likewise for the moving method.
inline Estimate moving_curve() {
  Estimate estimate = stationary_curve();
  estimate.method = Method::kMoving;
  estimate.offset_s = 0.0241;
  estimate.sigma_s.reset();
  for (CurvePoint& point : estimate.curve) {
    const double ms = 1e3 * (point.offset_s - 0.024);
    const bool failed = !point.d;
    point.d.reset();
    point.translation_m.reset();
    point.rotation_rad.reset();
    if (failed) continue;
    point.n = 1'850'000 - 22'000 * ms * ms;
    point.e_m = 0.0112 + 0.0006 * ms * ms;
  }
  estimate.criteria = {{"n", 0.0239, 1'850'000}, {"e", 0.0241, 0.0112}};
  return estimate;
}

}  // namespace sweepscope::test
