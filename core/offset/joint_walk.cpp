#include "core/offset/joint_walk.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include "core/loam/patch_search.hpp"
#include "core/loam/path_equations.hpp"
#include "core/offset/identifiability.hpp"
#include "core/offset/jerk_prior.hpp"
#include "core/offset/walk_equations.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// A ring of a 3D scanner takes a whole turn: its points share a motion only over a part of that, as long as a
// scan of a 2D scanner at 40 Hz takes.
constexpr double kLongestSlice_s = 0.025;

std::uint32_t slices_per_scan(const Recording& recording) {
  if (recording.directions.empty()) return 1;
  double longest_s = 0;
  for (const LaserScan& scan : recording.scans)
    longest_s = std::max(longest_s, scan.last_beam_s() - scan.first_beam_s);
  constexpr double kMax = 64;  // bounds the memory: scans that take more than 1.6 s have longer slices
  return static_cast<std::uint32_t>(std::clamp(std::ceil(longest_s / kLongestSlice_s), 1.0, kMax));
}

// One part of the walk on its way to its own offset.
class Part {
 public:
  Part(const OffsetProblem& problem, const std::vector<SweepPose>& sweeps, double offset_s,
       const JointWalkOptions& options)
      : problem_(cut(problem, sweeps, offset_s)),
        options_(options),
        slices_(slices_per_scan(*problem.recording)),
        path_(sweeps, options.knot_s, options.mapping.given.get()),
        jerk_sigma_(jerk_sigma(problem, path_.deviations(sweeps), options)) {
    result_.middle_s = (sweeps.front().begin_s + sweeps.back().end_s) / 2;
    result_.offset_s = offset_s;
    const auto& used = problem_.scan_used;
    const auto first = std::find(used.begin(), used.end(), 1);
    const auto last = std::find(used.rbegin(), used.rend(), 1);
    first_scan_ = static_cast<std::uint32_t>(first - used.begin());
    if (first != used.end()) scans_.resize(std::size_t(last.base() - first) * slices_);
  }

  /// `iterated` is called after each of at most `iterations()`.
  void solve(const Job& job, const std::function<void()>& iterated) {
    std::vector<double> offsets_s, shifts_s;
    std::optional<WalkEquations::Solution> solution;
    const auto rows = Eigen::Index(6 * path_.blocks() + 1);
    std::optional<JerkEvidence> evidence;
    if (path_.shift_block() && path_.knots() > 0) evidence.emplace(path_.knots(), rows);
    for (int i = 0; i < iterations(options_) && !job.cancelled(); ++i, iterated()) {
      WalkEquations equations(path_.blocks());
      linearise(equations);
      if (result_.matches < options_.min_matches) return;
      equations.add_jerks(path_, std::pow(options_.knot_s, 3) * jerk_sigma_);
      // rad and m. The first is a gauge, far below what is asked for; the second far above any step.
      constexpr double kFirstSigma = 1e-4, kKnotSigma = 0.5;
      equations.hold(path_.knots(), kFirstSigma, kKnotSigma, options_.offset_sigma_s);
      solution =
          equations.solve(path_.shift_block(), evidence ? evidence->probes() : Eigen::MatrixXd(rows, 0));
      if (!solution) return;
      path_.move(solution->block_steps);
      if (evidence && i < options_.first_iterations)
        jerk_sigma_ = evidence->sigma(path_, options_.knot_s, jerk_sigma_, solution->solved_probes)
                          .cwiseMax(options_.min_jerk)
                          .cwiseMin(jerk_sigma_);
      result_.offset_s += solution->offset_step_s;
      if (i < options_.first_iterations) continue;
      offsets_s.push_back(result_.offset_s);
      shifts_s.push_back(path_.time_shift_s());
    }
    if (!solution || job.cancelled()) return;
    conclude(offsets_s, clustered_sigma_s(solution->influence, solution->offset_sigma_s));
    if (const auto block = path_.shift_block()) {
      const Eigen::VectorXd& influence = solution->shift_influence;
      const double sigma_s = std::sqrt(influence[Eigen::Index(6 * *block)]);
      const double mean_s = std::accumulate(shifts_s.begin(), shifts_s.end(), 0.0) / double(shifts_s.size());
      result_.time_shift = TimeShift{mean_s, clustered_sigma_s(influence, sigma_s)};
    }
  }
  static int iterations(const JointWalkOptions& options) {
    return options.first_iterations + options.averaged_iterations;
  }
  const JointWalkPart& result() const { return result_; }
  const GuidedPath& path() const { return path_; }

 private:
  // The problem with these sweeps alone.
  static OffsetProblem cut(const OffsetProblem& problem, const std::vector<SweepPose>& sweeps,
                           double offset_s) {
    OffsetProblem part = problem;
    const auto sweep_of = assign_sweeps(problem.recording->scans, problem.motor.sweeps, offset_s);
    for (std::size_t i = 0; i < sweep_of.size(); ++i)
      if (sweep_of[i] == kNoSweep || sweep_of[i] < sweeps.front().sweep || sweep_of[i] > sweeps.back().sweep)
        part.scan_used[i] = 0;
    return part;
  }

  // The mean of the iterations, whose scatter adds to what the last one leaves open.
  void conclude(const std::vector<double>& offsets_s, double sigma_s) {
    const auto n = static_cast<double>(offsets_s.size());
    const auto middle = offsets_s.begin() + std::ptrdiff_t(offsets_s.size() / 2);
    const auto mean_s = [](auto from, auto to) { return std::accumulate(from, to, 0.0) / double(to - from); };
    result_.offset_s = mean_s(offsets_s.begin(), offsets_s.end());
    result_.step_s = mean_s(middle, offsets_s.end()) - mean_s(offsets_s.begin(), middle);
    double squares_s2 = 0;
    for (const double offset_s : offsets_s) squares_s2 += square(offset_s - result_.offset_s);
    result_.sigma_s = std::sqrt(square(sigma_s) + squares_s2 / (n - 1) / n);
    constexpr double kSettled = 1.5;  // sigmas: by judgement
    result_.converged = std::abs(result_.step_s) < kSettled * result_.sigma_s;
  }

  static double time_s(const PlacedSweep& sweep, const PlacedFeature& feature) {
    return sweep.begin_s + feature.u * (sweep.end_s - sweep.begin_s);
  }
  Vector3d in_map_m(const PlacedSweep& sweep, const PlacedFeature& feature) const {
    return path_.at(time_s(sweep, feature)) * feature.p_in_base_m;
  }

  void linearise(WalkEquations& equations) {
    ScanEquations scans(scans_.size());
    for_each_match([&](const ScanRow& row, double slope, double distance_m, double weight, const Vector3d&) {
      scans.add(row, slope, distance_m, weight);
    });
    equations.add(scans, scans_, path_);
  }

  // Of the offset or a time shift, where what the surfaces err by is not taken from the matches' standard
  // deviation, but from their residuals, summed up cell by cell: the matches of one surface err together, and
  // over and over where the same lines see it again and again (White 1980, with clusters). What the
  // smoothness leaves open stays.
  double clustered_sigma_s(const Eigen::VectorXd& influences, double sigma_s) {
    std::map<std::array<int, 3>, double> pulls_s;
    double formal_s2 = 0;
    constexpr double kCell_m = 1;  // about the size of a piece of furniture, or of a bay of a wall
    for_each_match(
        [&](const ScanRow& row, double slope, double distance_m, double weight, const Vector3d& p_m) {
          double influence = slope * influences[influences.size() - 1];
          for (std::size_t i = 0; i < row.size(); ++i)
            influence += row.row(i).dot(by_pose(influences, scans_[row.scan(i)], path_));
          std::array<int, 3> cell;
          for (int i = 0; i < 3; ++i) cell[std::size_t(i)] = int(std::floor(p_m[i] / kCell_m));
          pulls_s[cell] += weight * distance_m * influence;
          formal_s2 += weight * square(influence);
        });
    double clustered_s2 = 0;
    for (const auto& [cell, pull_s] : pulls_s) clustered_s2 += square(pull_s);
    if (!(formal_s2 > 0)) return sigma_s;
    const double total_s2 = square(sigma_s), of_matches_s2 = std::min(formal_s2, total_s2);
    return std::sqrt(total_s2 - of_matches_s2 + of_matches_s2 * clustered_s2 / formal_s2);
  }

  template <typename Use>
  void for_each_match(const Use& use) {
    const std::vector<PlacedSweep> sweeps = place_sweeps(problem_, result_.offset_s);
    FeatureMap edges, planes;
    last_line_ = kNoLine;
    for (const PlacedSweep& sweep : sweeps) {
      for (const PlacedFeature& feature : sweep.edges) insert(sweep, feature, edges);
      for (const PlacedFeature& feature : sweep.planes) insert(sweep, feature, planes);
    }
    result_.features = result_.matches = 0;
    result_.lever_m2 = result_.reach_m2 = 0;
    for (const PlacedSweep& sweep : sweeps) {
      const MappingOptions& mapping = options_.mapping;
      PatchSearch search{edges,
                         planes,
                         {mapping.patch, mapping.search_radius_m, mapping.search_radius_slope,
                          sweep.direction > 0 ? SweepFilter::kBackward : SweepFilter::kForward}};
      const auto place = [&](const PlacedFeature& feature) { return in_map_m(sweep, feature); };
      match_features(sweep, place, search,
                     [&](MatchedKind, const PlacedFeature& feature, const Vector3d& p_m,
                         const std::optional<MatchResidual>& residual) {
                       ++result_.features;
                       if (residual && residual->has_normal)
                         add(line_of(sweep, feature), p_m, *residual, search.near, use);
                     });
    }
  }

  void insert(const PlacedSweep& sweep, const PlacedFeature& feature, FeatureMap& map) {
    const std::uint32_t line = line_of(sweep, feature);
    map.insert(in_map_m(sweep, feature).cast<float>(), line, sweep.direction);
    if (line == last_line_) return;
    last_line_ = line;
    const LaserScan& scan = problem_.recording->scans[feature.line];
    const double slice = line % slices_, beams = (scan.beams - 1.0) / slices_;
    const double middle_s = scan.beam_s((slice + 0.5) * beams);
    const Pose pose = path_.at(middle_s);
    scans_[line] = {path_.place(middle_s), pose.translation_m,
                    turning_rad_s(problem_.motor.sweeps[sweep.sweep], middle_s + result_.offset_s) *
                        (pose.rotation * problem_.recording->rig.mount.axis.normalized())};
  }

  // How fast the motor turned: over a tenth of the sweep, so that the encoder's steps count little and what
  // tells a sine from a walk that sways, the speed's change within a sweep, stays.
  double turning_rad_s(const Sweep& sweep, double motor_s) const {
    const double span_s = (sweep.end_s - sweep.begin_s) / 20;
    const double from_s = std::max(motor_s - span_s, sweep.steady_begin_s);
    const double to_s = std::min(motor_s + span_s, sweep.steady_end_s);
    if (to_s - from_s < span_s / 2) return sweep.direction * sweep.speed_rad_s;
    const MotorTrack& track = problem_.recording->motor;
    return (track.angle_at(to_s) - track.angle_at(from_s)) / (to_s - from_s);
  }

  // The number of a feature's scan within the part, or of the slice of it.
  std::uint32_t line_of(const PlacedSweep& sweep, const PlacedFeature& feature) const {
    const std::uint32_t number = feature.line - first_scan_;
    if (slices_ == 1) return number;
    const LaserScan& scan = problem_.recording->scans[feature.line];
    const double u = (time_s(sweep, feature) - scan.first_beam_s) / (scan.last_beam_s() - scan.first_beam_s);
    const double slice = std::clamp(std::floor(u * slices_), 0.0, slices_ - 1.0);
    return number * slices_ + static_cast<std::uint32_t>(slice);
  }

  // One match: a point of one direction, its surface from points of the other.
  template <typename Use>
  void add(std::uint32_t line, const Vector3d& p_m, const MatchResidual& match, const Neighbours& near,
           const Use& use) {
    const Vector3d& normal = match.normal;
    row_.clear();
    double slope = row_.add_point(line, scans_[line], p_m, normal, 1);
    result_.lever_m2 += square(normal.dot(arm_m(line, p_m)));
    result_.reach_m2 += arm_m(line, p_m).squaredNorm();
    for (int i = 0; i < near.count; ++i) {
      const auto at = std::size_t(i);
      slope += row_.add_point(near.line[at], scans_[near.line[at]], near.p_m[at].cast<double>(), normal,
                              -1.0 / near.count);
    }
    const double weight =
        cauchy_weight(match.distance_m, options_.loss_width_m) / square(options_.match_sigma_m);
    use(row_, slope, match.distance_m, weight, p_m);
    ++result_.matches;
  }

  Vector3d arm_m(std::uint32_t line, const Vector3d& p_m) const {
    const ScanMotion& scan = scans_[line];
    return scan.turning_rad_s.normalized().cross(p_m - scan.base_in_map_m);
  }
  static double square(double x) { return x * x; }

  OffsetProblem problem_;
  const JointWalkOptions& options_;
  std::uint32_t slices_;          // of every scan
  std::uint32_t first_scan_ = 0;  // of the recording's, that the part uses
  GuidedPath path_;
  Eigen::Vector2d jerk_sigma_;  // rad/s^3 and m/s^3
  JointWalkPart result_;
  std::vector<ScanMotion> scans_;
  static constexpr std::uint32_t kNoLine = 0xffffffffu;
  std::uint32_t last_line_ = kNoLine;  // whose motion was worked out last
  ScanRow row_;
};

using Sweeps = std::vector<SweepPose>;

// A part shorter than this, 4 s of sweeps of 0.5 s, has little to say, and may say it wrongly.
constexpr std::size_t kMinSweeps = 8;

// The sweeps of one stretch cut into parts that are about equally long.
void cut(const Sweeps& run, double part_s, std::vector<Sweeps>& parts) {
  if (run.size() < kMinSweeps) return;
  const double duration_s = run.back().end_s - run.front().begin_s;
  const std::size_t count = std::clamp<std::size_t>(std::size_t(duration_s / part_s + 0.5), 1,
                                                    std::max<std::size_t>(1, run.size() / kMinSweeps));
  const std::size_t first = parts.size();
  parts.resize(first + count);
  for (std::size_t k = 0; k < run.size(); ++k) parts[first + k * count / run.size()].push_back(run[k]);
}

// No part holds sweeps that are lost, nor sweeps of two stretches, nor an end of a given motion.
std::vector<Sweeps> parts_of(const Sweeps& sweeps, double part_s, const GivenMotion* given) {
  std::vector<Sweeps> parts;
  for (const Sweeps& run : tracked_runs(sweeps, given)) cut(run, part_s, parts);
  return parts;
}

void summarise(JointWalk& walk) {
  double weights = 0, sum = 0, lever_m2 = 0, reach_m2 = 0;
  walk.converged = true;
  for (const JointWalkPart& part : walk.parts) {
    const double weight = 1 / (part.sigma_s * part.sigma_s);
    weights += weight;
    sum += weight * part.offset_s;
    if (!part.converged) walk.step_s += weight * std::abs(part.step_s);
    lever_m2 += part.lever_m2;
    reach_m2 += part.reach_m2;
    walk.features += part.features;
    walk.matches += part.matches;
    walk.converged = walk.converged && part.converged;
  }
  walk.offset_s = sum / weights;
  walk.step_s /= weights;
  walk.lever_m = std::sqrt(lever_m2 / double(walk.matches));
  walk.reach_m = std::sqrt(reach_m2 / double(walk.matches));
  walk.sigma_s = std::sqrt(1 / weights);
  // What the parts' own sigma leaves out (surfaces that are not flat, matches that are wrong) shows in how
  // they scatter. A few parts tell that badly: what was seen on the walks of tests/benchmark/walks counts as
  // kPriorParts more.
  constexpr double kPriorParts = 4, kPriorScatter2 = 1.1;
  double scatter2 = kPriorParts * kPriorScatter2;
  for (const JointWalkPart& part : walk.parts)
    scatter2 +=
        (part.offset_s - walk.offset_s) * (part.offset_s - walk.offset_s) / part.sigma_s / part.sigma_s;
  std::vector<TimeShift> time_shifts;
  for (const JointWalkPart& part : walk.parts)
    if (part.time_shift) time_shifts.push_back(*part.time_shift);
  if (!time_shifts.empty()) walk.time_shift = mean_of(time_shifts);
  walk.sigma_s *= std::sqrt(std::max(1.0, scatter2 / (double(walk.parts.size() - 1) + kPriorParts)));
}

// What a sway in step with a motor that turns back smoothly may have been taken for: this share of the sway
// that was found, as the walks with such motors among the first 55 of tests/benchmark/random_walks err.
double sway_sigma_s(const OffsetProblem& problem, const Sweeps& sweeps) {
  constexpr double kShare = 0.4;
  const Vector3d axis = problem.recording->rig.mount.axis.normalized();
  return kShare * alternating_sway_rad(sweeps, axis) / (2 * problem.motor.median_speed_rad_s);
}

}  // namespace

std::optional<JointWalk> solve_joint_walk(const OffsetProblem& problem, const std::vector<SweepPose>& tracked,
                                          double offset_s, const JointWalkOptions& options, const Job& job) {
  const std::vector<Sweeps> cuts = parts_of(tracked, options.part_s, options.mapping.given.get());
  std::vector<JointWalkPart> parts(cuts.size());
  std::vector<Sweeps> sweeps = cuts;
  std::atomic<std::size_t> done{0};
  const auto all = double(cuts.size()) * Part::iterations(options);
  const auto iterated = [&] { job.report("adjusting", std::min(1.0, double(++done) / all)); };
  for_each_index(cuts.size(), [&](std::size_t i) {
    Part part(problem, cuts[i], offset_s, options);
    part.solve(job, iterated);
    parts[i] = part.result();
    if (parts[i].matches >= options.min_matches)
      for (SweepPose& sweep : sweeps[i]) sweep = part.path().as_sweep(sweep);
  });
  if (job.cancelled()) return std::nullopt;
  JointWalk walk;
  const bool held = options.mapping.given && options.mapping.given->is_truth();
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    if (parts[i].matches >= options.min_matches && parts[i].sigma_s > 0) {
      if (!held)
        parts[i].sigma_s =
            std::hypot(parts[i].sigma_s, unseen_of_part_s(*problem.recording, problem.motor, cuts[i].size()));
      walk.parts.push_back(parts[i]);
    }
    walk.sweeps.insert(walk.sweeps.end(), sweeps[i].begin(), sweeps[i].end());
  }
  if (walk.parts.empty()) return std::nullopt;
  summarise(walk);
  if (!held)
    walk.unseen_sigma_s = unseen_of_part_s(*problem.recording, problem.motor, cuts.front().size()) /
                          std::sqrt(double(walk.parts.size()));
  if (!options.mapping.given && !has_rings(*problem.recording) && turns_back_smoothly(problem))
    walk.sway_sigma_s = sway_sigma_s(problem, walk.sweeps);
  walk.sigma_s = std::hypot(walk.sigma_s, walk.sway_sigma_s);
  return walk;
}

std::optional<Trend> drift_of(const JointWalk& walk) {
  constexpr double kUnseen_s = 0.2e-3;  // by which parts of hand-held walks scatter, whatever they say
  std::vector<double> middles_s, offsets_s, sigmas_s;
  for (const JointWalkPart& part : walk.parts) {
    middles_s.push_back(part.middle_s);
    offsets_s.push_back(part.offset_s);
    sigmas_s.push_back(std::hypot(part.sigma_s, kUnseen_s));
  }
  auto trend = trend_of(middles_s, offsets_s, sigmas_s);
  // Of a few parts that scatter by chance, some lie in a row. Between Student's factors for the 2 degrees of
  // freedom of 4 parts, 1.3 at one sigma and 2.2 at two.
  constexpr double kFewParts = 1.5;
  if (trend) trend->sigma *= kFewParts;
  return trend;
}

}  // namespace sweepscope
