#include "core/offset/walk/walk_part.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "core/loam/path/path_equations.hpp"

namespace sweepscope {

using Eigen::Vector3d;

namespace {

double square(double x) {
  return x * x;
}

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

// rad and m, of a knot that stays where it is, far below what is asked for; and of one that goes anywhere.
constexpr double kHeld = 1e-4, kAnyStep = 5;

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

double time_s(const PlacedSweep& sweep, const PlacedFeature& feature) {
  return sweep.begin_s + feature.u * (sweep.end_s - sweep.begin_s);
}

}  // namespace

WalkPart::WalkPart(const OffsetProblem& problem, const std::vector<SweepPose>& sweeps, double offset_s,
                   const JointWalkOptions& options)
    : problem_(problem),
      options_(options),
      tracked_at_s_(offset_s),
      first_sweep_(sweeps.front().sweep),
      last_sweep_(sweeps.back().sweep),
      slices_(slices_per_scan(*problem.recording)),
      path_(sweeps, options.knot_s, options.mapping.given.get()),
      jerk_sigma_(jerk_sigma(problem, path_.deviations(sweeps), options)),
      acceleration_sigma_(acceleration_sigma(path_.deviations(sweeps), options.mapping)) {
  result_.middle_s = (sweeps.front().begin_s + sweeps.back().end_s) / 2;
  result_.offset_s = offset_s;
  if (path_.shift_block() && path_.knots() > 0)
    evidence_.emplace(path_.knots(), Eigen::Index(6 * path_.blocks() + 1));
}

// The problem with the part's sweeps alone.
OffsetProblem WalkPart::cut() const {
  OffsetProblem part = problem_;
  const auto sweep_of = assign_sweeps(part.recording->scans, part.motor.sweeps, tracked_at_s_);
  for (std::size_t i = 0; i < sweep_of.size(); ++i)
    if (sweep_of[i] == kNoSweep || sweep_of[i] < first_sweep_ || sweep_of[i] > last_sweep_)
      part.scan_used[i] = 0;
  return part;
}

OffsetProblem WalkPart::begin() {
  OffsetProblem part = cut();
  const auto& used = part.scan_used;
  const auto first = std::find(used.begin(), used.end(), 1);
  const auto last = std::find(used.rbegin(), used.rend(), 1);
  first_scan_ = static_cast<std::uint32_t>(first - used.begin());
  if (first != used.end()) scans_.resize(std::size_t(last.base() - first) * slices_);
  return part;
}

MatchCount WalkPart::adjust(const HeldEnds& held, const Job& job, const std::function<void()>& iterated) {
  const OffsetProblem part = begin();
  const int iterations = options_.rough_iterations + options_.whole_iterations;
  MatchCount count;
  for (int i = 0; i < iterations && !job.cancelled(); ++i, iterated()) {
    count = match(part, {i < options_.rough_iterations ? options_.rough_stride : 1, true});
    auto equations = this->equations(kAnyStep);
    if (equations) equations->add_accelerations(std::pow(options_.knot_s, 2) * acceleration_sigma_);
    if (equations && held.begin) equations->hold_begin(kHeld);
    if (equations && held.end) equations->hold_end(kHeld);
    const auto solution = equations ? equations->solve_long() : std::nullopt;
    if (!solution) break;
    step(*solution);
  }
  forget_matches();
  return count;
}

void WalkPart::settle(const Job& job, const std::function<void()>& iterated) {
  const OffsetProblem part = begin();
  for (int i = 0; i < options_.first_iterations; ++i, iterated()) {
    if (job.cancelled() || !iterate(part, i + 1 == options_.first_iterations)) return;
    if (evidence_)
      jerk_sigma_ = evidence_->sigma(path_, options_.knot_s, jerk_sigma_, solution_->solved_probes)
                        .cwiseMax(options_.min_jerk)
                        .cwiseMin(jerk_sigma_);
  }
  result_.sigma_s = offset_sigma_s();
  if (const auto block = path_.shift_block())
    result_.time_shift = TimeShift{path_.time_shift_s(), shift_sigma_s(*block)};
  forget_matches();
}

void WalkPart::average(const Job& job, const std::function<void()>& iterated) {
  if (!solution_) return;
  const OffsetProblem part = cut();
  std::vector<double> offsets_s, shifts_s;
  for (int i = 0; i < options_.averaged_iterations; ++i, iterated()) {
    if (job.cancelled() || !iterate(part, i + 1 == options_.averaged_iterations)) return;
    offsets_s.push_back(result_.offset_s);
    shifts_s.push_back(path_.time_shift_s());
  }
  conclude(offsets_s, clustered_sigma_s(solution_->influence, offset_sigma_s()));
  if (const auto block = path_.shift_block())
    result_.time_shift =
        TimeShift{mean(shifts_s), clustered_sigma_s(solution_->shift_influence, shift_sigma_s(*block))};
  forget_matches();
  factor_.reset();
}

// A part lives as long as its walk is solved for; its matches take several MB.
void WalkPart::forget_matches() {
  matches_.reset();
  matched_m_ = {};
}

// Matches again and steps; false, and without a result, if that is not possible.
bool WalkPart::iterate(const OffsetProblem& part, bool is_last) {
  constexpr double kKnotSigma = 0.5;  // rad and m: far above any step
  result_.sigma_s = 0;
  solution_.reset();
  match(part, {});
  const auto equations = this->equations(kKnotSigma);
  if (!equations) return false;
  solution_ =
      equations->solve({is_last, path_.shift_block(), evidence_ ? &evidence_->probes() : nullptr}, factor_);
  if (!solution_) return false;
  step(*solution_);
  return true;
}

// Of the last matches; absent where they are too few.
std::optional<WalkEquations> WalkPart::equations(double knot_sigma) const {
  if (result_.matches < options_.min_matches) return std::nullopt;
  WalkEquations equations(*matches_, scans_, path_);
  equations.add_jerks(std::pow(options_.knot_s, 3) * jerk_sigma_);
  equations.hold(kHeld, knot_sigma, options_.offset_sigma_s);
  return equations;
}

void WalkPart::step(const WalkEquations::Solution& solution) {
  path_.move(solution.block_steps);
  result_.offset_s += solution.offset_step_s;
}

// The mean of the iterations, whose scatter adds to what the last one leaves open.
void WalkPart::conclude(const std::vector<double>& offsets_s, double sigma_s) {
  const auto n = static_cast<double>(offsets_s.size());
  const auto middle = offsets_s.begin() + std::ptrdiff_t(offsets_s.size() / 2);
  result_.offset_s = mean(offsets_s);
  result_.step_s = mean({middle, offsets_s.end()}) - mean({offsets_s.begin(), middle});
  double squares_s2 = 0;
  for (const double offset_s : offsets_s) squares_s2 += square(offset_s - result_.offset_s);
  result_.sigma_s = std::sqrt(square(sigma_s) + squares_s2 / (n - 1) / n);
  constexpr double kSettled = 1.5;  // sigmas: by judgement
  result_.converged = std::abs(result_.step_s) < kSettled * result_.sigma_s;
}

double WalkPart::offset_sigma_s() const {
  return std::sqrt(solution_->influence[solution_->influence.size() - 1]);
}

double WalkPart::shift_sigma_s(std::size_t block) const {
  return std::sqrt(solution_->shift_influence[Eigen::Index(6 * block)]);
}

Vector3d WalkPart::in_map_m(const PlacedSweep& sweep, const PlacedFeature& feature) const {
  return path_.at(time_s(sweep, feature)) * feature.p_in_base_m;
}

// Of the offset or a time shift, where what the surfaces err by is not taken from the matches' standard
// deviation, but from their residuals, summed up cell by cell: the matches of one surface err together, and
// over and over where the same lines see it again and again (White 1980, with clusters). What the
// smoothness leaves open stays.
double WalkPart::clustered_sigma_s(const Eigen::VectorXd& influences, double sigma_s) const {
  std::map<std::array<int, 3>, double> pulls_s;
  double formal_s2 = 0;
  constexpr double kCell_m = 1;  // about the size of a piece of furniture, or of a bay of a wall
  const std::vector<double> changes = matches_->changes(by_scans(influences, scans_, path_));
  for (std::size_t k = 0; k < changes.size(); ++k) {
    const ScanEquations::Match& match = matches_->matches()[k];
    std::array<int, 3> cell;
    for (int i = 0; i < 3; ++i) cell[std::size_t(i)] = int(std::floor(matched_m_[k][i] / kCell_m));
    pulls_s[cell] += match.weight * match.residual * changes[k];
    formal_s2 += match.weight * square(changes[k]);
  }
  double clustered_s2 = 0;
  for (const auto& [cell, pull_s] : pulls_s) clustered_s2 += square(pull_s);
  if (!(formal_s2 > 0)) return sigma_s;
  const double total_s2 = square(sigma_s), of_matches_s2 = std::min(formal_s2, total_s2);
  return std::sqrt(total_s2 - of_matches_s2 + of_matches_s2 * clustered_s2 / formal_s2);
}

// Features with the surfaces that the other direction measured, matched again.
MatchCount WalkPart::match(const OffsetProblem& part, const Matched& matched) {
  MatchCount count;
  matches_.emplace(scans_.size());
  matched_m_.clear();
  std::vector<PlacedSweep> sweeps = place_sweeps(part, result_.offset_s);
  FeatureMap edges, planes;
  last_line_ = kNoLine;
  for (const PlacedSweep& sweep : sweeps) {
    for (const PlacedFeature& feature : sweep.edges) insert(sweep, feature, edges);
    for (const PlacedFeature& feature : sweep.planes) insert(sweep, feature, planes);
  }
  result_.features = result_.matches = 0;
  result_.lever_m2 = result_.reach_m2 = 0;
  for (PlacedSweep& sweep : sweeps) {
    thin(sweep, matched.stride);
    const MappingOptions& mapping = options_.mapping;
    PatchSearch search{edges,
                       planes,
                       {mapping.patch, mapping.search_radius_m, mapping.search_radius_slope,
                        sweep.side > 0 ? SweepFilter::kBackward : SweepFilter::kForward}};
    const auto place = [&](const PlacedFeature& feature) { return in_map_m(sweep, feature); };
    match_features(sweep, place, search,
                   [&](MatchedKind kind, const PlacedFeature& feature, const Vector3d& p_m,
                       const std::optional<MatchResidual>& residual) {
                     ++result_.features;
                     count.add(residual, feature.range_m, gate_m(kind, mapping), mapping.cost_cap_m);
                     if (!residual || !residual->has_normal) return;
                     const std::uint32_t line = line_of(sweep, feature);
                     if (!matched.one_side || kind == MatchedKind::kEdge ||
                         seen_from_one_side(line, p_m, residual->normal, search.near))
                       add(line, p_m, *residual, search.near);
                   });
  }
  return count;
}

void WalkPart::insert(const PlacedSweep& sweep, const PlacedFeature& feature, FeatureMap& map) {
  const std::uint32_t line = line_of(sweep, feature);
  map.insert(in_map_m(sweep, feature).cast<float>(), line, sweep.side);
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

// How fast the motor turned: over a tenth of the sweep, so that the encoder's steps count little, and the
// change of the speed within a sweep, which distinguishes a sine from a walk that sways, remains.
double WalkPart::turning_rad_s(const Sweep& sweep, double motor_s) const {
  const double span_s = (sweep.end_s - sweep.begin_s) / 20;
  const double from_s = std::max(motor_s - span_s, sweep.steady_begin_s);
  const double to_s = std::min(motor_s + span_s, sweep.steady_end_s);
  if (to_s - from_s < span_s / 2) return sweep.direction * sweep.speed_rad_s;
  const MotorTrack& track = problem_.recording->motor;
  return (track.angle_at(to_s) - track.angle_at(from_s)) / (to_s - from_s);
}

// The number of a feature's scan within the part, or of the slice of it.
std::uint32_t WalkPart::line_of(const PlacedSweep& sweep, const PlacedFeature& feature) const {
  const std::uint32_t number = feature.line - first_scan_;
  if (slices_ == 1) return number;
  const LaserScan& scan = problem_.recording->scans[feature.line];
  const double u = (time_s(sweep, feature) - scan.first_beam_s) / (scan.last_beam_s() - scan.first_beam_s);
  const double slice = std::clamp(std::floor(u * slices_), 0.0, slices_ - 1.0);
  return number * slices_ + static_cast<std::uint32_t>(slice);
}

// Whether the points that a plane was fitted to were measured from the side that its own one was: the two
// sides of a wall or of a floor are two surfaces.
bool WalkPart::seen_from_one_side(std::uint32_t line, const Vector3d& p_m, const Vector3d& normal,
                                  const Neighbours& near) const {
  const double from_m = normal.dot(scans_[line].base_in_map_m - p_m);
  return std::all_of(near.line.begin(), near.line.begin() + near.count, [&](std::uint32_t other) {
    return normal.dot(scans_[other].base_in_map_m - p_m) * from_m >= 0;
  });
}

// One match: a point of one direction, its surface from points of the other.
void WalkPart::add(std::uint32_t line, const Vector3d& p_m, const MatchResidual& match,
                   const Neighbours& near) {
  const Vector3d& normal = match.normal;
  ScanRow row;
  double slope = row.add_point(line, scans_[line], p_m, normal, 1);
  result_.lever_m2 += square(normal.dot(arm_m(line, p_m)));
  result_.reach_m2 += arm_m(line, p_m).squaredNorm();
  for (int i = 0; i < near.count; ++i) {
    const auto at = std::size_t(i);
    slope += row.add_point(near.line[at], scans_[near.line[at]], near.p_m[at].cast<double>(), normal,
                           -1.0 / near.count);
  }
  const double weight =
      cauchy_weight(match.distance_m, options_.loss_width_m) / square(options_.match_sigma_m);
  matches_->add(row, slope, match.distance_m, weight);
  matched_m_.push_back(p_m);
  ++result_.matches;
}

Vector3d WalkPart::arm_m(std::uint32_t line, const Vector3d& p_m) const {
  const ScanMotion& scan = scans_[line];
  return scan.turning_rad_s.normalized().cross(p_m - scan.base_in_map_m);
}

}  // namespace sweepscope
