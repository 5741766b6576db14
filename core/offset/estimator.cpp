#include "core/offset/estimator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "core/numbers.hpp"
#include "core/offset/direct.hpp"
#include "core/offset/direct_moving.hpp"
#include "core/offset/direct_stationary.hpp"
#include "core/offset/identifiability.hpp"
#include "core/offset/kept_candidates.hpp"
#include "core/offset/motion_source.hpp"
#include "core/offset/moving.hpp"
#include "core/offset/rig_motion.hpp"
#include "core/offset/search_window.hpp"
#include "core/offset/stationary.hpp"
#include "core/offset/still_motion.hpp"
#include "core/offset/uncertainty.hpp"
#include "core/offset/walk.hpp"

namespace sweepscope {
namespace {

double cpu_now_s() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

const char* name_of(Method method) {
  switch (method) {
    case Method::kStationary:
      return "stationary";
    case Method::kMoving:
      return "moving";
    case Method::kDirect:
      return "direct";
  }
  return "";
}

double rounded_to(double value, double step) {
  return std::round(value / step) * step;
}

// Why a rig is taken to have moved.
std::string moved_text(const MotionTest& test) {
  if (4 * test.moved <= test.pairs && test.moved_slowly())
    return "The rig moved: its last sweeps do not fall on its first ones.";
  return fmt::format(
      "The rig moved: {} of {} pairs of sweeps of the same direction do not fall on each other.", test.moved,
      test.pairs);
}

// One estimate on its way: what it works on and what it has found so far.
class Search {
 public:
  Search(const Recording& recording, const EstimateOptions& options, CandidateStore* store,
         std::optional<Shard> shard, const Job& job)
      : options_(options), store_(store), shard_(shard), job_(job) {
    result_.recording = recording.name;
    result_.warnings = recording.report.warnings;
    problem_.recording = &recording;
    problem_.motor = find_sweeps(recording.motor);
  }

  /// Whatever was cut short, wherever: no answer is given once the job is cancelled.
  Result<Estimate> run() {
    Result<Estimate> found = search();
    if (found && !found->interrupted && job_.cancelled()) {
      result_ = std::move(*found);
      return interrupted();
    }
    return found;
  }

 private:
  Result<Estimate> search() {
    result_.method = name_of(options_.method.value_or(Method::kStationary));
    result_.reasons = motor_reasons(problem_.recording->motor, problem_.motor);
    if (!result_.reasons.empty()) return std::move(result_);
    scale_ = search_scale(problem_.motor);
    judge_streams();
    if (!result_.reasons.empty()) return std::move(result_);
    std::vector<OffsetRange> ranges = options_.ranges;
    if (options_.around) ranges.push_back(range_around(*options_.around));
    const bool by_default = ranges.empty();
    if (const auto refused = refuse_shard(by_default)) return tl::unexpected(*refused);
    if (options_.poses && options_.method != Method::kDirect)
      return failure(ExitCode::kWrongUsage, "Poses are used by the direct method alone.");
    if (by_default) ranges.push_back({-scale_.half_width_s, scale_.half_width_s, scale_.unit_s});
    const auto offsets_s = checked_offsets(ranges, scale_);
    if (!offsets_s) return tl::unexpected(offsets_s.error());
    if (!prepare(offsets_s->front(), offsets_s->back())) return interrupted();
    if (!result_.reasons.empty()) return std::move(result_);
    if (options_.poses && options_.poses->poses.size() < 2)
      return failure(ExitCode::kUnreadableInput,
                     fmt::format("{}: a trajectory needs at least two poses", options_.poses->file));
    if (options_.poses && !moving())
      return failure(ExitCode::kWrongUsage,
                     fmt::format("{}: the rig stood still, where poses are of no use: leave out {}. {}",
                                 result_.recording, options_.poses->file, result_.kind_reason));
    if (options_.method == Method::kDirect) return directly();

    Curve curve([this](double offset_s, const Job& job) { return candidate(offset_s, job); });
    const bool finished = by_default ? coarse_to_fine(curve, *offsets_s) : compute(curve, *offsets_s);
    result_.curve = curve.points();
    if (const auto failed = store_failure()) return tl::unexpected(*failed);
    if (!finished) return interrupted();
    if (shard_) return std::move(result_);
    conclude();
    return std::move(result_);
  }

  // As what the sweeps are treated.
  bool moving() const { return (method_ == Method::kDirect ? kind_ : method_) == Method::kMoving; }
  CurveValue decisive() const { return moving() ? &CurvePoint::e_m : &CurvePoint::d; }

  Result<Estimate> directly() {
    const auto source = motion_source(*problem_.recording, options_.poses);
    const auto done =
        estimate_directly(problem_, coarse_, moving(), motion_, options_.mapping, source, job_, result_);
    if (!done && done.error().code != ExitCode::kInterrupted) return tl::unexpected(done.error());
    return std::move(result_);
  }

  Estimate interrupted() {
    result_.interrupted = true;
    result_.identifiable = false;
    result_.offset_s.reset();
    result_.sigma_s.reset();
    result_.drift_ppm.reset();
    result_.criteria.clear();
    result_.reasons = {"Interrupted; the curve holds the candidates that were finished."};
    return std::move(result_);
  }

  // What the stamps and the motor's samples are good for, whatever the scans show.
  void judge_streams() {
    const MotorTrack& track = problem_.recording->motor;
    if (const auto stamps = stamps_reason(*problem_.recording, scale_)) result_.reasons.push_back(*stamps);
    if (const auto sparse = sampling_reason(track, problem_.motor, scale_))
      result_.reasons.push_back(*sparse);
    if (!result_.reasons.empty()) return;
    if (const auto few = sampling_warning(track, problem_.motor)) result_.warnings.push_back(*few);
  }

  // Features, the scans to use, and the kind of recording. False where interrupted.
  bool prepare(double least_s, double greatest_s) {
    auto problem = prepare_problem(*problem_.recording, least_s, greatest_s, options_.features, job_);
    if (!problem) return false;
    problem_ = std::move(*problem);
    odometry_ = for_lines(options_.odometry, problem_.line_spacing_rad);
    SweepPlacer placer(problem_, (least_s + greatest_s) / 2);
    std::size_t scans = 0;
    for (PlacedSweep sweep; placer.next(sweep); ++result_.sweeps) scans += sweep.scans;
    if (const auto gaps = gaps_reason(*problem_.recording, problem_.scan_used, least_s, greatest_s)) {
      result_.reasons.push_back(*gaps);
      return true;
    }
    result_.scans = scans;
    if (result_.sweeps < 2) {
      result_.reasons.push_back(
          "Fewer than two sweeps have both scans and motor samples at every offset searched.");
      return true;
    }
    if (const auto few =
            lines_reason(distinct_lines(*problem_.recording, problem_.motor, (least_s + greatest_s) / 2))) {
      result_.reasons.push_back(*few);
      return true;
    }
    coarse_ = search_coarsely(problem_, {least_s, greatest_s}, scale_, job_);
    if (job_.cancelled()) return false;
    motion_ = test_motion(still_grid(problem_), coarse_offset_s(least_s, greatest_s));
    judge_kind(motion_);
    return true;
  }

  double coarse_offset_s(double least_s, double greatest_s) const {
    return coarse_.best ? coarse_.offset_s() : (least_s + greatest_s) / 2;
  }

  void judge_kind(const MotionTest& test) {
    kind_ = Method::kStationary;
    if (options_.assume) {
      kind_ = *options_.assume;
      result_.kind_reason = "As assumed.";
      if (kind_ == Method::kStationary && test.moving())
        result_.warnings.push_back(moved_text(test) + " It is treated as stationary, as assumed.");
    } else if (test.answered()) {
      kind_ = test.moving() ? Method::kMoving : Method::kStationary;
      result_.kind_reason = fmt::format(
          "{} of {} pairs of sweeps of the same direction lie apart; at the median by {:.3f} m and {:.2f} "
          "deg.",
          test.moved, test.pairs, test.median_translation_m, test.median_rotation_rad * kDegPerRad);
    } else {
      result_.kind_reason = "Too short to tell whether the rig stood still: it is taken to have stood still.";
      if (options_.method != Method::kMoving) result_.warnings.push_back(result_.kind_reason);
    }
    result_.kind = name_of(kind_);
    method_ = options_.method.value_or(kind_);
    result_.method = name_of(method_);
    if (method_ == Method::kStationary && kind_ == Method::kMoving)
      result_.reasons.push_back(moved_text(test) +
                                " Use --method moving, or --assume stationary if it was stationary.");
    const std::size_t least_sweeps = std::size_t(options_.mapping.settling_sweeps) + 12;
    if (moving() && result_.sweeps < least_sweeps)
      result_.reasons.push_back(fmt::format(
          "{}The recording is too short for a moving rig: {} sweeps, at least {} are "
          "needed, and 40 s of walking for a good answer.",
          test.moving() && !options_.assume ? moved_text(test) + " " : "", result_.sweeps, least_sweeps));
  }

  std::optional<Error> refuse_shard(bool by_default) const {
    if (options_.method == Method::kDirect && (shard_ || store_ != nullptr))
      return Error{ExitCode::kWrongUsage, "The direct method takes seconds: it keeps no candidates."};
    if (shard_ && by_default)
      return Error{
          ExitCode::kWrongUsage,
          "A part of a search wants its candidates said: the default search decides where to look as "
          "it goes."};
    return std::nullopt;
  }

  std::optional<Error> store_failure() const { return store_ != nullptr ? store_->failed() : std::nullopt; }

  // From the store where it is there.
  CurvePoint candidate(double offset_s, const Job& job) const {
    if (store_ == nullptr) return computed(offset_s, job);
    if (const auto kept = store_->find(offset_s)) return *kept;
    CurvePoint none;
    none.offset_s = offset_s;
    if (store_->failed()) return none;
    const CurvePoint point = computed(offset_s, job);
    if (!job.cancelled()) store_->keep(point);
    return point;
  }

  CurvePoint computed(double offset_s, const Job& job) const {
    if (!moving()) return stationary_candidate(problem_, offset_s, pairs_, options_.weight_c, odometry_);
    if (options_.scoring == Scoring::kLoam) return loam_candidate(problem_, offset_s, options_.mapping, job);
    return moving_candidate(problem_, offset_s, walk_.sweeps, options_.mapping);
  }

  // The pairs that can be registered at all, decided once: every candidate must answer for the same ones.
  void choose_pairs(double offset_s) {
    pairs_.clear();
    for (const PairMotion& motion : pair_motions(problem_, offset_s, odometry_))
      if (motion.succeeded) pairs_.push_back(motion.sweep);
  }

  // What all candidates share. False where interrupted.
  bool prepare_candidates(double offset_s) {
    if (!moving()) {
      choose_pairs(offset_s);
      return true;
    }
    auto walk = find_walk(problem_, offset_s, options_.mapping, job_);
    if (!walk) return false;
    walk_ = std::move(*walk);
    result_.lost = lost_times(walk_.sweeps, *problem_.recording);
    if (const auto lost = lost_warning(result_.lost)) result_.warnings.push_back(*lost);
    return true;
  }

  bool compute(Curve& curve, const std::vector<double>& offsets_s) {
    if (!prepare_candidates(coarse_offset_s(offsets_s.front(), offsets_s.back()))) return false;
    return curve.compute(shard_ ? shard_->part_of(offsets_s) : offsets_s, job_);
  }

  // Coarse over the whole window, then steps of a unit about the valley, then tenths of a unit about its
  // ground.
  bool coarse_to_fine(Curve& curve, const std::vector<double>& window_s) {
    double centre_s = coarse_offset_s(window_s.front(), window_s.back());
    if (!prepare_candidates(centre_s)) return false;
    constexpr int kMostMoves = 5;
    for (int move = 0; move < kMostMoves; ++move) {
      centre_s = rounded_to(centre_s, scale_.unit_s);
      const double from_s = std::max(centre_s - 5 * scale_.unit_s, -scale_.most_half_width_s);
      if (!curve.compute(offsets_of({{from_s, from_s + 10 * scale_.unit_s, scale_.unit_s}}), job_))
        return false;
      const std::size_t best = index_of_least(curve.points(), decisive());
      if (best == curve.points().size()) return true;
      centre_s = curve.points()[best].offset_s;
      if (best > 1 && best + 2 < curve.points().size()) break;
    }
    const double step_s = scale_.unit_s / 10;
    return curve.compute(offsets_of({{centre_s - 20 * step_s, centre_s + 20 * step_s, step_s}}), job_);
  }

  void conclude() {
    const std::size_t best = index_of_least(result_.curve, decisive());
    if (best == result_.curve.size()) {
      result_.reasons.push_back(
          moving() ? lost_reason(walk_, *problem_.recording)
                   : "The sweeps could not be registered to each other at any candidate offset.");
      return;
    }
    // A slow motor leaves d so flat that the least of many candidates is chance.
    const bool slow = scale_.unit_s > 1e-3;
    const bool fits = options_.fit.value_or(moving() || slow ? Fit::kParabola : Fit::kNone) == Fit::kParabola;
    const double reach_s = fits ? 3 * scale_.unit_s : 0.0;
    const CriterionOptimum least = named(moving() ? "e" : "d", decisive(), best, reach_s);
    if (moving()) {
      const std::size_t most = index_of_greatest(result_.curve, &CurvePoint::n);
      const CriterionOptimum greatest = named("n", &CurvePoint::n, most, reach_s);
      compare_criteria(greatest.offset_s, least.offset_s);
      const std::size_t cheapest = index_of_least(result_.curve, &CurvePoint::capped_cost_m);
      if (cheapest < result_.curve.size())
        named("capped_cost", &CurvePoint::capped_cost_m, cheapest, reach_s);
    }
    if (result_.curve.size() > 2 && (best == 0 || best + 1 == result_.curve.size()))
      result_.reasons.push_back(
          fmt::format("The least {} lies on the edge of the searched range, at {:.1f} ms: the offset "
                      "lies beyond it, or nowhere.",
                      moving() ? "e" : "d", least.offset_s * 1e3));
    if (moving() && walk_.joint) {
      if (const auto flat = lever_reason(walk_.joint->lever_m, walk_.joint->reach_m))
        result_.reasons.push_back(*flat);
    }
    if (!moving()) judge_lever();
    if (!moving()) judge_standing(best);
    if (!result_.reasons.empty()) return;
    const Certainty certainty = moving() ? of_walk(least.offset_s) : of_standing(least.offset_s, fits);
    judge_drift(certainty);
    result_.identifiable = result_.reasons.empty();
    if (!result_.identifiable) return;
    result_.offset_s = least.offset_s;
    if (certainty.sigma_s)
      result_.sigma_s =
          std::hypot(*certainty.sigma_s, unseen_sigma_s(*problem_.recording, problem_.motor, least.offset_s));
    if (moving() && recorded_s() < 20)
      result_.warnings.push_back(
          "Less than 20 s of walking: the answer may be off by several tenths of a millisecond.");
  }

  CriterionOptimum named(const char* name, CurveValue value, std::size_t best, double reach_s) {
    CriterionOptimum optimum = fitted_extremum(result_.curve, value, best, reach_s);
    optimum.name = name;
    result_.criteria.push_back(optimum);
    return optimum;
  }

  void compare_criteria(double n_offset_s, double e_offset_s) {
    const double apart_s = std::abs(n_offset_s - e_offset_s);
    const std::string text =
        fmt::format("The two criteria disagree: n is greatest at {:.2f} ms, e is least at {:.2f} ms.",
                    n_offset_s * 1e3, e_offset_s * 1e3);
    // n's curve is flat: only tracking on LOAM's own poses may leave it undecided.
    if (apart_s > 3 * scale_.unit_s)
      result_.reasons.push_back(text);
    else if (apart_s > scale_.unit_s)
      result_.warnings.push_back(text);
  }

  // A wrong offset must turn the sweeps against each other by twice the motor's speed times the error. Where
  // it does not, nothing in the scene tells the motor's angle.
  void judge_lever() {
    double sx = 0, sy = 0, sxx = 0, sxy = 0, n = 0;
    for (const CurvePoint& point : result_.curve) {
      if (!point.signed_rotation_rad) continue;
      const double x = point.offset_s - result_.curve.front().offset_s, y = *point.signed_rotation_rad;
      sx += x, sy += y, sxx += x * x, sxy += x * y, n += 1;
    }
    const double spread = sxx - sx * sx / std::max(1.0, n);
    if (n < 3 || !(spread > 0)) return;
    const double slope = (sxy - sx * sy / n) / spread / (2 * problem_.motor.median_speed_rad_s);
    if (slope < 0.3)
      result_.reasons.push_back(
          fmt::format("The scene gives no lever: turning the motor's angle by 1 deg turns the "
                      "registered sweeps by {:.2f} deg only.",
                      slope));
  }

  void judge_standing(std::size_t best) {
    constexpr double kMostTranslation_m = 0.15;
    if (*result_.curve[best].translation_m > kMostTranslation_m)
      result_.reasons.push_back(
          fmt::format("The rig moved: at the best offset the sweeps still lie {:.2f} m apart.",
                      *result_.curve[best].translation_m));
  }

  double recorded_s() const {
    const auto& scans = problem_.recording->scans;
    return scans.back().first_beam_s - scans.front().first_beam_s;
  }

  // What the direct least squares, at the answer, says of it.
  struct Certainty {
    std::optional<double> sigma_s;
    std::optional<Trend> drift;  // of the offset over the recording
    double drift_sigma_s = 0;    // of the offset that it is a drift of
  };

  void judge_drift(const Certainty& certainty) {
    if (!certainty.drift) return;
    result_.drift_ppm = certainty.drift->slope * 1e6;
    if (const auto drifts = drift_reason(*certainty.drift, recorded_s(), certainty.drift_sigma_s))
      result_.reasons.push_back(*drifts);
  }

  // How far the answer lies from that of the direct least squares, and how far that one may be off. The
  // scatter of the pairs alone knows nothing of what pulls them all alike, such as lines of both directions
  // that see the same angles.
  Certainty of_standing(double offset_s, bool fits) const {
    const std::optional<double> of_pairs_s = sigma_of_pairs(offset_s, fits);
    const StationaryDirect direct = solve_stationary(still_grid(problem_), offset_s, {}, job_);
    const auto of_direct_s = sigma_of(direct, *problem_.recording);
    if (!of_pairs_s || !of_direct_s || direct.matches < StationaryDirectOptions().least_matches)
      return {of_pairs_s, {}, 0};
    return {std::max(*of_pairs_s, std::hypot(direct.offset_s - offset_s, *of_direct_s)),
            trend_of(direct.block_s, direct.block_offset_s), *of_direct_s};
  }

  // What each pair of sweeps says by itself scatters. Neighbouring pairs share a sweep, so the mean's
  // variance is twice that of as many independent ones; the least of a grid of candidates adds its step's.
  std::optional<double> sigma_of_pairs(double offset_s, bool fits) const {
    std::vector<double> errors_s;
    for (const PairMotion& motion : pair_motions(problem_, offset_s, odometry_))
      if (std::find(pairs_.begin(), pairs_.end(), motion.sweep) != pairs_.end())
        errors_s.push_back(motion.signed_rotation_rad / (2 * problem_.motor.median_speed_rad_s));
    const double n = static_cast<double>(errors_s.size());
    if (n < 3) return std::nullopt;
    double mean_s = 0, squares_s2 = 0;
    for (const double error_s : errors_s) mean_s += error_s / n;
    for (const double error_s : errors_s) squares_s2 += (error_s - mean_s) * (error_s - mean_s);
    const double step_s = fits ? 0 : step_about(offset_s);
    return std::hypot(student_factor(n / 2) * std::sqrt(2 * squares_s2 / (n - 1) / n),
                      step_s / std::sqrt(12.0));
  }

  // The spacing of the candidates about an offset.
  double step_about(double offset_s) const {
    double least_s = scale_.unit_s;
    for (const CurvePoint& point : result_.curve)
      if (point.offset_s != offset_s) least_s = std::min(least_s, std::abs(point.offset_s - offset_s));
    return least_s;
  }

  // How far the answer lies from that of the joint least squares, and how far that one may be off.
  Certainty of_walk(double offset_s) const {
    const auto& joint = walk_.joint;
    if (!joint) return {};
    return {std::hypot(joint->offset_s - offset_s, joint->sigma_s), drift_of(*joint), joint->sigma_s};
  }

  const EstimateOptions& options_;
  CandidateStore* store_;  // none: every candidate is computed
  std::optional<Shard> shard_;
  const Job& job_;
  OffsetProblem problem_;
  OdometryOptions odometry_;
  SearchScale scale_;
  CoarseSearch coarse_;
  MotionTest motion_;
  Method kind_ = Method::kStationary, method_ = Method::kStationary;
  std::vector<std::size_t> pairs_;
  SolvedWalk walk_;
  Estimate result_;
};

Result<Estimate> timed_estimate(const Recording& recording, const EstimateOptions& options,
                                CandidateStore* store, std::optional<Shard> shard, const Job& job) {
  const double cpu_begin_s = cpu_now_s();
  const auto wall_begin = std::chrono::steady_clock::now();
  Result<Estimate> result = Search(recording, options, store, shard, job).run();
  if (!result) return result;
  result->cpu_s = cpu_now_s() - cpu_begin_s;
  result->wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_begin).count();
  return result;
}

}  // namespace

Result<Estimate> estimate(const Recording& recording, const EstimateOptions& options, const Job& job) {
  return timed_estimate(recording, options, nullptr, std::nullopt, job);
}

Result<Estimate> estimate(const Recording& recording, const EstimateOptions& options, CandidateStore& store,
                          std::optional<Shard> shard, const Job& job) {
  return timed_estimate(recording, options, &store, shard, job);
}

}  // namespace sweepscope
