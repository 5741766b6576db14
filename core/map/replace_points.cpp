#include "core/map/replace_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/geometry/kinematics.hpp"
#include "core/map/pose_reader.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

using Vector = Eigen::Vector3d;

/// Rotation about a fixed axis by an angle that changes little from call to call: sine and cosine follow by
/// their addition theorems, exact to 1e-12, and are taken afresh after a larger step.
class SmoothRotation {
 public:
  explicit SmoothRotation(const Vector& axis) : axis_(axis) { restart(0); }

  Vector operator()(double angle_rad, const Vector& p) {
    double step = angle_rad - base_rad_;
    if (std::abs(step) > kMaxStep_rad) {
      restart(angle_rad);
      step = 0;
    }
    const double square = step * step;
    const double sine = step * (1 - square / 6 * (1 - square / 20));
    const double cosine = 1 - square / 2 * (1 - square / 12 * (1 - square / 30));
    const double c = cosine_ * cosine - sine_ * sine, s = sine_ * cosine + cosine_ * sine;
    return c * p + s * axis_.cross(p) + ((1 - c) * axis_.dot(p)) * axis_;
  }

 private:
  static constexpr double kMaxStep_rad = 0.03;

  void restart(double angle_rad) {
    base_rad_ = angle_rad;
    sine_ = std::sin(angle_rad);
    cosine_ = std::cos(angle_rad);
  }

  Vector axis_;
  double base_rad_ = 0, sine_ = 0, cosine_ = 1;
};

/// The motions of a path's sweeps, asked for in their order: each is made once for all of its scans.
class MotionReader {
 public:
  explicit MotionReader(const FixedPath& path) : path_(path) {}

  const SweepMotion& of(std::uint32_t sweep) {
    if (!motion_ || sweep != sweep_) motion_ = path_.sweeps[sweep].motion();
    sweep_ = sweep;
    return *motion_;
  }

 private:
  const FixedPath& path_;
  std::optional<SweepMotion> motion_;
  std::uint32_t sweep_ = 0;
};

/// A sweep's motion during one scan: its poses at many instants, and places linearly between them, which the
/// motion's own knots fall between. Made for the given beams, some or all of the scan's: a thinned map has
/// few in each.
class SmoothMotion {
 public:
  template <typename BeamAt>
  SmoothMotion(const SweepPose& pose, const SweepMotion& motion, const LaserScan& scan, std::size_t count,
               const BeamAt& beam_at)
      : beams_per_step_(scan.beams / double(kSteps)) {
    std::array<bool, kSteps + 1> wanted{};
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t k = step_of(beam_at(i) / beams_per_step_);
      wanted[k] = wanted[k + 1] = true;
    }
    for (std::size_t k = 0; k <= kSteps; ++k) {
      if (!wanted[k]) continue;
      const double time_s = scan.beam_s(static_cast<double>(k) * beams_per_step_);
      const double u = (time_s - pose.begin_s) / (pose.end_s - pose.begin_s);
      places_m_[k] = motion(Vector::Zero(), u);
      for (int axis = 0; axis < 3; ++axis) {
        linear_[k].col(axis) = motion(Vector::Unit(axis), u) - places_m_[k];
      }
    }
  }

  Vector operator()(const Vector& p_in_base_m, std::uint32_t beam) const {
    const double along = beam / beams_per_step_;
    const std::size_t k = step_of(along);
    const double part = along - static_cast<double>(k);
    return (1 - part) * (linear_[k] * p_in_base_m + places_m_[k]) +
           part * (linear_[k + 1] * p_in_base_m + places_m_[k + 1]);
  }

 private:
  static constexpr std::size_t kSteps = 40;
  static std::size_t step_of(double along) { return std::min(static_cast<std::size_t>(along), kSteps - 1); }

  double beams_per_step_;
  std::array<Eigen::Matrix3d, kSteps + 1> linear_;
  std::array<Vector, kSteps + 1> places_m_;
};

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Places points [from, to) of one scan, which `index` names by their number among all beams.
template <typename Index>
void place_scan(const Beams& beams, const FixedPath& path, std::size_t scan_number, MotorReader& motor,
                MotionReader& motions, const Kinematics& kinematics, double offset_s, std::size_t from,
                std::size_t to, const Index& index, std::span<std::array<float, 3>> xyz_m) {
  const std::uint32_t sweep = path.sweep_of_scan[scan_number];
  if (sweep == FixedPath::kNoPose) {
    for (std::size_t k = from; k < to; ++k) xyz_m[k] = {kNan, kNan, kNan};
    return;
  }
  const LaserScan& scan = beams.recording->scans[scan_number];
  SmoothRotation base_from_motor(kinematics.axis());
  const SmoothMotion motion(path.sweeps[sweep], motions.of(sweep), scan, to - from,
                            [&](std::size_t i) { return beams.beam[index(from + i)]; });
  for (std::size_t k = from; k < to; ++k) {
    const std::size_t i = index(k);
    const auto& p = beams.p_in_motor_m[i];
    const double time_s = scan.beam_s(beams.beam[i]);
    const Vector p_in_base_m = base_from_motor(motor.angle_at(time_s + offset_s), Vector(p[0], p[1], p[2]));
    const Vector p_m = motion(p_in_base_m, beams.beam[i]);
    xyz_m[k] = {static_cast<float>(p_m.x()), static_cast<float>(p_m.y()), static_cast<float>(p_m.z())};
  }
}

template <typename Begin, typename Index>
void place_all(const Beams& beams, const FixedPath& path, double offset_s, const Begin& begin,
               const Index& index, std::span<std::array<float, 3>> xyz_m) {
  constexpr std::size_t kScansATime = 32;
  const std::vector<LaserScan>& scans = beams.recording->scans;
  const Kinematics kinematics(beams.recording->rig.mount);
  for_each_block(scans.size(), kScansATime, [&](const auto& range) {
    MotorReader motor(beams.recording->motor);
    MotionReader motions(path);
    for (std::size_t s = range.begin(); s < range.end(); ++s) {
      place_scan(beams, path, s, motor, motions, kinematics, offset_s, begin(s), begin(s + 1), index, xyz_m);
    }
  });
}

}  // namespace

Beams collect_beams(const Recording& recording) {
  const Kinematics kinematics(recording.rig.mount);
  Beams beams;
  beams.recording = &recording;
  beams.first_point.push_back(0);
  for (std::uint32_t i = 0; i < recording.scans.size(); ++i) {
    const LaserScan& scan = recording.scans[i];
    const auto ranges_m = recording.ranges(scan);
    for (std::uint32_t beam = 0; beam < scan.beams; ++beam) {
      if (!std::isfinite(ranges_m[beam])) continue;
      const Eigen::Vector3f p_m =
          kinematics.point_in_motor(ranges_m[beam], recording.direction(scan, beam)).cast<float>();
      beams.p_in_motor_m.push_back({p_m.x(), p_m.y(), p_m.z()});
      beams.scan.push_back(i);
      beams.beam.push_back(beam);
    }
    beams.first_point.push_back(beams.p_in_motor_m.size());
  }
  return beams;
}

FixedPath fix_path(const Recording& recording, std::vector<SweepPose> sweeps, std::span<const char> used) {
  FixedPath path;
  path.sweeps = std::move(sweeps);
  path.sweep_of_scan.assign(recording.scans.size(), FixedPath::kNoPose);
  std::size_t next = 0;
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    const double middle_s = (recording.scans[i].first_beam_s + recording.scans[i].last_beam_s()) / 2;
    while (next < path.sweeps.size() && path.sweeps[next].end_s <= middle_s) ++next;
    if (used[i] && next < path.sweeps.size() && path.sweeps[next].begin_s <= middle_s)
      path.sweep_of_scan[i] = static_cast<std::uint32_t>(next);
  }
  return path;
}

FixedPath standing_path(const Recording& recording, std::span<const char> used) {
  if (recording.scans.empty()) return {};
  SweepPose pose;
  pose.begin_s = recording.scans.front().first_beam_s - 1;
  pose.end_s = recording.scans.back().last_beam_s() + 1;
  return fix_path(recording, {pose}, used);
}

FixedPath path_along(const Recording& recording, const std::vector<StampedPose>& poses,
                     std::span<const char> used) {
  FixedPath path;
  path.sweep_of_scan.assign(recording.scans.size(), FixedPath::kNoPose);
  PoseReader reader(poses);
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    SweepPose pose;
    pose.begin_s = recording.scans[i].first_beam_s;
    pose.end_s = recording.scans[i].last_beam_s();
    if (!used[i] || !(pose.end_s > pose.begin_s) || !reader.covers(pose.begin_s, pose.end_s)) continue;
    pose.knots = {reader.at(pose.begin_s), reader.at(pose.end_s)};
    path.sweep_of_scan[i] = static_cast<std::uint32_t>(path.sweeps.size());
    path.sweeps.push_back(pose);
  }
  return path;
}

void replace_points(const Beams& beams, const FixedPath& path, double offset_s,
                    std::span<std::array<float, 3>> xyz_m) {
  place_all(
      beams, path, offset_s, [&](std::size_t scan) { return beams.first_point[scan]; },
      [](std::size_t k) { return k; }, xyz_m);
}

void replace_points(const Beams& beams, const FixedPath& path, double offset_s,
                    std::span<const std::uint32_t> chosen, std::span<std::array<float, 3>> xyz_m) {
  const auto begin = [&](std::size_t scan) {
    const auto first = std::lower_bound(chosen.begin(), chosen.end(), beams.first_point[scan],
                                        [](std::uint32_t a, std::size_t b) { return a < b; });
    return static_cast<std::size_t>(first - chosen.begin());
  };
  place_all(
      beams, path, offset_s, begin, [&](std::size_t k) { return std::size_t{chosen[k]}; }, xyz_m);
}

}  // namespace sweepscope
