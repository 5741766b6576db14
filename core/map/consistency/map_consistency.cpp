#include "core/map/consistency/map_consistency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/map/consistency/drift.hpp"
#include "core/map/consistency/view_pair.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// Tuned on 70 of the walks that tests/benchmark/random_walks draws with seed 5, and on 15 in yard.ply.
constexpr double kView_s = 1.8;                                  // at least, of whole sweeps
constexpr std::size_t kPlanes = 160, kEdges = 80;                // of a view that are matched
constexpr double kAgain_s = 4, kNear_m = 10, kTurned_rad = 1.2;  // two views of one place
constexpr std::size_t kRevisits = 4;                             // that a view is compared with
constexpr double kMinApart_m = 0.3, kApartOfWay = 0.005;         // farther apart: a broken map
constexpr double kDriftOfWay = 0.01;                             // more than this may be missing
constexpr double kMaxMisfit = 0.45;                        // part of a sweep's features beside their surfaces
constexpr std::size_t kMinMatched = 25;                    // features of a sweep, to say so
constexpr double kMinMissing_m = 1, kMissingOfWay = 0.25;  // a trajectory that creeps

// As many as are asked for, evenly.
void take_evenly(const std::vector<SeenFeature>& all, std::size_t count, std::vector<SeenFeature>& taken) {
  const std::size_t stride = std::max<std::size_t>(1, all.size() / count);
  for (std::size_t i = 0; i < all.size(); i += stride) taken.push_back(all[i]);
}

class ComparedWalk {
 public:
  ComparedWalk(const OffsetProblem& problem, const std::vector<SweepPose>& poses, double offset_s)
      : problem_(problem), poses_(poses), offset_s_(offset_s) {
    find_views();
  }

  const std::vector<WalkView>& views() const { return views_; }

  struct Compared {
    std::size_t other = 0, view = 0;
    ViewPair pair;
  };
  // In the order of the views whose surfaces are matched to.
  std::vector<Compared> compare(const Job& job) {
    see();
    std::vector<std::vector<Compared>> compared(views_.size());
    for_each_block(views_.size(), 4, [&](const auto& block) {
      SweepPlacer placer(problem_, offset_s_);
      for (std::size_t i = block.begin(); i != block.end(); ++i) {
        if (job.cancelled()) return;
        SweepMaps maps;
        PlacedSweep sweep;
        for (std::size_t k = views_[i].first; k < views_[i].end; ++k) {
          placer.place(k, sweep);
          maps.insert(sweep, poses_[k]);
        }
        for (const std::size_t k : partners(i))
          compared[i].push_back({i, k, match_views(maps, views_[i].at.translation_m, views_[k], options_)});
      }
    });
    std::vector<Compared> all;
    for (const std::vector<Compared>& of_view : compared)
      all.insert(all.end(), of_view.begin(), of_view.end());
    return all;
  }

 private:
  void find_views() {
    const double sweep_s = problem_.motor.median_sweep_s;
    const auto of_view = std::size_t(2 * std::max(1.0, std::ceil(kView_s / (2 * sweep_s))));
    for (std::size_t first = 0, end = 0; first < poses_.size(); first = end) {
      end = first + 1;
      if (poses_[first].lost) continue;
      while (end < poses_.size() && !poses_[end].lost && poses_[end].stretch == poses_[first].stretch) ++end;
      // The last one takes what remains.
      for (std::size_t begin = first; begin + of_view <= end; begin += of_view) {
        const bool last = begin + 2 * of_view > end;
        WalkView& view = views_.emplace_back();
        view.first = begin;
        view.end = last ? end : begin + of_view;
      }
    }
    for (WalkView& view : views_) {
      const SweepPose &begin = poses_[view.first], &end = poses_[view.end - 1];
      view.begin_s = begin.begin_s;
      view.end_s = end.end_s;
      view.at = poses_[(view.first + view.end) / 2].begin();
      view.speed_mps =
          (end.end().translation_m - begin.begin().translation_m).norm() / (view.end_s - view.begin_s);
    }
  }
  void see() {
    for_each_block(views_.size(), 4, [&](const auto& block) {
      SweepPlacer placer(problem_, offset_s_);
      for (std::size_t i = block.begin(); i != block.end(); ++i) see(views_[i], placer);
    });
  }
  void see(WalkView& view, SweepPlacer& placer) const {
    std::vector<SeenFeature> planes, edges;
    PlacedSweep sweep;
    for (std::size_t k = view.first; k < view.end; ++k) {
      placer.place(k, sweep);
      const SweepMotion motion = poses_[k].motion();
      const auto keep = [&](const PlacedFeature& feature, MatchedKind kind, std::vector<SeenFeature>& kept) {
        if (feature.sharp)
          kept.push_back({motion(feature.p_in_base_m, feature.u), motion(Vector3d::Zero(), feature.u),
                          feature.range_m, kind, k - view.first});
      };
      for (const PlacedFeature& feature : sweep.planes) keep(feature, MatchedKind::kPlane, planes);
      for (const PlacedFeature& feature : sweep.edges) keep(feature, MatchedKind::kEdge, edges);
    }
    take_evenly(planes, kPlanes, view.seen);
    take_evenly(edges, kEdges, view.seen);
  }
  // The views that are compared with the surfaces of one: the next two, and later ones of the same place. The
  // first view is compared with the second one's.
  std::vector<std::size_t> partners(std::size_t i) const {
    const WalkView& own = views_[i];
    std::vector<std::pair<double, std::size_t>> again;
    std::vector<std::size_t> found;
    if (i == 1) found.push_back(0);
    for (std::size_t k = i + 1; k < views_.size(); ++k) {
      if (poses_[views_[k].first].stretch != poses_[own.first].stretch) continue;
      if (k <= i + 2) {
        found.push_back(k);
        continue;
      }
      const double away_m = (views_[k].at.translation_m - own.at.translation_m).norm();
      const double turned_rad = turn_between(own.at.rotation, views_[k].at.rotation).norm();
      if (views_[k].begin_s - own.end_s > kAgain_s && away_m < kNear_m && turned_rad < kTurned_rad)
        again.emplace_back(away_m / kNear_m + turned_rad / kTurned_rad, k);
    }
    std::ranges::sort(again);
    for (std::size_t n = 0; n < std::min(kRevisits, again.size()); ++n) found.push_back(again[n].second);
    return found;
  }

  const OffsetProblem& problem_;
  const std::vector<SweepPose>& poses_;
  double offset_s_;
  MappingOptions options_;
  std::vector<WalkView> views_;
};

}  // namespace

std::optional<SurfacesApart> MapConsistency::worst() const {
  return apart.empty() ? std::nullopt : std::optional(apart.front());
}

namespace {

using Pairs = std::vector<ComparedWalk::Compared>;

double way_m(const std::vector<SweepPose>& poses) {
  double sum_m = 0;
  for (std::size_t i = 1; i < poses.size(); ++i)
    sum_m += (poses[i].middle().translation_m - poses[i - 1].middle().translation_m).norm();
  return sum_m;
}

std::vector<SurfacesApart> surfaces_apart(const std::vector<WalkView>& views, const Pairs& pairs) {
  std::vector<SurfacesApart> apart;
  for (const auto& [other, view, pair] : pairs)
    if (view > other && pair.coincides())
      apart.push_back({views[other].middle_s(), views[view].middle_s(), pair.apart_m, pair.place_m});
  std::ranges::stable_sort(apart, std::greater(), &SurfacesApart::apart_m);
  return apart;
}

// Sweeps of which most features lie beside the surfaces of every view.
std::vector<DoubtfulTime> unfit_times(const std::vector<SweepPose>& poses, const std::vector<WalkView>& views,
                                      const Pairs& pairs) {
  std::vector<std::optional<double>> misfit(poses.size());
  for (const auto& [other, view, pair] : pairs)
    for (std::size_t k = 0; k < pair.placed_sweeps.size(); ++k) {
      const SurfaceFit& fit = pair.placed_sweeps[k];
      auto& least = misfit[views[view].first + k];
      if (fit.matched >= kMinMatched) least = std::min(least.value_or(1), fit.misfit());
    }
  std::vector<DoubtfulTime> times;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (misfit[i].value_or(0) <= kMaxMisfit) continue;
    if (i > 0 && misfit[i - 1].value_or(0) > kMaxMisfit)
      times.back().at_s.end_s = poses[i].end_s;
    else
      times.push_back({{poses[i].begin_s, poses[i].end_s}, poses[i].middle().translation_m});
  }
  return times;
}

// Of the views [first, last], what the views beside them say about their speed: nothing at an end of the
// recording, where a rig starts or stops, nor of two views alone, for as long as a rig stops in between.
UndeterminedTime undetermined_time(const std::vector<WalkView>& views, std::size_t first, std::size_t last) {
  UndeterminedTime time;
  time.at_s = {views[first].middle_s(), views[last].middle_s()};
  time.place_m = views[(first + last + 1) / 2].at.translation_m;
  double moved_m = 0, duration_s = 0;
  for (std::size_t i = first; i <= last; ++i) {
    const double view_s = views[i].end_s - views[i].begin_s;
    moved_m += views[i].speed_mps * view_s;
    duration_s += view_s;
  }
  time.speed_mps = time.speed_beside_mps = moved_m / duration_s;
  if (first > 0 && last + 1 < views.size() && last - first > 1)
    time.speed_beside_mps = (views[first - 1].speed_mps + views[last + 1].speed_mps) / 2;
  time.missing_m = (time.speed_beside_mps - time.speed_mps) * duration_s;
  return time;
}

std::vector<UndeterminedTime> undetermined_times(const std::vector<WalkView>& views, const Pairs& pairs) {
  std::vector<char> free(views.size(), 0);  // from the view before it
  for (const auto& [other, view, pair] : pairs)
    if (view == other + 1 && !pair.determined()) free[view] = 1;
  std::vector<UndeterminedTime> times;
  for (std::size_t i = 1; i < views.size(); ++i) {
    if (free[i] == 0) continue;
    const std::size_t first = i - 1;
    while (i + 1 < views.size() && free[i + 1] != 0) ++i;
    times.push_back(undetermined_time(views, first, i));
  }
  return times;
}

std::vector<DriftingTime> drifting_times(const std::vector<WalkView>& views, const Pairs& pairs) {
  std::vector<FacedMove> moves;
  for (const auto& [other, view, pair] : pairs) moves.push_back({other, view, pair.weakest});
  return drifting_times(views, moves);
}

std::string place_in_words(const Vector3d& p_m) {
  return fmt::format("({:.1f}, {:.1f}, {:.1f}) m", p_m.x(), p_m.y(), p_m.z());
}

// Of the pairs that are nearly as far apart as the worst, the one closest in time: it shows best when the
// trajectory went wrong.
SurfacesApart closest_in_time(const std::vector<SurfacesApart>& apart) {
  constexpr double kNearly = 0.8;
  SurfacesApart closest = apart.front();
  for (const SurfacesApart& one : apart)
    if (one.apart_m > kNearly * apart.front().apart_m &&
        one.again_s - one.first_s < closest.again_s - closest.first_s)
      closest = one;
  return closest;
}

// What may be wrong with a map: how far it is beyond its limit, of 1, and what is then said.
struct Finding {
  double doubt = 0;
  std::string warning;
};

Finding surfaces_that_lie_apart(const MapConsistency& found) {
  if (found.apart.empty()) return {};
  const SurfacesApart shown = closest_in_time(found.apart);
  return {
      found.apart.front().apart_m / found.limit_m,
      fmt::format("The map does not agree with itself: surfaces seen at {:.0f} s and again at {:.0f} s lie "
                  "{:.1f} m apart near {}. The trajectory is wrong between these times.",
                  shown.first_s, shown.again_s, shown.apart_m, place_in_words(shown.place_m))};
}

Finding sweeps_that_fit_nowhere(const std::vector<DoubtfulTime>& unfit) {
  if (unfit.empty()) return {};
  const auto length_s = [](const DoubtfulTime& time) { return time.at_s.end_s - time.at_s.begin_s; };
  const DoubtfulTime& longest = *std::ranges::max_element(unfit, {}, length_s);
  double all_s = 0;
  for (const DoubtfulTime& time : unfit) all_s += length_s(time);
  return {
      1 + all_s,
      fmt::format(
          "The map does not agree with itself: what was seen from {:.1f} to {:.1f} s near {} does not fit the "
          "surfaces that were seen before and after. The trajectory is wrong there.",
          longest.at_s.begin_s, longest.at_s.end_s, place_in_words(longest.place_m))};
}

Finding creeping(const std::vector<UndeterminedTime>& times) {
  if (times.empty()) return {};
  const UndeterminedTime& worst = *std::ranges::max_element(times, {}, &UndeterminedTime::missing_m);
  const double way_m = worst.missing_m + worst.speed_mps * (worst.at_s.end_s - worst.at_s.begin_s);
  return {
      worst.missing_m / std::max(kMinMissing_m, kMissingOfWay * way_m),
      fmt::format("From {:.0f} to {:.0f} s, near {}, the surfaces do not determine the motion, and the "
                  "trajectory slows from {:.1f} to {:.1f} m/s. If the rig did not, {:.0f} m are missing in "
                  "the map.",
                  worst.at_s.begin_s, worst.at_s.end_s, place_in_words(worst.place_m), worst.speed_beside_mps,
                  worst.speed_mps, worst.missing_m)};
}

// From times of the laser's clock to times since the recording's first scan.
void count_from(MapConsistency& found, double first_s) {
  for (SurfacesApart& apart : found.apart) apart.first_s -= first_s, apart.again_s -= first_s;
  const auto count = [&](DoubtfulTime& time) {
    time.at_s = {std::max(0.0, time.at_s.begin_s - first_s), time.at_s.end_s - first_s};
  };
  std::ranges::for_each(found.unfit, count);
  std::ranges::for_each(found.undetermined, count);
  std::ranges::for_each(found.drifting, count);
}

}  // namespace

std::optional<MapConsistency> map_consistency(const OffsetProblem& problem,
                                              const std::vector<SweepPose>& poses, double offset_s,
                                              const Job& job) {
  ComparedWalk walk(problem, poses, offset_s);
  const Pairs pairs = walk.compare(job);
  if (job.cancelled()) return std::nullopt;
  MapConsistency found;
  found.limit_m = std::max(kMinApart_m, kApartOfWay * way_m(poses));
  found.apart = surfaces_apart(walk.views(), pairs);
  found.unfit = unfit_times(poses, walk.views(), pairs);
  found.undetermined = undetermined_times(walk.views(), pairs);
  found.drifting = drifting_times(walk.views(), pairs);
  count_from(found, problem.recording->scans.front().first_beam_s);
  for (const Finding& finding :
       {surfaces_that_lie_apart(found), sweeps_that_fit_nowhere(found.unfit), creeping(found.undetermined)}) {
    found.doubt = std::max(found.doubt, finding.doubt);
    if (finding.doubt > 1) found.warnings.push_back(finding.warning);
  }
  found.drift_warning = drift_warning(found.drifting, std::max(kMinApart_m, kDriftOfWay * way_m(poses)));
  return found;
}

std::string in_words(const MapConsistency& consistency) {
  const auto worst = consistency.worst();
  if (!worst) return "no surface was seen twice: the consistency of the map is not determined";
  return fmt::format("surfaces seen twice lie at most {:.3f} m apart (at {:.0f} and {:.0f} s)",
                     worst->apart_m, worst->first_s, worst->again_s);
}

}  // namespace sweepscope
