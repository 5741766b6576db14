#include "core/simulation/worlds/walk.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "core/numbers.hpp"
#include "core/simulation/motion/trajectory.hpp"
#include "core/simulation/worlds/carrier.hpp"
#include "core/simulation/worlds/floor.hpp"

namespace sweepscope::simulation {
namespace {

constexpr std::uint64_t kWalkPurpose = 110;
constexpr int kAttempts = 30;
constexpr double kKnots_s = 0.05;

/// Slow swings of a rig that is held in the hand.
class Swing {
 public:
  Swing(Draw& draw, double size) : size_(size) {
    for (auto& channel : waves_)
      for (Wave& wave : channel) wave = {2 * kPi * draw.in(0.1, 0.4), draw.in(0, 2 * kPi)};
  }
  Sway at(double t_s) const {
    const auto both = [&](std::size_t channel, double amplitude) {
      const auto& [one, other] = waves_[channel];
      return size_ * amplitude / 2 *
             (sin_cos(one.rate_radps * t_s + one.phase_rad).sin +
              sin_cos(other.rate_radps * t_s + other.phase_rad).sin);
    };
    return {both(0, radians(7)), both(1, radians(7)), both(2, radians(14)), both(3, 0.05), both(4, 0.05)};
  }

 private:
  struct Wave {
    double rate_radps, phase_rad;
  };
  double size_;
  std::array<std::array<Wave, 2>, 5> waves_{};
};

std::vector<StampedPose> carried(const std::vector<Stride>& strides, const WalkStyle& style, Draw& draw) {
  const Gait gait(draw.seed(), style.gait);
  const Swing swing(draw, style.swing);
  const double height_m = draw.in(1.15, 1.55);
  std::vector<StampedPose> poses;
  for (const Stride& stride : strides) {
    Sway sway = gait.at(stride.t_s, stride.speed_mps);
    const Sway held = swing.at(stride.t_s);
    sway.roll_rad += held.roll_rad;
    sway.pitch_rad += held.pitch_rad;
    sway.yaw_rad += held.yaw_rad;
    const double left_m = sway.left_m + held.left_m;
    const Vector3d left(-stride.forward.y(), stride.forward.x(), 0);
    const Vector3d up = (height_m + sway.up_m + held.up_m) * Vector3d::UnitZ();
    poses.push_back({stride.t_s, stride.foot_m + left_m * left + up, swayed(heading(stride.forward), sway)});
  }
  return poses;
}

bool is_within(const RecordedPath& path, const WalkStyle& style) {
  const WalkMeasure walk = measure([&](double t_s) { return path.at(t_s); }, 0, path.duration_s);
  return walk.top_speed_mps <= style.max_speed_mps &&
         walk.top_angular_rate_radps <= radians(style.max_turn_dps);
}

bool is_clear(const RecordedPath& path, const RayCaster& caster) {
  constexpr double kStep_s = 0.02;
  for (double t_s = 0; t_s < path.duration_s; t_s += kStep_s)
    if (caster.distance_m(path.at(t_s).position_m, kWalkClearance_m)) return false;
  return true;
}

/// The way of a loop takes as long as the walk, but for a rest at its end: the speed is fitted to it.
std::vector<Stride> walked(const std::vector<Vector3d>& way, const WalkStyle& style, Carriage carriage,
                           Draw& draw) {
  const double to_arrive_s = carriage.duration_s - draw.in(0.5, 3);
  std::vector<Stride> strides = walk_along(way, style, carriage);
  for (int round = 0; round < 3; ++round) {
    const auto arrived = std::ranges::find_if(strides, &Stride::arrived);
    const double arrived_s = arrived == strides.end() ? 1.2 * carriage.duration_s : arrived->t_s;
    carriage.cruise_mps =
        std::clamp(carriage.cruise_mps * arrived_s / to_arrive_s, style.min_cruise_mps, style.max_cruise_mps);
    strides = walk_along(way, style, carriage);
  }
  return strides;
}

std::optional<RecordedPath> attempt(const Floor& floor, const RayCaster& caster, const WalkStyle& style,
                                    Draw draw, double duration_s) {
  Carriage carriage;
  carriage.duration_s = duration_s;
  carriage.cruise_mps = draw.in(style.min_cruise_mps, style.max_cruise_mps);
  carriage.seed = draw.seed();
  if (draw.chance(0.5)) carriage.begins_s = draw.in(1, 4);
  const bool returns = draw.chance(0.5);
  const double length_m = carriage.cruise_mps * duration_s * (returns ? 0.9 : 1.1) + (returns ? 0 : 3);
  const auto way = floor.way({length_m, returns}, draw);
  if (!way) return std::nullopt;
  const std::vector<Stride> strides =
      returns ? walked(*way, style, carriage, draw) : walk_along(*way, style, carriage);
  const std::vector<StampedPose> poses = carried(strides, style, draw);
  RecordedPath path;
  path.path = std::make_shared<const SplinePath>(poses, kKnots_s);
  path.duration_s = duration_s;
  path.deviation = deviation(*path.path, poses);
  if (!is_within(path, style) || !is_clear(path, caster)) return std::nullopt;
  return path;
}

}  // namespace

const std::vector<WalkStyle>& walk_styles() {
  static const std::vector<WalkStyle> styles{
      {.name = "calm",
       .min_cruise_mps = 0.6,
       .max_cruise_mps = 0.95,
       .heading_dps = 28,
       .max_speed_mps = 1.1,
       .max_turn_dps = 40,
       .gait = {}},
      {.name = "brisk",
       .min_cruise_mps = 1.2,
       .max_cruise_mps = 1.45,
       .heading_dps = 38,
       .max_speed_mps = 1.75,
       .max_turn_dps = 60,
       .gait =
           {.roll_deg = 2, .pitch_deg = 1.5, .yaw_deg = 2, .left_m = 0.025, .up_m = 0.02, .drift_deg = 0.5}},
      {.name = "wild",
       .min_cruise_mps = 0.8,
       .max_cruise_mps = 1.5,
       .heading_dps = 42,
       .max_speed_mps = 2.2,
       .max_turn_dps = 100,
       .gait = {.roll_deg = 2, .pitch_deg = 1.5, .yaw_deg = 2, .left_m = 0.025, .up_m = 0.02, .drift_deg = 1},
       .swing = 1,
       .mood = 0.35,
       .rests_hz = 0.05}};
  return styles;
}

std::optional<WalkStyle> walk_style(std::string_view name) {
  const auto found = std::ranges::find(walk_styles(), name, &WalkStyle::name);
  return found == walk_styles().end() ? std::nullopt : std::optional(*found);
}

std::vector<std::string_view> walk_names() {
  std::vector<std::string_view> names;
  for (const WalkStyle& style : walk_styles()) names.push_back(style.name);
  names.push_back(kStanding);
  return names;
}

std::optional<Stand> make_stand(const World& world, std::uint64_t seed) {
  constexpr double kShort_s = 5;
  const auto walk = make_walk(world, walk_styles().front(), seed, kShort_s);
  if (!walk) return std::nullopt;
  const Pose begin = walk->path->at(walk->path->first_s());
  const Vector3d ahead = begin.orientation * Vector3d::UnitX();
  return Stand{begin.position_m, std::atan2(ahead.y(), ahead.x()) / kRadPerDeg, 0};
}

std::optional<RecordedPath> make_walk(const World& world, const WalkStyle& style, std::uint64_t seed,
                                      double duration_s) {
  const Floor floor(world);
  const RayCaster caster(world.mesh);
  for (int number = 0; number < kAttempts; ++number)
    if (auto path = attempt(floor, caster, style,
                            Draw(seed, kWalkPurpose, static_cast<std::uint64_t>(number)), duration_s))
      return path;
  return std::nullopt;
}

}  // namespace sweepscope::simulation
