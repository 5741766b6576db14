#include "core/offset/over_time/over_time.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>
#include <mutex>
#include <set>

#include "core/offset/estimate_plan.hpp"
#include "core/offset/estimator.hpp"
#include "core/recording/formats/recording_file.hpp"
#include "core/results/estimate_json.hpp"
#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/core/engine_fixtures.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

using test::kMs;

constexpr double kSigma_s = 0.03 * kMs;

// Windows of 10 s whose offsets scatter by kSigma_s about a course.
std::vector<OffsetWindow> windows_about(const std::function<double(double t_s)>& offset_s, std::size_t count,
                                        double sigma_s = kSigma_s, std::uint64_t seed = 1) {
  std::vector<OffsetWindow> windows;
  for (std::size_t i = 0; i < count; ++i) {
    const double begin_s = 10.0 * double(i), time_s = begin_s + 5;
    const double error_s = kSigma_s * simulation::Random(seed, 1, i).normal();
    windows.push_back({begin_s, begin_s + 10, time_s, offset_s(time_s) + error_s, sigma_s, {}});
  }
  return windows;
}

OffsetCourse course(const std::vector<OffsetWindow>& windows) {
  return course_of(windows, windows.back().end_s / 2).value();
}

TEST(OffsetCourse, IsConstantWhereTheWindowsOnlyScatter) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const OffsetCourse found = course(windows_about([](double) { return 24 * kMs; }, 60, kSigma_s, seed));
    EXPECT_TRUE(found.constant()) << seed;
    EXPECT_NEAR(found.offset_s, 24 * kMs, 4 * found.sigma_s) << seed;
    EXPECT_NEAR(std::log(found.sigma_s * std::sqrt(60) / kSigma_s), 0, std::log(1.8)) << seed;
  }
}

TEST(OffsetCourse, HasTheRateOfClocksThatDriftApart) {
  const OffsetCourse found = course(windows_about([](double t_s) { return 24 * kMs + 75e-6 * t_s; }, 60));
  EXPECT_TRUE(found.jumps.empty());
  EXPECT_GT(found.rate_sigma, 0);
  EXPECT_NEAR(found.rate, 75e-6, 4 * found.rate_sigma);
  EXPECT_NEAR(found.offset_s, 24 * kMs + 75e-6 * 300, 4 * found.sigma_s);
  EXPECT_NEAR(found.offset_at_s(0), 24 * kMs, 0.05 * kMs);
}

TEST(OffsetCourse, HasAJumpBetweenTheWindowsWhereItIs) {
  for (const double jump_s : {40.0, 200.0, 560.0}) {
    const OffsetCourse found =
        course(windows_about([&](double t_s) { return t_s < jump_s ? 24 * kMs : 29 * kMs; }, 60));
    EXPECT_EQ(found.rate, 0);
    ASSERT_EQ(found.jumps.size(), 1U);
    EXPECT_LE(found.jumps[0].begin_s, jump_s);
    EXPECT_GE(found.jumps[0].end_s, jump_s);
    EXPECT_NEAR(found.jumps[0].end_s - found.jumps[0].begin_s, 10, 1e-9);
    EXPECT_NEAR(found.jumps[0].size_s, 5 * kMs, 4 * found.jumps[0].sigma_s);
    EXPECT_NEAR(found.offset_s, (jump_s < 300 ? 29 : 24) * kMs, 4 * found.sigma_s) << "at the middle";
  }
}

TEST(OffsetCourse, HasJumpsUpAndDownBesideARate) {
  const auto offset_s = [](double t_s) {
    return 10 * kMs + 20e-6 * t_s + (t_s > 200 ? 2 * kMs : 0) - (t_s > 400 ? 2 * kMs : 0);
  };
  const OffsetCourse found = course(windows_about(offset_s, 60));
  ASSERT_EQ(found.jumps.size(), 2U);
  EXPECT_NEAR(found.jumps[0].size_s, 2 * kMs, 4 * found.jumps[0].sigma_s);
  EXPECT_NEAR(found.jumps[1].size_s, -2 * kMs, 4 * found.jumps[1].sigma_s);
  EXPECT_NEAR(found.rate, 20e-6, 4 * found.rate_sigma);
  for (const double t_s : {5.0, 195.0, 205.0, 395.0, 405.0, 595.0})
    EXPECT_NEAR(found.offset_at_s(t_s), offset_s(t_s), 0.08 * kMs) << t_s;
}

TEST(OffsetCourse, ItsSigmasAreTheScatterOfItsAnswers) {
  constexpr int kSeeds = 100;
  double offset = 0, rate = 0, jump = 0;  // squares of error over sigma
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const OffsetCourse found = course(
        windows_about([](double t_s) { return 24 * kMs + 75e-6 * (t_s - 300) + (t_s > 420 ? 5 * kMs : 0); },
                      60, kSigma_s, seed));
    ASSERT_EQ(found.jumps.size(), 1U) << seed;
    offset += std::pow((found.offset_s - 24 * kMs) / found.sigma_s, 2);
    rate += std::pow((found.rate - 75e-6) / found.rate_sigma, 2);
    jump += std::pow((found.jumps[0].size_s - 5 * kMs) / found.jumps[0].sigma_s, 2);
  }
  // Somewhat below one, since the scatter of the windows only ever widens a sigma.
  for (const double squares : {offset, rate, jump}) {
    EXPECT_GT(squares / kSeeds, 0.6);
    EXPECT_LT(squares / kSeeds, 1.4);
  }
}

std::vector<OffsetWindow> windows_at(const std::vector<double>& offsets_ms, double sigma_ms = 0.01) {
  std::vector<OffsetWindow> windows;
  for (const double offset_ms : offsets_ms) {
    const double begin_s = 10.0 * double(windows.size());
    windows.push_back({begin_s, begin_s + 10, begin_s + 5, offset_ms * kMs, sigma_ms * kMs, {}});
  }
  return windows;
}

TEST(OffsetCourse, HasAJumpWithTwoWindowsOnASide) {
  for (const std::vector<double>& offsets_ms :
       {std::vector<double>{24.0, 24.1, 28.0, 28.0, 28.0}, {28, 28, 28.01, 24, 24.02, 24.01}}) {
    const OffsetCourse found = course(windows_at(offsets_ms));
    ASSERT_EQ(found.jumps.size(), 1U);
    EXPECT_NEAR(std::abs(found.jumps[0].size_s), 4 * kMs, 0.1 * kMs);
    EXPECT_EQ(found.rate, 0);
  }
}

TEST(OffsetCourse, AStepIsNoRate) {
  const OffsetCourse found = course(windows_at({23.995, 24.005, 28.999, 29.007}));
  ASSERT_EQ(found.jumps.size(), 1U);
  EXPECT_NEAR(found.jumps[0].size_s, 5 * kMs, 0.02 * kMs);
  EXPECT_EQ(found.rate_sigma, 0);
}

TEST(OffsetCourse, AJumpLiesAboutAWindowBetweenItsLevels) {
  const OffsetCourse found = course(windows_at({24, 24.01, 24, 26.2, 28, 28.01, 28}));
  ASSERT_EQ(found.jumps.size(), 1U);
  EXPECT_EQ(found.jumps[0].begin_s, 25);
  EXPECT_EQ(found.jumps[0].end_s, 45);
}

TEST(OffsetCourse, TakesOneWindowThatErrsForNoJump) {
  std::vector<OffsetWindow> windows = windows_about([](double) { return 24 * kMs; }, 60);
  *windows[30].offset_s += 3 * kMs;
  const OffsetCourse found = course(windows);
  EXPECT_TRUE(found.constant());
  EXPECT_NEAR(found.offset_s, 24 * kMs, 5 * found.sigma_s);
}

TEST(OffsetCourse, WidensItsSigmasWhereTheWindowsScatterMoreThanTheirsSay) {
  const OffsetCourse found = course(windows_about([](double) { return 24 * kMs; }, 60, kSigma_s / 4));
  EXPECT_TRUE(found.constant());
  EXPECT_NEAR(found.scatter, 4, 1.2);
  EXPECT_NEAR(found.sigma_s, kSigma_s / std::sqrt(60), 0.5 * kSigma_s / std::sqrt(60));
}

TEST(OffsetCourse, LeavesGapsOut) {
  std::vector<OffsetWindow> windows = windows_about([](double t_s) { return 75e-6 * t_s; }, 60);
  for (std::size_t i = 20; i < 40; ++i)
    windows[i] = {windows[i].begin_s, windows[i].end_s, 0, {}, {}, "None."};
  const OffsetCourse found = course(windows);
  EXPECT_EQ(found.windows, 40U);
  EXPECT_NEAR(found.rate, 75e-6, 4 * found.rate_sigma);
  for (OffsetWindow& window : windows) window.offset_s.reset();
  EXPECT_FALSE(course_of(windows, 300));
}

TEST(OverTime, WindowsCoverTheRecordingEvenlyAndAreAtLeastAsLongAsAskedFor) {
  const std::vector<RecordingPart> windows = windows_of(95, 10);
  ASSERT_EQ(windows.size(), 9U);
  EXPECT_EQ(windows.front().begin_s, 0);
  EXPECT_EQ(windows.back().end_s, 95);
  for (std::size_t i = 1; i < windows.size(); ++i) EXPECT_EQ(windows[i].begin_s, windows[i - 1].end_s);
  EXPECT_EQ(windows_of(4, 10).size(), 1U);
}

const Recording& drifting_room() {
  static const Recording recording = [] {
    SimulationOptions options;
    options.scene = "room-2";
    options.sweep_s = 0.51;
    options.duration_s = 80;
    options.clock_drift_ppm = 200;
    return simulate(options, Job()).value().recording;
  }();
  return recording;
}

const Recording& jumping_room() {
  static const Recording recording = [] {
    SimulationOptions options;
    options.scene = "room-3";
    options.sweep_s = 0.51;
    options.duration_s = 80;
    options.jump_s = 5 * kMs;
    options.jump_at_s = 52;
    return simulate(options, Job()).value().recording;
  }();
  return recording;
}

const Simulation& long_room() {
  static const Simulation made = [] {
    SimulationOptions options;
    options.scene = "room-4";
    options.sweep_s = 0.51;
    options.duration_s = 70;
    return simulate(options, Job()).value();
  }();
  return made;
}

Estimate over_time(const Recording& recording, double window_s = 0) {
  EstimateOptions options;
  options.over_time_s = window_s;
  return estimate(recording, options, Job()).value();
}

bool says(const std::vector<std::string>& sentences, const std::string& part) {
  return std::ranges::any_of(sentences,
                             [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

TEST(OverTime, GivesTheOffsetAtTheMiddleAndTheRateOfClocksThatDriftApart) {
  const Estimate found = over_time(drifting_room());
  ASSERT_TRUE(found.offset_s) << testing::PrintToString(found.reasons());
  const OffsetCourse& course = found.over_time->course.value();
  const double true_s = 24 * kMs + 200e-6 * (course.middle_s + drifting_room().scans[0].first_beam_s);
  EXPECT_NEAR(*found.offset_s, true_s, 0.1 * kMs);
  EXPECT_NEAR(*found.offset_s, true_s, 3 * *found.sigma_s);
  EXPECT_TRUE(course.jumps.empty());
  EXPECT_NEAR(course.rate, 200e-6, 3 * course.rate_sigma);
  EXPECT_LT(course.rate_sigma, 3e-6);
  EXPECT_NEAR(found.drift_ppm.value_or(0), 200, 8);
  EXPECT_EQ(found.over_time->windows.size(), 7U) << "of at least 10 s";
  for (const OffsetWindow& window : found.over_time->windows) {
    ASSERT_TRUE(window.offset_s) << window.reason;
    EXPECT_NEAR(*window.offset_s, 24 * kMs + 200e-6 * window.time_s, 5 * *window.sigma_s + 0.03 * kMs);
  }
}

TEST(OverTime, FindsAJumpToOneWindow) {
  const Estimate found = over_time(jumping_room(), 8);
  ASSERT_TRUE(found.offset_s) << testing::PrintToString(found.reasons());
  const OffsetCourse& course = found.over_time->course.value();
  ASSERT_EQ(course.jumps.size(), 1U);
  EXPECT_NEAR((course.jumps[0].begin_s + course.jumps[0].end_s) / 2, 52, 8);
  EXPECT_NEAR(course.jumps[0].size_s, 5 * kMs, 0.2 * kMs);
  EXPECT_NEAR(*found.offset_s, 24 * kMs, std::max(3 * *found.sigma_s, 0.05 * kMs)) << "before the jump";
}

Recording changing_room(double duration_s, double jump_ms, double jump_at_s, double drift_ppm = 0) {
  SimulationOptions options;
  options.scene = "room-1";
  options.duration_s = duration_s;
  options.jump_s = jump_ms * kMs;
  options.jump_at_s = jump_at_s;
  options.clock_drift_ppm = drift_ppm;
  return simulate(options, Job()).value().recording;
}

TEST(OverTime, ShortensItsWindowsUntilACourseDescribesThem) {
  const Estimate drifted = over_time(changing_room(40, 0, 0, 150));
  ASSERT_TRUE(drifted.offset_s) << testing::PrintToString(drifted.reasons());
  EXPECT_NEAR(drifted.over_time->course->rate, 150e-6, 3e-6);
  const Estimate jumped = over_time(changing_room(30, 4, 9));
  ASSERT_TRUE(jumped.offset_s) << testing::PrintToString(jumped.reasons());
  ASSERT_EQ(jumped.over_time->course->jumps.size(), 1U);
  EXPECT_NEAR(jumped.over_time->course->jumps[0].size_s, 4 * kMs, 0.1 * kMs);
  EXPECT_NEAR(*jumped.offset_s, 28 * kMs, 0.1 * kMs);
}

TEST(OverTime, AJumpThatIsRefusedWithoutItIsFoundOrNotPointedTo) {
  const Estimate short_one = estimate(changing_room(4.5, 5, 2), {}, Job()).value();
  ASSERT_FALSE(short_one.refusals.empty());
  EXPECT_EQ(short_one.refusals[0].kind, RefusalKind::kOffsetJumps) << short_one.refusals[0].text;
  EXPECT_FALSE(says(short_one.reasons(), "--over-time"));
  EXPECT_FALSE(estimate(changing_room(2, 3, 1), {}, Job()).value().offset_s);
  const Recording longer = changing_room(24, 3, 12);
  EXPECT_TRUE(says(estimate(longer, {}, Job()).value().reasons(), "--over-time"));
  EXPECT_EQ(over_time(longer).over_time->course->jumps.size(), 1U);
}

// One window shows no jump: the whole is judged by its parts.
TEST(OverTime, OfAShortRecordingThatJumpsIsRefused) {
  const Estimate found = over_time(changing_room(2, 3, 1));
  EXPECT_FALSE(found.identifiable);
  ASSERT_FALSE(found.refusals.empty());
  EXPECT_EQ(found.refusals[0].kind, RefusalKind::kOffsetChanges) << found.refusals[0].text;
}

TEST(OverTime, GivesTheSameBytesForOneThreadAndForMany) {
  const Recording part = window(drifting_room(), 0, 30);
  const auto json = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    return estimate_to_json(over_time(part), Timing::kNull);
  };
  const std::string one = json(1);
  EXPECT_EQ(one, json(4));
  EXPECT_EQ(one, json(2));
}

TEST(OverTime, SaysWhyAWindowTellsNothing) {
  Recording recording = window(drifting_room(), 0, 40);
  const double begin_s = recording.scans.front().first_beam_s;
  MotorTrack track;
  for (std::size_t i = 0; i < recording.motor.time_s.size(); ++i) {
    const double since_s = recording.motor.time_s[i] - begin_s;
    if (since_s > 9 && since_s < 21) continue;
    track.time_s.push_back(recording.motor.time_s[i]);
    track.angle_rad.push_back(recording.motor.angle_rad[i]);
  }
  recording.motor = track;
  const Estimate found = over_time(recording);
  ASSERT_TRUE(found.offset_s) << testing::PrintToString(found.reasons());
  std::size_t without = 0;
  for (const OffsetWindow& window : found.over_time->windows) {
    EXPECT_EQ(bool(window.offset_s), window.reason.empty()) << window.reason;
    const bool in_gap = window.begin_s < 21 && window.end_s > 9;
    EXPECT_TRUE(window.offset_s || in_gap) << window.begin_s << " to " << window.end_s;
    without += window.offset_s ? 0 : 1;
  }
  EXPECT_GE(without, 1U);
  EXPECT_LT(without, found.over_time->windows.size() / 2 + 1);
}

TEST(OverTime, IsInterruptedAtOnce) {
  Job job;
  job.cancel();
  EstimateOptions options;
  options.over_time_s = 0;
  const Estimate found = estimate(drifting_room(), options, job).value();
  EXPECT_TRUE(found.interrupted);
  EXPECT_FALSE(found.offset_s || found.over_time);
}

TEST(OverTime, IsRefusedWithAnotherMethod) {
  EstimateOptions options;
  options.over_time_s = 10;
  options.method = Method::kStationary;
  const auto found = estimate(window(drifting_room(), 0, 5), options, Job());
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ExitCode::kWrongUsage);
}

TEST(OverTime, OfAWalkThatDriftsHasItsRate) {
  SimulationOptions options;
  options.scene = "metro-station";
  options.duration_s = 60;
  options.clock_drift_ppm = 100;
  const Recording walk = simulate(options, Job()).value().recording;
  const Estimate found = over_time(walk);
  ASSERT_TRUE(found.offset_s) << testing::PrintToString(found.reasons());
  const OffsetCourse& course = found.over_time->course.value();
  EXPECT_EQ(found.kind, RigKind::kMoving);
  EXPECT_NEAR(*found.offset_s, 24 * kMs + 100e-6 * course.middle_s, 3 * *found.sigma_s);
  EXPECT_GT(course.rate_sigma, 0);
  EXPECT_NEAR(course.rate, 100e-6, 4 * course.rate_sigma);
}

TEST(SampledSweeps, AnswerForALongRecordingOfAStationaryRig) {
  const Recording& recording = long_room().recording;
  const Estimate found = estimate(recording, {}, Job()).value();
  ASSERT_TRUE(found.offset_s) << testing::PrintToString(found.reasons());
  EXPECT_NEAR(*found.offset_s, 24 * kMs, 3 * *found.sigma_s);
  ASSERT_TRUE(found.sample);
  EXPECT_EQ(found.sample->sweeps, 60U);
  EXPECT_GT(found.sample->of_sweeps, 130U);
  const Recording sample = parts_of(recording, sampled_sweeps(recording).value().groups);
  EXPECT_LT(sample.scans.size(), recording.scans.size() * 3 / 4);
  EXPECT_EQ(sample.scans.front().first_beam_s, recording.scans.front().first_beam_s);
  EXPECT_EQ(sample.scans.back().first_beam_s, recording.scans.back().first_beam_s);
}

TEST(SampledSweeps, TellTheirCandidatesWhileTheyAreComputed) {
  const Recording& recording = long_room().recording;
  ASSERT_TRUE(sampled_sweeps(recording));
  std::mutex mutex;
  std::set<double> told_s;
  KeptCandidates kept;
  kept.watch.finished = [&](const CurvePoint& point) {
    const std::lock_guard lock(mutex);
    told_s.insert(point.offset_s);
  };
  const Estimate found = estimate(recording, {}, kept, Job()).value();
  ASSERT_TRUE(found.sample);
  ASSERT_GT(found.curve.size(), 20U);
  std::set<double> answered_s;
  for (const CurvePoint& point : found.curve)
    if (point.capped_cost_m) answered_s.insert(point.offset_s);
  EXPECT_EQ(told_s, answered_s);
}

TEST(SampledSweeps, AreNotTakenOfShortRecordings) {
  EXPECT_FALSE(sampled_sweeps(window(drifting_room(), 0, 59)));
  EXPECT_FALSE(sampled_sweeps(Recording{}));
}

TEST(SampledSweeps, RefuseAnOffsetThatChangesAndNameTheCommand) {
  for (const Recording* recording : {&drifting_room(), &jumping_room()}) {
    const Estimate found = estimate(*recording, {}, Job()).value();
    EXPECT_FALSE(found.identifiable);
    EXPECT_FALSE(found.offset_s);
    EXPECT_TRUE(says(found.reasons(), "--over-time")) << testing::PrintToString(found.reasons());
    EXPECT_TRUE(says(found.reasons(), recording == &drifting_room() ? "drift apart" : "The offset "));
  }
}

class OverTimeFile : public test::FolderTest {};

// Parts of a file are as good as all of it.
TEST_F(OverTimeFile, PartsGiveTheBytesOfTheWhole) {
  const std::filesystem::path bag = folder_ / "room.bag";
  ASSERT_TRUE(write_bag(long_room(), bag, Job()));
  ReadOptions how;
  how.keep_intensities = false;
  const Recording whole = read_recording(bag, how, Job()).value();
  const auto file = RecordingFile::open(bag, how, Job(), 0).value();
  EXPECT_FALSE(file.is_whole());
  EXPECT_EQ(file.outline().scans.size(), whole.scans.size());
  for (const std::optional<double> over_time_s : {std::optional<double>(), std::optional<double>(30)}) {
    EstimateOptions options;
    options.over_time_s = over_time_s;
    const EstimatePlan plan = plan_estimate(file.outline(), options, false);
    EXPECT_LT(file.parts(plan.parts, Job()).value().scans.size(), whole.scans.size());
    EXPECT_EQ(estimate_to_json(estimate(file, options, Job()).value(), Timing::kNull),
              estimate_to_json(estimate(whole, options, Job()).value(), Timing::kNull));
  }
}

TEST_F(OverTimeFile, AWalkIsReadWholly) {
  const std::filesystem::path bag = folder_ / "walk.bag";
  ASSERT_TRUE(write_bag(test::simulated("metro-station", 0.024, 70), bag, Job()));
  const auto file = RecordingFile::open(bag, {}, Job(), 0).value();
  EXPECT_FALSE(plan_estimate(file.outline(), {}, false).parts.empty());
  const Estimate found = estimate(file, {}, Job()).value();
  EXPECT_EQ(found.kind, RigKind::kMoving);
  EXPECT_FALSE(found.sample);
  EXPECT_NEAR(found.offset_s.value(), 24 * kMs, 0.3 * kMs);
}

TEST(EstimatePlan, OfAFileWithFewBeamsIsThatOfTheWhole) {
  Recording few;
  few.scans.resize(3);
  const EstimatePlan plan = plan_estimate(few, {}, false);
  EXPECT_FALSE(plan.sample);
  EXPECT_TRUE(plan.parts.empty());
  EXPECT_FALSE(plan.over_time());
}

TEST(EstimatePlan, TakesAllOfARecordingForThePapersMethodsAndForAWalk) {
  const Recording recording = drifting_room();
  EXPECT_TRUE(plan_estimate(recording, {}, false).sample);
  EXPECT_FALSE(plan_estimate(recording, {}, true).sample) << "candidates are kept";
  EstimateOptions paper, walk, over_time;
  paper.method = Method::kStationary;
  EXPECT_FALSE(plan_estimate(recording, paper, false).sample);
  walk.assume = RigKind::kMoving;
  EXPECT_FALSE(plan_estimate(recording, walk, false).sample);
  over_time.over_time_s = 0;
  EXPECT_TRUE(plan_estimate(recording, over_time, false).over_time());
}

TEST(OverTimeJson, ReadsWhatItWrote) {
  Estimate estimate;
  estimate.recording = "room.bag";
  estimate.identifiable = true;
  estimate.offset_s = 24 * kMs;
  estimate.sigma_s = 0.02 * kMs;
  OffsetOverTime over{{{0, 10, 5.1, 20 * kMs, 0.1 * kMs, {}}, {10, 20, 15, {}, {}, "There are no scans."}},
                      {}};
  over.course = OffsetCourse{10, 24 * kMs, 0.02 * kMs, 75e-6, 1e-6, {{4, 6, 5 * kMs, 0.1 * kMs}}, 1.5, 1};
  estimate.over_time = over;
  estimate.sample = SweepSample{10, 60, 7200};
  const std::string text = estimate_to_json(estimate, Timing::kNull);
  for (const char* part : {R"("t_s": 5.1,)", R"("rate_ppm": 75)", R"("jump_ms": 5)", R"("of_sweeps": 7200)",
                           R"("reason": "There are no scans.")"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in " << text;
  const auto read = parse_estimate_json(text, "estimate.json");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(estimate_to_json(*read, Timing::kNull), text);
  EXPECT_EQ(over_time_to_csv(*read->over_time),
            "t_s,offset_ms,sigma_ms,from_s,to_s,fit_ms\n"
            "5.1,20,0.1,0,10,23.6325\n"
            "15,,,10,20,24.375\n");
}

TEST(OverTimeOption, TakesNothingOrALengthInSeconds) {
  const EstimateOption& option = *find_estimate_option("over-time");
  EstimateOptions options;
  ASSERT_TRUE(option.set(options, ""));
  EXPECT_EQ(options.over_time_s, 0);
  ASSERT_TRUE(option.set(options, "20"));
  EXPECT_EQ(options.over_time_s, 20);
  for (const char* wrong : {"0", "-5", "5ms", "x", "1e9"}) EXPECT_FALSE(option.set(options, wrong)) << wrong;
}

}  // namespace
}  // namespace sweepscope
