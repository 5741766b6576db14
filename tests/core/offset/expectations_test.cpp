#include "core/offset/summary.hpp"

#include <gtest/gtest.h>

#include "tests/core/small_recording.hpp"

namespace sweepscope {
namespace {

using test::recording_of, test::track, test::triangle_rad;

std::string expectations(const Recording& recording) {
  std::string all;
  for (const std::string& line : expectations(recording, inspect(recording), find_sweeps(recording.motor)))
    all += line + "\n";
  return all;
}

TEST(Expectations, AreTheExpectedAccuracyAndTheReach) {
  const std::string text = expectations(recording_of(track(5.2, 0.01, triangle_rad)));
  EXPECT_NE(text.find("1 ms of offset turns a scan by 0.229 deg: 16 mm at the median range of 4 m."),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("Offsets up to 250 ms to either side"), std::string::npos) << text;
  EXPECT_NE(text.find("9 whole sweeps are enough for a stationary rig"), std::string::npos) << text;
}

TEST(Expectations, ExpectsARefusalOfSweepsThatSeeTheSameFewLines) {
  Recording recording = recording_of(track(5.2, 0.01, triangle_rad));
  EXPECT_EQ(expectations(recording).find("scan lines"), std::string::npos);
  for (LaserScan& scan : recording.scans) scan.first_beam_s *= 4;
  EXPECT_NE(expectations(recording).find("Expect a refusal: all sweeps of a direction have the same 5 scan"),
            std::string::npos)
      << expectations(recording);
  EXPECT_EQ(expectations(recording).find("Expect an accuracy"), std::string::npos);
}

TEST(Expectations, SaysWhatFewSamplesOfTheMotorCost) {
  const auto sampled_every = [](double period_s) {
    return expectations(recording_of(track(5.2, period_s, triangle_rad)));
  };
  EXPECT_EQ(sampled_every(0.01).find("is sampled"), std::string::npos);
  EXPECT_NE(sampled_every(0.1).find(
                "sampled only 5.0 times per sweep, which reduces the accuracy: sample it every 0.031 s."),
            std::string::npos)
      << sampled_every(0.1);
  EXPECT_NE(sampled_every(0.2).find("Expect a refusal: the motor is sampled only 2.5 times"),
            std::string::npos);
  EXPECT_EQ(sampled_every(0.2).find("Expect an accuracy"), std::string::npos);
}

TEST(Expectations, SaysWhatMakesAnEstimateImpossible) {
  EXPECT_EQ(expectations(recording_of(track(5, 0.01, [](double) { return 1.0; }))),
            "The motor does not turn, so there is no offset to determine.\n");
  EXPECT_NE(expectations(recording_of(track(5, 0.01, [](double t_s) { return 3 * t_s; })))
                .find("turns one way only"),
            std::string::npos);
  EXPECT_NE(expectations(recording_of(track(5, 0.01, [](double t_s) { return 0.1 * t_s; })))
                .find("never turns back"),
            std::string::npos);
}

}  // namespace
}  // namespace sweepscope
