#include "core/offset/criteria/criteria_search.hpp"

#include <algorithm>
#include <cmath>

#include "core/offset/criteria/criteria_answer.hpp"
#include "core/offset/criteria/moving_candidate.hpp"

namespace sweepscope {
namespace {

double rounded_to(double value, double step) {
  return std::round(value / step) * step;
}

// The pairs that can be registered at all, decided once: every candidate must answer for the same ones.
std::vector<std::size_t> registered_pairs(const OffsetSearch& search, const OdometryOptions& odometry,
                                          double offset_s) {
  std::vector<std::size_t> pairs;
  for (const PairMotion& motion : pair_motions(search.problem, offset_s, odometry))
    if (motion.succeeded) pairs.push_back(motion.sweep);
  return pairs;
}

// None where interrupted.
std::optional<SharedByCandidates> shared_by_candidates(const OffsetSearch& search, const Job& job) {
  const double offset_s = search.coarse.offset_or(search.window.middle_s());
  SharedByCandidates shared;
  shared.odometry = for_lines(search.options.odometry, search.problem.line_spacing_rad);
  if (!search.as_moving()) {
    shared.pairs = registered_pairs(search, shared.odometry, offset_s);
    return shared;
  }
  shared.walk = search.options.walk;
  if (shared.walk) return shared;
  auto walk = find_walk(search.problem, offset_s, mapping_of(search.options), WalkPurpose::kOffset, job);
  if (!walk) return std::nullopt;
  shared.walk = std::make_shared<const SolvedWalk>(std::move(*walk));
  return shared;
}

CurvePoint computed(const OffsetSearch& search, const SharedByCandidates& shared, double offset_s,
                    const Job& job) {
  const EstimateOptions& options = search.options;
  if (!search.as_moving())
    return stationary_candidate(search.problem, offset_s, shared.pairs, options.weight_c.value_or(1),
                                shared.odometry);
  if (options.scoring == Scoring::kLoam)
    return loam_candidate(search.problem, offset_s, mapping_of(options), job);
  return moving_candidate(search.problem, offset_s, shared.walk->sweeps, mapping_of(options), job);
}

// From the store where it is there.
CurvePoint kept_or_computed(const OffsetSearch& search, const SharedByCandidates& shared,
                            CandidateStore& store, double offset_s, const Job& job) {
  if (const auto kept = store.find(offset_s)) return *kept;
  CurvePoint none;
  none.offset_s = offset_s;
  if (store.failed()) return none;
  const CurvePoint point = computed(search, shared, offset_s, job);
  if (!job.cancelled()) store.keep(point);
  return point;
}

// Steps of a unit about the valley of the coarse search, then tenths of a unit about its ground. False where
// interrupted.
bool coarse_to_fine(const OffsetSearch& search, Curve& curve, const Job& job) {
  const SearchScale& scale = search.scale;
  double centre_s = search.coarse.offset_or(search.window.middle_s());
  constexpr int kMaxMoves = 5;  // by up to 5 units each; they bound the cost
  for (int move = 0; move < kMaxMoves; ++move) {
    centre_s = rounded_to(centre_s, scale.unit_s);
    const double from_s = std::max(centre_s - 5 * scale.unit_s, -scale.max_half_width_s);
    if (!curve.compute(offsets_of({{from_s, from_s + 10 * scale.unit_s, scale.unit_s}}), job)) return false;
    const std::size_t best = index_of_min(curve.points(), decisive(search));
    if (best == curve.points().size()) return true;
    centre_s = curve.points()[best].offset_s;
    if (best > 1 && best + 2 < curve.points().size()) break;
  }
  const double step_s = scale.unit_s / 10;
  return curve.compute(offsets_of({{centre_s - 20 * step_s, centre_s + 20 * step_s, step_s}}), job);
}

}  // namespace

Result<Answer> answer_by_criteria(const OffsetSearch& search, const KeptCandidates& kept, const Job& job) {
  Answer answer;
  const auto shared = shared_by_candidates(search, job);
  if (!shared) return answer;
  if (shared->walk) {
    answer.walk = shared->walk;
    answer.lost = lost_times(shared->walk->sweeps, *search.problem.recording);
    if (const auto lost = lost_warning(answer.lost)) answer.warnings.push_back(*lost);
  }
  Curve curve([&](double offset_s, const Job& part) {
    const CurvePoint point = kept.store == nullptr
                                 ? computed(search, *shared, offset_s, part)
                                 : kept_or_computed(search, *shared, *kept.store, offset_s, part);
    if (kept.watch.finished && !part.cancelled()) kept.watch.finished(point);
    return point;
  });
  const bool finished =
      search.window.by_default
          ? coarse_to_fine(search, curve, job)
          : curve.compute(kept.shard ? kept.shard->part_of(search.window.offsets_s) : search.window.offsets_s,
                          job);
  answer.curve = curve.points();
  if (kept.store != nullptr)
    if (const auto failed = kept.store->failed()) return tl::unexpected(*failed);
  if (!finished || kept.shard) return answer;
  return judged_by_criteria(search, *shared, std::move(answer), job);
}

}  // namespace sweepscope
