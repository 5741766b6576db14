// How the answers depend on options that were set by experience: each one is halved and doubled, and the
// answers on simulated recordings are compared with those of the defaults. The largest change, in
// milliseconds.
//   build/bin/sweepscope_option_changes [GROUP]     odometry, features, stationary or walk; else all of them
#include <fmt/format.h>

#include <cmath>
#include <concepts>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/offset/estimator.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "core/offset/stationary/direct_stationary.hpp"
#include "core/offset/walk/joint_walk.hpp"
#include "core/simulation/simulate.hpp"

namespace sweepscope {
namespace {

constexpr double kTruth_s = 0.024, kSearch_s = 0.03;

std::vector<Recording> simulated(const std::vector<const char*>& scenes, double duration_s) {
  std::vector<Recording> recordings;
  for (const char* scene : scenes) {
    SimulationOptions options;
    options.scene = scene;
    options.offset_s = kTruth_s;
    options.duration_s = duration_s;
    recordings.push_back(simulate(options, Job()).value().recording);
  }
  return recordings;
}

const std::vector<Recording>& rooms() {
  static const std::vector<Recording> rooms = simulated({"room-1", "room-3"}, 4.5);
  return rooms;
}

const std::vector<Recording>& walks() {
  static const std::vector<Recording> walks = simulated({"metro-station", "cemetery"}, 12);
  return walks;
}

OffsetProblem problem_of(const Recording& recording, const FeatureOptions& features) {
  return problem_for(prepare(recording, features, Job()).value(), kTruth_s - kSearch_s, kTruth_s + kSearch_s);
}

// The answer of each recording; none where there is too little to answer from.
using Answers = std::vector<std::optional<double>>;

Answers by_criteria(const OdometryOptions& odometry) {
  EstimateOptions options;
  options.method = Method::kStationary;
  options.ranges = {{0.021, 0.027, 0.001}};
  options.fit = Fit::kParabola;
  options.odometry = odometry;
  Answers answers;
  for (const Recording& room : rooms()) answers.push_back(estimate(room, options, Job()).value().offset_s);
  return answers;
}

Answers stationary(const FeatureOptions& features, const StationaryDirectOptions& options) {
  Answers answers;
  for (const Recording& room : rooms()) {
    const OffsetProblem problem = problem_of(room, features);
    const StationaryDirect found = solve_stationary(stationary_grid(problem), kTruth_s, options, Job());
    answers.push_back(found.matches < options.min_matches ? std::nullopt : std::optional(found.offset_s));
  }
  return answers;
}

Answers along_walks(const JointWalkOptions& options) {
  Answers answers;
  for (const Recording& walk : walks()) {
    const OffsetProblem problem = problem_of(walk, FeatureOptions());
    const TrackedWalk tracked = track(problem, kTruth_s, options.mapping, Job()).value();
    const auto found = solve_joint_walk(problem, tracked.sweeps, kTruth_s, options, Job());
    answers.push_back(found ? std::optional(found->offset_s) : std::nullopt);
  }
  return answers;
}

std::string change_text(const Answers& changed, const Answers& usual) {
  double most_s = 0;
  for (std::size_t i = 0; i < usual.size(); ++i) {
    if (!changed[i] || !usual[i]) return "no answer";
    most_s = std::max(most_s, std::abs(*changed[i] - *usual[i]));
  }
  return fmt::format("{:.3f}", 1e3 * most_s);
}

template <typename Options>
struct Option {
  const char* name;
  std::function<void(Options&, double factor)> scale;
};

template <typename Options, typename Holder, typename T>
Option<Options> option(const char* name, T Holder::*value, Holder Options::*holder) {
  return {name, [=](Options& options, double factor) {
            T& scaled = options.*holder.*value;
            scaled =
                std::integral<T> ? T(std::max(1L, std::lround(factor * double(scaled)))) : T(factor * scaled);
          }};
}

template <typename Options, typename T>
Option<Options> option(const char* name, T Options::*value) {
  return {name, [=](Options& options, double factor) {
            T& scaled = options.*value;
            scaled =
                std::integral<T> ? T(std::max(1L, std::lround(factor * double(scaled)))) : T(factor * scaled);
          }};
}

template <typename Options, typename Solve>
void print_changes(const char* group, const std::vector<Option<Options>>& options, const Solve& solve) {
  const Answers usual = solve(Options());
  for (const Option<Options>& option : options) {
    std::vector<std::string> changes;
    for (const double factor : {0.5, 2.0}) {
      Options changed;
      option.scale(changed, factor);
      changes.push_back(change_text(solve(changed), usual));
    }
    fmt::print("{:<11}{:<28}{:>10}{:>10}\n", group, option.name, changes[0], changes[1]);
    std::fflush(stdout);
  }
}

void of_odometry() {
  using O = OdometryOptions;
  const auto patch = [](const char* name, auto value) { return option<O>(name, value, &O::patch); };
  print_changes<O>(
      "odometry",
      {option("search_radius_m", &O::search_radius_m), option("search_radius_slope", &O::search_radius_slope),
       option("loss_width_m", &O::loss_width_m), option("step_tolerance", &O::step_tolerance),
       option("min_eigenvalue", &O::min_eigenvalue),
       patch("plane_neighbours", &PatchOptions::plane_neighbours),
       patch("edge_neighbours", &PatchOptions::edge_neighbours), patch("per_line", &PatchOptions::per_line),
       patch("thickness_m", &PatchOptions::thickness_m),
       patch("thickness_slope", &PatchOptions::thickness_slope)},
      by_criteria);
}

// Those of plane points: the direct method of a stationary rig uses no others.
void of_features() {
  using O = FeatureOptions;
  print_changes<O>("features",
                   {option("half_window", &O::half_window), option("plane_curvature", &O::plane_curvature),
                    option("map_spacing", &O::map_spacing), option("axis_sine", &O::axis_sine)},
                   [](const O& features) { return stationary(features, {}); });
}

void of_stationary() {
  using O = StationaryDirectOptions;
  print_changes<O>("stationary",
                   {option("first_loss_width_m", &O::first_loss_width_m),
                    option("loss_widths", &O::loss_widths), option("min_loss_width_m", &O::min_loss_width_m)},
                   [](const O& options) { return stationary({}, options); });
}

void of_walk() {
  using O = JointWalkOptions;
  print_changes<O>(
      "walk",
      {option("part_s", &O::part_s), option("knot_s", &O::knot_s), option("jerk_factor", &O::jerk_factor),
       option("min_jerk", &O::min_jerk), option("match_sigma_m", &O::match_sigma_m),
       option("loss_width_m", &O::loss_width_m), option("offset_sigma_s", &O::offset_sigma_s),
       option("first_iterations", &O::first_iterations),
       option("averaged_iterations", &O::averaged_iterations)},
      along_walks);
}

int run(const std::string& group) {
  fmt::print("{:<11}{:<28}{:>10}{:>10}  [ms]\n", "group", "option", "halved", "doubled");
  if (group.empty() || group == "stationary") of_stationary();
  if (group.empty() || group == "features") of_features();
  if (group.empty() || group == "odometry") of_odometry();
  if (group.empty() || group == "walk") of_walk();
  return 0;
}

}  // namespace
}  // namespace sweepscope

int main(int argc, char** argv) {  // NOLINT(bugprone-exception-escape): it may end a benchmark
  return sweepscope::run(argc > 1 ? argv[1] : "");
}
