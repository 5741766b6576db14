// What the engine's stages cost on one thread, on simulated recordings of 721 beams. Machines differ:
// `references` gives each figure in runs of a fixed kernel that was timed in the same minute.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/loam/feature_map.hpp"
#include "core/loam/matching.hpp"
#include "core/map/offset_map.hpp"
#include "core/map/surfaces/surface_thickness.hpp"
#include "core/offset/criteria/moving_candidate.hpp"
#include "core/offset/criteria/stationary_candidate.hpp"
#include "core/offset/estimator.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using benchmark::Counter;
using benchmark::State;

constexpr double kTruth_s = 0.024;

std::optional<tbb::global_control> one_thread;
void limit_to_one_thread() {
  one_thread.emplace(tbb::global_control::max_allowed_parallelism, 1);
}

// Ten million dependent multiplications and additions.
double reference_kernel() {
  double x = 0.5;
  for (int i = 0; i < 10'000'000; ++i) x = x * 0.999999 + 1e-7;
  return x;
}

double reference_s() {
  static const double min_s = [] {
    double fastest_s = std::numeric_limits<double>::infinity();
    for (int run = 0; run < 7; ++run) {
      const auto begin = std::chrono::steady_clock::now();
      benchmark::DoNotOptimize(reference_kernel());
      const std::chrono::duration<double> lasted = std::chrono::steady_clock::now() - begin;
      fastest_s = std::min(fastest_s, lasted.count());
    }
    return fastest_s;
  }();
  return min_s;
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

// The most memory that the program held since the last `forget`, from Linux's own books.
class PeakMemory {
 public:
  static void forget() { std::ofstream("/proc/self/clear_refs") << 5; }
  static double mb() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
      if (word == "VmHWM:") {
        double kb = 0;
        status >> kb;
        return kb / 1024;
      }
    return 0;
  }
};

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
  for (auto _ : state) benchmark::DoNotOptimize(track(walk().sweeps, MappingOptions(), Job()).value());
  count_cost(state, walk());
}

void count_along_a_walk(State& state) {
  const TrackedWalk tracked = track(walk().sweeps, MappingOptions(), Job()).value();
  for (auto _ : state)
    benchmark::DoNotOptimize(
        count_matches(walk().problem, kTruth_s, tracked.sweeps, MappingOptions(), Job()));
  count_cost(state, walk());
}

void loam_candidate_of_a_walk(State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(loam_candidate(walk().problem, kTruth_s, MappingOptions(), Job()));
  count_cost(state, walk());
}

// How cost grows: with the length of a recording, with the number of candidates, and with the size of a map.
// Each cost is per unit, so a row's numbers stay where growth is linear; `peak_mb` is the program's,
// recordings included.
const Subject& walk_of(int duration_s) {
  static std::map<int, Subject> subjects;
  const auto found = subjects.find(duration_s);
  if (found != subjects.end()) return found->second;
  return subjects.try_emplace(duration_s, test::simulated("metro-station", kTruth_s, duration_s).recording)
      .first->second;
}

void growth_with_length(State& state) {
  const Subject& subject = walk_of(int(state.range(0)));
  PeakMemory::forget();
  for (auto _ : state)
    benchmark::DoNotOptimize(track(subject.problem, kTruth_s, MappingOptions(), Job()).value());
  count_cost(state, subject);
  state.counters["peak_mb"] = PeakMemory::mb();
}

void direct_growth_with_length(State& state) {
  const Subject& subject = walk_of(int(state.range(0)));
  EstimateOptions options;
  options.method = Method::kDirect;
  PeakMemory::forget();
  for (auto _ : state) benchmark::DoNotOptimize(estimate(subject.recording, options, Job()).value());
  count_cost(state, subject);
  state.counters["peak_mb"] = PeakMemory::mb();
}

void growth_with_candidates(State& state) {
  EstimateOptions options;
  options.method = Method::kMoving;
  const double half_s = 0.5e-4 * double(state.range(0));
  options.ranges = {{kTruth_s - half_s, kTruth_s + half_s, 1e-4}};
  PeakMemory::forget();
  for (auto _ : state) benchmark::DoNotOptimize(estimate(walk().recording, options, Job()).value());
  state.counters["s_per_candidate"] =
      Counter(double(state.range(0)), Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["peak_mb"] = PeakMemory::mb();
}

// Points of a wide plain, ten to the square metre; queries spread over it.
void growth_with_map_size(State& state) {
  const int points = int(state.range(0));
  const double side_m = std::sqrt(points / 10.0);
  FeatureMap map;
  simulation::Random random(1, 1, 1);
  const auto drawn = [&] {
    return Eigen::Vector3f(float(side_m * random.uniform()), float(side_m * random.uniform()), 0);
  };
  for (int i = 0; i < points; ++i) map.insert(drawn(), std::uint32_t(i), i % 2 == 0 ? 1 : -1);
  constexpr int kQueries = 1000;
  std::vector<Eigen::Vector3f> queries_m(kQueries);
  for (Eigen::Vector3f& query_m : queries_m) query_m = drawn();
  Neighbours near;
  PeakMemory::forget();
  for (auto _ : state)
    for (const Eigen::Vector3f& query_m : queries_m) {
      map.nearest(query_m, 1, SweepFilter::kAny, 10, 2, near);
      benchmark::DoNotOptimize(near);
    }
  state.counters["s_per_query"] = Counter(kQueries, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["peak_mb"] = PeakMemory::mb();
}

// Neighbours on planes and along lines, as a map gives them: 10 mm thick, on 5 scan lines.
std::vector<Neighbours> neighbourhoods() {
  simulation::Random random(1, 2, 1);
  const auto within = [&](double size) { return float(size * (random.uniform() - 0.5)); };
  std::vector<Neighbours> all(1000);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const float width_m = k % 2 == 0 ? 0.5F : 0.01F;
    const Eigen::Matrix3f turn = Eigen::Quaternionf::UnitRandom().toRotationMatrix();
    Neighbours& near = all[k];
    near.count = Neighbours::kMax;
    near.lines = near.count / 2;
    for (Eigen::Vector3f& p_m : near.p_m)
      p_m = Eigen::Vector3f(20, -10, 1) +
            turn * Eigen::Vector3f(within(0.5), within(double(width_m)), within(0.01));
  }
  return all;
}

void planes_and_lines(State& state) {
  const std::vector<Neighbours> all = neighbourhoods();
  const PatchOptions options;
  for (auto _ : state)
    for (std::size_t k = 0; k < all.size(); ++k)
      if (k % 2 == 0)
        benchmark::DoNotOptimize(fit_plane(all[k], options, 0.5));
      else
        benchmark::DoNotOptimize(fit_line(all[k], options, 0.5));
  state.counters["s_per_patch"] =
      Counter(double(all.size()), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

// The eigenvectors of the same neighbours by Eigen's closed formula, without the checks of a patch.
void planes_and_lines_by_eigen(State& state) {
  const std::vector<Neighbours> all = neighbourhoods();
  for (auto _ : state)
    for (const Neighbours& near : all) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
      for (const Eigen::Vector3f& p_m : near.p_m) {
        const Eigen::Vector3d d = p_m.cast<double>() - near.p_m[0].cast<double>();
        sum += d;
        squares += d * d.transpose();
      }
      const Eigen::Vector3d mean = sum / near.count;
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
      solver.computeDirect(squares / near.count - mean * mean.transpose());
      benchmark::DoNotOptimize(solver.eigenvectors());
    }
  state.counters["s_per_patch"] =
      Counter(double(all.size()), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

// The map of 60 s of walking, 1.7 million points, at the offset and 5 ms off; on all cores.
void thickness_of_a_map(State& state) {
  const double offset_s = kTruth_s - 1e-3 * double(state.range(0));
  const Simulation& simulation = test::simulated("metro-station", kTruth_s, 60);
  MapOptions options;
  for (const TruthPose& pose : simulation.truth)
    options.poses.push_back({pose.time_s, pose.position_m, pose.orientation});
  const auto maps = build_maps(simulation.recording, std::vector{offset_s}, options, Job()).value();
  const MapCloud& cloud = *maps.front().cloud;
  one_thread.reset();
  for (auto _ : state) benchmark::DoNotOptimize(surface_thickness(cloud));
  limit_to_one_thread();
  state.counters["points"] = double(cloud.size());
}

BENCHMARK(reference)->Unit(benchmark::kMillisecond);
BENCHMARK(thickness_of_a_map)
    ->Arg(0)
    ->Arg(5)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(planes_and_lines)->Unit(benchmark::kMicrosecond);
BENCHMARK(planes_and_lines_by_eigen)->Unit(benchmark::kMicrosecond);
BENCHMARK(features)->Unit(benchmark::kMillisecond);
BENCHMARK(place_beams)->Unit(benchmark::kMillisecond);
BENCHMARK(place_features)->Unit(benchmark::kMillisecond);
BENCHMARK(odometry_of_a_pair)->Unit(benchmark::kMillisecond);
BENCHMARK(stationary_candidate_of_a_room)->Unit(benchmark::kMillisecond);
BENCHMARK(track_a_walk)->Unit(benchmark::kMillisecond);
BENCHMARK(count_along_a_walk)->Unit(benchmark::kMillisecond);
BENCHMARK(loam_candidate_of_a_walk)->Unit(benchmark::kMillisecond);
BENCHMARK(growth_with_length)->Arg(20)->Arg(40)->Arg(80)->Unit(benchmark::kMillisecond);
BENCHMARK(direct_growth_with_length)->Arg(20)->Arg(40)->Arg(80)->Unit(benchmark::kMillisecond);
BENCHMARK(growth_with_candidates)->Arg(5)->Arg(10)->Arg(20)->Unit(benchmark::kMillisecond);
BENCHMARK(growth_with_map_size)->Arg(10'000)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace

// The recordings are made before anything is timed.
static void prepare() {
  room();
  walk();
}

}  // namespace sweepscope

int main(int argc, char** argv) {
  sweepscope::limit_to_one_thread();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  sweepscope::prepare();
  benchmark::RunSpecifiedBenchmarks();
}
