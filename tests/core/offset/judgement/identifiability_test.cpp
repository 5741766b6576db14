#include "core/offset/judgement/identifiability.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "core/offset/judgement/unseen_sigma.hpp"
#include "core/offset/judgement/warnings.hpp"
#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/motion/motor.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using simulation::Motor;
using simulation::MotorKind;
using test::kMs;

const SearchScale kScale{1 * kMs, 60 * kMs, 250 * kMs};

// Capped cost over -30 to 30 ms by 1 ms.
template <typename Cost>
std::vector<CurvePoint> curve_of(const Cost& cost_of_ms) {
  std::vector<CurvePoint> curve;
  for (int ms = -30; ms <= 30; ++ms) {
    CurvePoint& point = curve.emplace_back();
    point.offset_s = ms * kMs;
    point.capped_cost_m = cost_of_ms(double(ms));
  }
  return curve;
}

double valley(double ms, double at_ms, double depth_m) {
  return -depth_m * std::exp(-(ms - at_ms) * (ms - at_ms) / 18);
}

TEST(RivalReason, ASecondValleyThatIsNearlyAsDeepIsNamed) {
  const auto two = curve_of([](double ms) { return 0.3 + valley(ms, -10, 0.2) + valley(ms, 12, 0.19); });
  const MaybeRefusal reason = rival_refusal(two, 20, kScale);
  ASSERT_TRUE(reason);
  EXPECT_NE(reason->text.find("-10 ms and 12 ms"), std::string::npos) << reason->text;
}

TEST(RivalReason, AShallowOneIsNot) {
  EXPECT_FALSE(rival_refusal(
      curve_of([](double ms) { return 0.3 + valley(ms, -10, 0.2) + valley(ms, 12, 0.1); }), 20, kScale));
}

TEST(EdgeReason, IsGivenAtBothEndsOnly) {
  const auto falling = curve_of([](double ms) { return 0.3 - 0.001 * ms; });
  EXPECT_TRUE(edge_refusal(falling, 60));
  EXPECT_TRUE(edge_refusal(falling, 0));
  EXPECT_FALSE(edge_refusal(falling, 30));
}

// Of a 2D scanner with so many scans a sweep.
struct Scanned {
  explicit Scanned(int scans_a_sweep) {
    recording->scans.resize(3);
    for (std::size_t i = 0; i < 3; ++i) recording->scans[i].first_beam_s = 0.025 * double(i);
    problem.recording = recording.get();
    problem.motor.median_sweep_s = 0.025 * scans_a_sweep;
    problem.motor.median_speed_rad_s = 1;
  }
  std::shared_ptr<Recording> recording = std::make_shared<Recording>();
  OffsetProblem problem;
};

RefusalKind flat_kind(double level, double depth, int scans_a_sweep) {
  const auto curve = curve_of([=](double ms) { return level + valley(ms, 0, depth); });
  const auto refused = flat_refusal(curve, 30, Scanned(scans_a_sweep).problem);
  return refused ? refused->kind : RefusalKind::kUnknown;
}

TEST(FlatReason, IsGivenWhereTheValleyIsShallow) {
  EXPECT_EQ(flat_kind(0.3, 0.1, 40), RefusalKind::kUnknown);
  EXPECT_EQ(flat_kind(0.1, 0.005, 40), RefusalKind::kFlatCost);
}

TEST(FlatReason, TellsAPoorFitAndSparseLinesFromASceneThatDoesNotTell) {
  EXPECT_EQ(flat_kind(0.02, 0.001, 40), RefusalKind::kFlatCost);
  EXPECT_EQ(flat_kind(0.02, 0.001, 10), RefusalKind::kLinesTooFarApart);
  EXPECT_EQ(flat_kind(0.17, 0.001, 40), RefusalKind::kSweepsFitNowhere);
}

/// Scans every 25 ms, the fifth to come missing, each received later than it was made by `late_s`.
Recording received(const std::function<double(int i)>& late_s) {
  Recording recording;
  recording.report.laser_stamps.used = StampSource::kReceive;
  recording.report.laser_stamps.median_period_s = 25 * kMs;
  for (int i = 0; i < 200; ++i) {
    if (i % 10 == 4) continue;
    LaserScan& scan = recording.scans.emplace_back();
    scan.first_beam_s = i * 25 * kMs + late_s(i);
    scan.beams = 1;
  }
  return recording;
}

TEST(StampsReason, IsGivenForReceiveTimesThatTellNotWhichScanWasWhen) {
  const auto bursts = [](int i) { return i / 2 % 2 * 10 * kMs; };
  const MaybeRefusal reason = scan_times_refusal(received(bursts), kScale);
  ASSERT_TRUE(reason);
  EXPECT_NE(reason->text.find("The scans' receive times are uneven"), std::string::npos) << reason->text;
  EXPECT_FALSE(scan_times_refusal(received([](int i) { return i / 2 % 2 * 2 * kMs; }), kScale));
  Recording by_header = received(bursts);
  by_header.report.laser_stamps.used = StampSource::kHeader;
  EXPECT_FALSE(scan_times_refusal(by_header, kScale));
  const SearchScale slow{50 * kMs, 500 * kMs, 2000 * kMs};
  EXPECT_FALSE(scan_times_refusal(received(bursts), slow)) << "the motor turns little meanwhile";
}

TEST(GapsReason, CountsTheScansMadeWhileTheMotorWasRecorded) {
  Recording recording;
  recording.motor.time_s = {0, 10};
  recording.motor.angle_rad = {0, 1};
  for (int i = -20; i < 10; ++i) {
    LaserScan& scan = recording.scans.emplace_back();
    scan.first_beam_s = i + 0.5;
    scan.beams = 1;
  }
  std::vector<char> covered(30, 0);
  for (std::size_t i = 20; i < 24; ++i) covered[i] = 1;
  const MaybeRefusal reason = gaps_refusal(recording, covered, 0, 0);
  ASSERT_TRUE(reason);
  EXPECT_NE(reason->text.find("only 4 of 10"), std::string::npos) << reason->text;
  covered[24] = 1;
  EXPECT_FALSE(gaps_refusal(recording, covered, 0, 0));
}

/// So many sweeps of 0.5 s, sampled so often each.
struct Sampled {
  MotorTrack track;
  MotorMotion motor;
  Sampled(double samples_a_sweep, std::size_t sweeps) {
    const double sweep_s = 0.5, end_s = sweep_s * static_cast<double>(sweeps);
    for (double t_s = 0; t_s < end_s; t_s += sweep_s / samples_a_sweep) {
      track.time_s.push_back(t_s);
      track.angle_rad.push_back(std::abs(std::remainder(t_s, 2 * sweep_s)) * 6.28);
    }
    motor.sweeps.resize(sweeps);
    motor.median_sweep_s = sweep_s;
    motor.median_speed_rad_s = 6.28;
  }
};

TEST(EncoderSampling, LeavesLittleUncertainWhereItIsDense) {
  const auto sigma_s = [](double samples) {
    const Sampled s(samples, 12);
    EXPECT_NEAR(samples_per_sweep(s.track, s.motor), samples, 1e-6);
    return encoder_sampling_sigma_s(s.track, s.motor);
  };
  EXPECT_LT(sigma_s(50), 0.001 * kMs);
  EXPECT_LT(sigma_s(10), 0.02 * kMs);
  EXPECT_GT(sigma_s(5), 0.1 * kMs);
}

TEST(SamplingReason, IsGivenForAFewSamplesASweepAndAWarningForSomeMore) {
  const auto reason = [](double samples) {
    const Sampled s(samples, 12);
    return samples_refusal(s.track, s.motor, kScale);
  };
  ASSERT_TRUE(reason(2));
  EXPECT_NE(reason(2)->text.find("sampled only 2.0 times per sweep"), std::string::npos) << reason(2)->text;
  EXPECT_TRUE(reason(1.37));
  EXPECT_TRUE(reason(2.9));
  EXPECT_FALSE(reason(5));
  const Sampled sparse(5, 12), dense(50, 12);
  EXPECT_TRUE(sampling_warning(sparse.track, sparse.motor));
  EXPECT_FALSE(sampling_warning(dense.track, dense.motor));
}

MaybeRefusal refusal_of(MotorKind kind) {
  const Motor motor(kind, 0.5, 0.1);
  const MotorTrack track = test::track_of([&](double t_s) { return motor.angle_rad(t_s); }, 0, 4);
  return motor_refusal(track, find_sweeps(track));
}

TEST(MotorRefusal, AMotorThatTurnsToAndFroHasNone) {
  for (const MotorKind kind : {MotorKind::kTriangle, MotorKind::kTrapezoid, MotorKind::kSine})
    EXPECT_FALSE(refusal_of(kind));
}

TEST(MotorRefusal, AMotorThatIsStuckOrTurnsOneWaySaysSo) {
  EXPECT_EQ(refusal_of(MotorKind::kStuck).value().kind, RefusalKind::kMotorDoesNotMove);
  EXPECT_NE(refusal_of(MotorKind::kStuck)->text.find("does not move"), std::string::npos);
  const std::string one_way = refusal_of(MotorKind::kOneWay).value().text;
  EXPECT_NE(one_way.find("one way only, at one speed"), std::string::npos) << one_way;
  EXPECT_NE(one_way.find("record 5 s at one speed and 5 s at half of it."), std::string::npos) << one_way;
}

TEST(MotorRefusal, ATrackOfHardlyAnySampleSaysSo) {
  EXPECT_EQ(motor_refusal(MotorTrack{{1.0}, {0.2}}, MotorMotion()).value().kind,
            RefusalKind::kFewMotorSamples);
}

TEST(DriftReason, NeedsAMillisecondAndThreeSigma) {
  const Trend trend{200e-6, 1e-6};
  EXPECT_TRUE(drift_refusal(trend, 10, 0.1 * kMs));
  EXPECT_NE(drift_refusal(trend, 10, 0.1 * kMs)->text.find("200 ppm"), std::string::npos);
  EXPECT_FALSE(drift_refusal(trend, 4, 0.1 * kMs)) << "0.8 ms";
  EXPECT_FALSE(drift_refusal(trend, 10, 0.7 * kMs)) << "less than three sigma";
  EXPECT_FALSE(drift_refusal({200e-6, 100e-6}, 10, 0.1 * kMs)) << "chance";
}

TEST(LinesReason, IsGivenForAHandfulOfLines) {
  ASSERT_TRUE(lines_refusal(4.5));
  EXPECT_NE(lines_refusal(4.5)->text.find("the same 4.5 scan lines"), std::string::npos)
      << lines_refusal(4.5)->text;
  EXPECT_TRUE(lines_refusal(7));
  EXPECT_FALSE(lines_refusal(8));
}

TEST(LinesSigma, FallsWithTheNumberOfLines) {
  MotorMotion motor;
  motor.median_sweep_s = 0.2;
  EXPECT_NEAR(lines_sigma_s(motor, 8), 0.045 * kMs, 0.005 * kMs);
  EXPECT_LT(lines_sigma_s(motor, 100), 0.001 * kMs);
  EXPECT_EQ(lines_sigma_s(motor, std::numeric_limits<double>::infinity()), 0);
}

TEST(StampsSigma, IsThatOfTheMeanOfScatteredStamps) {
  Recording even, scattered;
  for (std::uint64_t i = 0; i < 400; ++i) {
    even.scans.emplace_back().first_beam_s = 0.025 * double(i);
    scattered.scans.emplace_back().first_beam_s =
        0.025 * double(i) + kMs * simulation::Random(1, 2, i).normal();
  }
  EXPECT_LT(stamps_sigma_s(even), 1e-12);
  EXPECT_NEAR(stamps_sigma_s(scattered), 1.75 * kMs / 20, 0.015 * kMs);
  EXPECT_EQ(stamps_sigma_s(Recording()), 0);
}

TEST(SigmaReason, IsJudgedByTheMotorsSpeed) {
  EXPECT_TRUE(sigma_refusal(2 * kMs, kScale));
  EXPECT_FALSE(sigma_refusal(2 * kMs, SearchScale{20 * kMs, 260 * kMs, 2}));
  EXPECT_TRUE(sigma_refusal(std::nullopt, kScale));
}

TEST(Warnings, NameASweepOfAWholeNumberOfScans) {
  Recording recording;
  for (int i = 0; i < 160; ++i) {
    LaserScan& scan = recording.scans.emplace_back();
    scan.first_beam_s = i * 0.025;
  }
  MotorMotion motor;
  motor.sweeps.resize(8);
  motor.median_sweep_s = 0.5;
  EXPECT_TRUE(aliased_warning(recording, motor));
  motor.median_sweep_s = 0.513;
  EXPECT_FALSE(aliased_warning(recording, motor));
}

TEST(Warnings, NameAnUnevenEncoderAndASlowMotor) {
  MotorTrack even, uneven;
  for (int i = 0; i < 100; ++i) {
    even.time_s.push_back(i * 0.01);
    uneven.time_s.push_back(i * 0.01 + (i * 7 % 10) * 0.001);
  }
  EXPECT_FALSE(encoder_warning(even));
  EXPECT_TRUE(encoder_warning(uneven));
  MotorMotion motor;
  motor.median_speed_rad_s = 6.28;
  EXPECT_FALSE(slow_motor_warning(motor));
  motor.median_speed_rad_s = 0.33;
  ASSERT_TRUE(slow_motor_warning(motor));
  EXPECT_NE(slow_motor_warning(motor)->find("0.019 deg"), std::string::npos);
}

}  // namespace
}  // namespace sweepscope
