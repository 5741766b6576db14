// What the engine's stages cost on one thread, on simulated recordings of 721 beams. Machines differ:
// `references` gives each figure in runs of a fixed kernel that was timed in the same minute.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "core/offset/moving.hpp"
#include "core/offset/stationary.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using benchmark::Counter;
using benchmark::State;

constexpr double kTruth_s = 0.024;

// Ten million dependent multiplications and additions.
double reference_kernel() {
  double x = 0.5;
  for (int i = 0; i < 10'000'000; ++i) x = x * 0.999999 + 1e-7;
  return x;
}

double reference_s() {
  static const double least_s = [] {
    double fastest_s = std::numeric_limits<double>::infinity();
    for (int run = 0; run < 7; ++run) {
      const auto begin = std::chrono::steady_clock::now();
      benchmark::DoNotOptimize(reference_kernel());
      const std::chrono::duration<double> lasted = std::chrono::steady_clock::now() - begin;
      fastest_s = std::min(fastest_s, lasted.count());
    }
    return fastest_s;
  }();
  return least_s;
}

// A recording and what is known of it before any offset is tried.
struct Subject {
  explicit Subject(const Recording& its) : recording(its), problem(test::problem_of(its)) {
    sweeps = place_sweeps(problem, kTruth_s);
    recorded_s = double(recording.scans.size()) * 0.025;
  }
  const Recording& recording;
  OffsetProblem problem;
  std::vector<PlacedSweep> sweeps;
  double recorded_s = 0;
};

const Subject& room() {
  static const Subject subject(test::room(kTruth_s));
  return subject;
}

const Subject& walk() {
  static const Subject subject(test::simulated("metro-station", kTruth_s, 20).recording);
  return subject;
}

void count_cost(State& state, const Subject& subject) {
  const auto per = [&](double amount) {
    return Counter(amount, Counter::kIsIterationInvariantRate | Counter::kInvert);
  };
  state.counters["cpu_s_per_s"] = per(subject.recorded_s);
  state.counters["ms_per_sweep"] = per(double(subject.sweeps.size()) * 1e-3);
  state.counters["references"] = per(reference_s());
}

void reference(State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(reference_kernel());
}

void features(State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(extract_features(room().recording, FeatureOptions(), Job()).value());
  count_cost(state, room());
}

// Every beam with the motor angle of its own instant, as for a map.
void place_beams(State& state) {
  const Recording& recording = room().recording;
  const Kinematics kinematics(recording.rig.mount);
  for (auto _ : state) {
    MotorReader motor(recording.motor);
    Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
    for (const LaserScan& scan : recording.scans) {
      const auto ranges_m = recording.ranges(scan);
      for (std::uint32_t beam = 0; beam < scan.beams; ++beam)
        sum_m +=
            kinematics.base_from_motor(kinematics.point_in_motor(ranges_m[beam], scan.beam_angle_rad(beam)),
                                       motor.angle_at(scan.beam_s(beam) + kTruth_s));
    }
    benchmark::DoNotOptimize(sum_m);
  }
  count_cost(state, room());
  state.counters["points_per_s"] =
      Counter(double(recording.ranges_m.size()), Counter::kIsIterationInvariantRate);
}

void place_features(State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(place_sweeps(walk().problem, kTruth_s));
  double points = 0;
  for (const PlacedSweep& sweep : walk().sweeps) points += double(sweep.planes.size() + sweep.edges.size());
  count_cost(state, walk());
  state.counters["points_per_s"] = Counter(points, Counter::kIsIterationInvariantRate);
}

void odometry_of_a_pair(State& state) {
  const PlacedSweep &first = room().sweeps[3], &second = room().sweeps[4];
  for (auto _ : state) benchmark::DoNotOptimize(register_rigidly(map_of(first), second, OdometryOptions()));
  state.counters["references"] =
      Counter(reference_s(), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void stationary_candidate_of_a_room(State& state) {
  std::vector<std::size_t> pairs;
  for (const PairMotion& motion : pair_motions(room().problem, kTruth_s, OdometryOptions()))
    pairs.push_back(motion.sweep);
  for (auto _ : state)
    benchmark::DoNotOptimize(stationary_candidate(room().problem, kTruth_s, pairs, 1, OdometryOptions()));
  count_cost(state, room());
}

void track_a_walk(State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(track(walk().sweeps, Eigen::Vector3d::UnitX(), MappingOptions(), Job()).value());
  count_cost(state, walk());
}

void count_along_a_walk(State& state) {
  const TrackedWalk tracked = track(walk().sweeps, Eigen::Vector3d::UnitX(), MappingOptions(), Job()).value();
  for (auto _ : state)
    benchmark::DoNotOptimize(count_matches(walk().sweeps, tracked.sweeps, MappingOptions()));
  count_cost(state, walk());
}

void moving_candidate_of_a_walk(State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(
        moving_candidate(walk().problem, kTruth_s, Scoring::kTwoStage, MappingOptions(), Job()));
  count_cost(state, walk());
}

BENCHMARK(reference)->Unit(benchmark::kMillisecond);
BENCHMARK(features)->Unit(benchmark::kMillisecond);
BENCHMARK(place_beams)->Unit(benchmark::kMillisecond);
BENCHMARK(place_features)->Unit(benchmark::kMillisecond);
BENCHMARK(odometry_of_a_pair)->Unit(benchmark::kMillisecond);
BENCHMARK(stationary_candidate_of_a_room)->Unit(benchmark::kMillisecond);
BENCHMARK(track_a_walk)->Unit(benchmark::kMillisecond);
BENCHMARK(count_along_a_walk)->Unit(benchmark::kMillisecond);
BENCHMARK(moving_candidate_of_a_walk)->Unit(benchmark::kMillisecond);

}  // namespace

// The recordings are made before anything is timed.
static void prepare() {
  room();
  walk();
}

}  // namespace sweepscope

int main(int argc, char** argv) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  sweepscope::prepare();
  benchmark::RunSpecifiedBenchmarks();
}
