#include <gtest/gtest.h>

#include <cmath>

#include "core/offset/estimator.hpp"
#include "core/recording/assemble/assemble.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/core/engine_fixtures.hpp"

// Motors that go in steps with rests between them: the scans of a rest fall on one line.

namespace sweepscope {
namespace {

struct InSteps {
  const char* scene;
  double steps_per_turn, dwell_s, sweep_s, swing_deg, offset_ms, duration_s;
  std::uint64_t seed;
};

SimulationOptions options_of(const InSteps& rig) {
  SimulationOptions options;
  options.scene = rig.scene;
  options.motor = MotorKind::kTriangle;
  options.steps_per_turn = rig.steps_per_turn;
  options.dwell_s = rig.dwell_s;
  options.sweep_s = rig.sweep_s;
  options.swing_deg = rig.swing_deg;
  options.offset_s = rig.offset_ms * test::kMs;
  options.duration_s = rig.duration_s;
  options.seed = rig.seed;
  return options;
}

// As a rig file that states everything reads it.
Recording read(const SimulationOptions& options) {
  return assemble(messages_of(simulate(options, Job()).value()), rig_of(options), std::nullopt).value();
}

// 7.2 and 1.8 deg; read as old angles sent again, their rests gave 21.1 for 4.1 ms, or a rig that moved.
TEST(Steps, ByAnEncoderAreAnswered) {
  for (const InSteps& rig : {InSteps{"room-3", 50, 0.077, 2.09, 90, -8.1, 8.8, 7},
                             InSteps{"room-6", 200, 0.052, 4.157, 63, -4.1, 17.5, 118},
                             InSteps{"room-1", 50, 0.1, 1.438, 45, 2.3, 6, 121}}) {
    const SimulationOptions options = options_of(rig);
    const Estimate found = test::estimated(read(options));
    ASSERT_TRUE(found.identifiable) << rig.seed << ": " << found.refusals[0].text;
    EXPECT_LT(*found.sigma_s, 1 * test::kMs) << rig.seed;
    EXPECT_LT(std::abs(*found.offset_s - options.offset_s), 3 * *found.sigma_s) << rig.seed;
  }
}

// 12.5 steps between the limits: a start that is wrong by a sweep has half a step too many.
TEST(Steps, ByAProfileWhoseReversalLiesWithinAStepAreNotMirrored) {
  for (const InSteps& rig : {InSteps{"room-5", 50, 0.081, 1.261, 45, -0.7, 5.3, 10},
                             InSteps{"room-2", 50, 0.109, 1.534, 45, 9.0, 6.4, 18}}) {
    SimulationOptions options = options_of(rig);
    const Recording by_encoder = read(options);
    options.motor_messages = MotorMessages::kNone;
    const Recording by_profile = read(options);
    const Estimate found = test::estimated(by_profile);
    ASSERT_TRUE(found.identifiable) << rig.seed << ": " << found.refusals[0].text;
    for (std::size_t i = 10; i + 10 < by_profile.scans.size(); ++i) {
      const double stamp_s = by_profile.scans[i].first_beam_s;
      const double profile_rad = by_profile.motor.angle_at(stamp_s + *found.offset_s),
                   true_rad = by_encoder.motor.angle_at(stamp_s + options.offset_s);
      EXPECT_NEAR(profile_rad, true_rad, 2 * kRadPerDeg) << rig.seed << " at " << stamp_s << " s";
    }
  }
}

}  // namespace
}  // namespace sweepscope
