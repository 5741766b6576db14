#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "core/offset/estimator.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "core/offset/prepared/search_window.hpp"
#include "core/recording/sweeps.hpp"
#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/meshes/mesh.hpp"
#include "core/simulation/meshes/ray_caster.hpp"
#include "core/simulation/motion/motor.hpp"
#include "core/simulation/simulate.hpp"

namespace sweepscope::test {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kRadPerDeg;
inline constexpr double kMs = 1e-3;

/// A motor track that samples an angle over time.
MotorTrack track_of(const std::function<double(double t_s)>& angle_rad, double from_s, double to_s,
                    double rate_hz = 100);

/// The first seconds of one of the simulator's scenes; made once per program.
const Simulation& simulated(const std::string& scene, double offset_s, double duration_s,
                            double sweep_s = 0.5);
const Recording& room(double offset_s, double sweep_s = 0.5);

Estimate estimated(const Recording& recording, const EstimateOptions& options = {});

void expect_refused(const Estimate& estimate, const std::string& why);

/// A recording made by hand, independently of the simulator's sensor: any surroundings, rig and path, and
/// ranges that are exact but for the noise asked for.
struct Bench {
  simulation::Mesh mesh;
  std::function<Eigen::Isometry3d(double t_s)> world_from_base = [](double) {
    return Eigen::Isometry3d::Identity();
  };
  double duration_s = 4.5;
  double sweep_s = 0.513;
  double offset_s = 0;
  double noise_m = 0;
  Rig::Mount mount;

  Recording record() const;

 private:
  float range(const simulation::RayCaster& caster, const simulation::Motor& motor, const LaserScan& scan,
              std::uint32_t beam) const;
};

/// A furnished hall around the origin, its walls 6, 4 and 1.5 m away, with pillars that break its symmetry.
simulation::Mesh hall();

/// Everything about a recording that offsets within 60 ms of 0 are tried on. The recording must outlive it.
OffsetProblem problem_of(const Recording& recording);

}  // namespace sweepscope::test
