#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/simulation/motion/gait.hpp"
#include "core/simulation/motion/recorded_path.hpp"
#include "core/simulation/worlds/world.hpp"

namespace sweepscope::simulation {

/// How a rig is carried. The limits hold for every walk, swaying included.
struct WalkStyle {
  std::string_view name;
  double min_cruise_mps, max_cruise_mps;  // of the carrier where the way is straight
  double heading_dps;                     // the carrier's fastest turn
  double max_speed_mps, max_turn_dps;     // of the rig
  GaitSize gait;
  double swing = 0;     // of a rig held in the hand: 1 is about 14 deg in yaw, 7 in pitch and roll, and 5 cm
  double mood = 0.1;    // fraction by which the speed changes on the way
  double rests_hz = 0;  // how often the carrier stops
};

/// calm, brisk, wild.
const std::vector<WalkStyle>& walk_styles();
std::optional<WalkStyle> walk_style(std::string_view name);
/// Those of the walk styles, and kStanding.
std::vector<std::string_view> walk_names();
inline constexpr std::string_view kStanding = "stand";

/// A walk of duration_s through a world, drawn at random: half of them end where they begin, half of them
/// begin at rest. The rig keeps at least kWalkClearance_m from all surfaces. None where the world has no
/// room.
inline constexpr double kWalkClearance_m = 0.3;
std::optional<RecordedPath> make_walk(const World& world, const WalkStyle& style, std::uint64_t seed,
                                      double duration_s);

/// A rig that stands level where a calm walk of that seed begins. None where the world has no room.
std::optional<Stand> make_stand(const World& world, std::uint64_t seed);

}  // namespace sweepscope::simulation
