#include "core/simulation/motion/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/motion/gait.hpp"
#include "core/simulation/motion/plan_curve.hpp"
#include "core/simulation/motion/speed_profile.hpp"

namespace sweepscope::simulation {
namespace {

using Eigen::Quaterniond;

constexpr double kMeasureStep_s = 0.01;

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
    return {{plan.x(), plan.y(), height_m_ + sway.up_m}, swayed(heading(point.forward), sway)};
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
