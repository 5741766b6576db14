#include "core/simulation/motion/recorded_path.hpp"

#include <fmt/format.h>

#include "core/io/trajectory_file.hpp"
#include "core/simulation/math/portable_math.hpp"

namespace sweepscope::simulation {
namespace {

constexpr std::size_t kMinPoses = 20;
constexpr double kWidestGap_s = 1;
constexpr double kWidestTurn_deg = 60;

/// The recorded frame from the base frame: base z is what points up on average, base x what points least from
/// the world's x on average.
Eigen::Quaterniond upright_base(std::span<const StampedPose> poses) {
  Vector3d up = Vector3d::Zero(), forward = Vector3d::Zero();
  for (const StampedPose& pose : poses) {
    up += pose.orientation.conjugate() * Vector3d::UnitZ();
    forward += pose.orientation.conjugate() * Vector3d::UnitX();
  }
  const auto count = static_cast<double>(poses.size());
  if (up.norm() < 1e-3 * count) return Eigen::Quaterniond::Identity();
  up.normalize();
  forward -= up.dot(forward) * up;
  if (forward.norm() < 1e-3 * count) forward = up.unitOrthogonal();
  forward.normalize();
  Eigen::Matrix3d base;
  base << forward, up.cross(forward), up;
  return Eigen::Quaterniond(base).normalized();
}

Vector3d mean_position(std::span<const StampedPose> poses) {
  Vector3d sum = Vector3d::Zero();
  for (const StampedPose& pose : poses) sum += pose.position_m;
  return sum / static_cast<double>(poses.size());
}

Result<void> check(std::span<const StampedPose> poses, const std::string& name) {
  if (poses.size() < kMinPoses)
    return unreadable(
        fmt::format("{}: holds {} poses, but a walk needs at least {}", name, poses.size(), kMinPoses));
  const double cos_half_widest = sin_cos(radians(kWidestTurn_deg / 2)).cos;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const StampedPose &before = poses[i - 1], &now = poses[i];
    if (now.time_s - before.time_s > kWidestGap_s)
      return unreadable(
          fmt::format("{}: no pose for {:.3f} s after time {:.4f}; at most {:g} s can be bridged", name,
                      now.time_s - before.time_s, before.time_s, kWidestGap_s));
    if (std::abs(before.orientation.dot(now.orientation)) < cos_half_widest)
      return unreadable(
          fmt::format("{}: turns by more than {:g} deg from one pose to the next at time {:.4f}", name,
                      kWidestTurn_deg, now.time_s));
  }
  return {};
}

}  // namespace

std::vector<StampedPose> placed(std::span<const StampedPose> poses, const PathPlacement& placement) {
  std::vector<StampedPose> moved(poses.begin(), poses.end());
  const Vector3d middle = mean_position(poses);
  const Vector3d target = placement.at_m.value_or(middle);
  const SinCos half = sin_cos(radians(placement.yaw_deg) / 2);
  const Eigen::Quaterniond turn(half.cos, 0, 0, half.sin);
  const Eigen::Quaterniond base = placement.upright ? upright_base(poses) : Eigen::Quaterniond::Identity();
  for (StampedPose& pose : moved) {
    pose.position_m = target + placement.scale * (turn * Vector3d(pose.position_m - middle));
    pose.orientation = turn * pose.orientation * base;
  }
  return moved;
}

Result<RecordedPath> read_path(const std::filesystem::path& file, const PathPlacement& placement,
                               double from_s) {
  const auto poses = read_tum(file);
  if (!poses) return tl::unexpected(poses.error());
  if (auto checked = check(*poses, file.string()); !checked) return tl::unexpected(checked.error());
  const std::vector<StampedPose> in_scene = placed(*poses, placement);
  RecordedPath recorded;
  recorded.path = std::make_shared<const SplinePath>(in_scene, placement.smoothing_s);
  recorded.start_s = recorded.path->first_s() + from_s;
  recorded.duration_s = recorded.path->last_s() - recorded.start_s;
  recorded.deviation = deviation(*recorded.path, in_scene);
  return recorded;
}

}  // namespace sweepscope::simulation
