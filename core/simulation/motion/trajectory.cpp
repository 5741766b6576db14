#include "core/simulation/motion/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/motion/plan_curve.hpp"
#include "core/simulation/motion/speed_profile.hpp"

namespace sweepscope::simulation {
namespace {

using Eigen::Quaterniond;

constexpr double kCadence_hz = 1.8;  // steps; a stride, left and right, is two
constexpr double kMeasureStep_s = 0.01;
constexpr std::uint64_t kSwayPurpose = 1;

/// A rotation by angle_rad about the axis-th coordinate axis.
Quaterniond about(int axis, double angle_rad) {
  const SinCos half = sin_cos(angle_rad / 2);
  Quaterniond q(half.cos, 0, 0, 0);
  q.vec()[axis] = half.sin;
  return q;
}

/// The rotation about z that turns x to `forward`, by half-angle formulas.
Quaterniond heading(const Vector2d& forward) {
  const double cos_half = std::sqrt(std::max(0.0, (1 + forward.x()) / 2));
  const double sin_half = std::sqrt(std::max(0.0, (1 - forward.x()) / 2));
  return {cos_half, 0, 0, forward.y() < 0 ? -sin_half : sin_half};
}

/// How a person carrying the rig sways: with every stride to the sides, with every step up and down.
struct Sway {
  double roll_rad, pitch_rad, yaw_rad, left_m, up_m;
};

class Gait {
 public:
  explicit Gait(std::uint64_t seed) {
    Random random(seed, kSwayPurpose, 0);
    for (SinCos& phase : phases_) phase = sin_cos(2 * kPi * random.uniform());
    drift_phase_ = 2 * kPi * random.uniform();
  }

  Sway at(double t_s, double speed_mps) const {
    const SinCos drift = sin_cos(2 * kPi * 0.11 * t_s + drift_phase_);
    const SinCos stride = sin_cos(kPi * kCadence_hz * t_s + 0.3 * drift.sin);
    const SinCos step = {2 * stride.sin * stride.cos, stride.cos * stride.cos - stride.sin * stride.sin};
    const auto shifted = [&](const SinCos& wave, int phase) {
      const SinCos& by = phases_[static_cast<std::size_t>(phase)];
      return wave.sin * by.cos + wave.cos * by.sin;
    };
    const double stir = smooth_step(speed_mps / 0.6);
    return {radians(0.7) * stir * shifted(stride, 0) + radians(0.15) * shifted(drift, 5),
            radians(0.4) * stir * shifted(step, 1) + radians(0.15) * shifted(drift, 6),
            radians(0.8) * stir * shifted(stride, 2), 0.012 * stir * shifted(stride, 3),
            0.010 * stir * shifted(step, 4)};
  }

 private:
  std::array<SinCos, 7> phases_;
  double drift_phase_ = 0;
};

/// The angle between two orientations that differ by little.
double small_angle_rad(const Quaterniond& from, const Quaterniond& to) {
  const double half = (from.conjugate() * to).vec().norm();
  return 2 * half * (1 + half * half / 6);
}

std::vector<Vector2d> scaled(const std::vector<Vector2d>& points_m, double scale) {
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& p : points_m) middle += p / static_cast<double>(points_m.size());
  std::vector<Vector2d> result;
  result.reserve(points_m.size());
  for (const Vector2d& p : points_m) result.emplace_back(middle + scale * (p - middle));
  return result;
}

}  // namespace

class Trajectory::Walk {
 public:
  Walk(const WalkSpec& spec, const SpeedProfile::Limits& limits, double scale, std::uint64_t seed)
      : plan_scale(scale),
        curve_(scaled(spec.waypoints_m, scale), spec.closed),
        profile_(curve_, limits),
        gait_(seed),
        duration_s_(spec.duration_s),
        height_m_(spec.height_m) {}

  Pose at(double t_s) const {
    const double inside_s = std::clamp(t_s, 0.0, duration_s_);
    const SpeedProfile::Progress progress = profile_.at(inside_s);
    const PlanCurve::Point point = curve_.at(progress.distance_m);
    const Sway sway = gait_.at(inside_s, progress.speed_mps);
    const Vector2d left(-point.forward.y(), point.forward.x());
    const Vector2d plan = point.position_m + sway.left_m * left;
    return {
        {plan.x(), plan.y(), height_m_ + sway.up_m},
        heading(point.forward) * about(2, sway.yaw_rad) * about(1, sway.pitch_rad) * about(0, sway.roll_rad)};
  }

  const double plan_scale;

 private:
  PlanCurve curve_;
  SpeedProfile profile_;
  Gait gait_;
  double duration_s_, height_m_;
};

Trajectory::Trajectory(const WalkSpec& spec, std::uint64_t seed) {
  SpeedProfile::Limits limits{spec.duration_s, spec.top_speed_mps, spec.top_angular_rate_radps};
  double scale = 1;
  walk_ = std::make_unique<Walk>(spec, limits, scale, seed);
  for (int round = 0; round < 10;
       ++round) {  // swaying adds to all three; each is corrected by what was measured
    const WalkMeasure measured = simulation::measure([&](double t_s) { return at(t_s); }, 0, spec.duration_s);
    scale *= spec.length_m / measured.length_m;
    limits.top_speed_mps *= spec.top_speed_mps / measured.top_speed_mps;
    limits.top_turn_rate_radps *= spec.top_angular_rate_radps / measured.top_angular_rate_radps;
    walk_ = std::make_unique<Walk>(spec, limits, scale, seed);
  }
}

Trajectory::Trajectory(const Stand& stand)
    : stand_{stand.position_m, about(2, radians(stand.yaw_deg)) * about(1, radians(stand.pitch_deg))} {}

Trajectory::Trajectory(std::function<Pose(double t_s)> motion) : motion_(std::move(motion)) {}

Trajectory::~Trajectory() = default;
Trajectory::Trajectory(Trajectory&&) noexcept = default;
Trajectory& Trajectory::operator=(Trajectory&&) noexcept = default;

Pose Trajectory::at(double t_s) const {
  if (motion_) return motion_(t_s);
  return walk_ ? walk_->at(t_s) : stand_;
}

double Trajectory::plan_scale() const {
  return walk_ ? walk_->plan_scale : 1;
}

WalkMeasure measure(const std::function<Pose(double t_s)>& pose_at, double from_s, double to_s) {
  WalkMeasure measured;
  const auto steps = static_cast<int>((to_s - from_s) / kMeasureStep_s);
  Pose before = pose_at(from_s);
  for (int i = 1; i <= steps; ++i) {
    const Pose now = pose_at(from_s + i * kMeasureStep_s);
    const double moved_m = (now.position_m - before.position_m).norm();
    measured.length_m += moved_m;
    measured.top_speed_mps = std::max(measured.top_speed_mps, moved_m / kMeasureStep_s);
    measured.top_angular_rate_radps =
        std::max(measured.top_angular_rate_radps,
                 small_angle_rad(before.orientation, now.orientation) / kMeasureStep_s);
    before = now;
  }
  return measured;
}

}  // namespace sweepscope::simulation
