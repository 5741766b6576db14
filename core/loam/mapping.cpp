#include "core/loam/mapping.hpp"

#include <algorithm>
#include <functional>
#include <optional>

#include "core/loam/given_motion.hpp"
#include "core/loam/relocalisation.hpp"
#include "core/loam/tracker.hpp"

namespace sweepscope {
namespace {

struct SweepSource {
  std::size_t count = 0;
  std::function<PlacedSweep(std::size_t)> place;
};

// Sweeps [first, end) of the recording.
struct Range {
  std::size_t first, end;
  std::size_t size() const { return end - first; }
};

SweepPose pose_of(const PlacedSweep& sweep) {
  SweepPose pose;
  pose.sweep = sweep.sweep;
  pose.direction = sweep.direction;
  pose.begin_s = sweep.begin_s;
  pose.end_s = sweep.end_s;
  return pose;
}

// How far a sweep's features lie from where the last sweep saw them, were the rig at rest or moved as given.
double cost_at_rest_m(const PlacedSweep& from, const PlacedSweep& to, const MappingOptions& options) {
  SweepMaps maps;
  const SearchRule rule = search_rule(options, false, SweepFilter::kAny);
  const auto pose = [&](const PlacedSweep& sweep) {
    const bool given = options.given && options.given->covers(from.begin_s, to.end_s);
    return given ? along(*options.given, pose_of(sweep), Pose{}, from.begin_s, options.knot_s) : SweepPose{};
  };
  maps.insert(from, pose(from));
  return count_sweep(maps, to, pose(to), rule, options, Eigen::Vector3d::Zero()).capped_cost_m();
}

// A recording mostly begins within a sweep. What is left of that one may see too little to be matched to.
bool is_whole(const PlacedSweep& sweep, const PlacedSweep& next) {
  return 4 * sweep.scans >= 3 * next.scans;
}

// Tracks a recording stretch by stretch.
class Walk {
 public:
  Walk(const SweepSource& source, const MappingOptions& options, const Job& job)
      : source_(source), options_(options), job_(job), poses_(source.count) {}

  // False where the job was cancelled.
  bool track(Range range) {
    if (range.size() < min_sweeps()) return true;  // they stay lost
    Tracked best;
    for (const std::size_t start : starts(range)) {
      Tracked found = follow(start, range);
      if (job_.cancelled()) return false;
      if (best.poses.empty() || better(found, best)) best = std::move(found);
      if (best.range.size() == range.size() && best.well) break;
    }
    if (job_.cancelled()) return false;
    if (best.poses.empty()) return true;
    if (++stretches_ == 1) {
      start_ = best.start;
      well_ = best.well && best.range.size() == source_.count;
    }
    for (SweepPose& pose : best.poses) pose.stretch = stretches_;
    std::ranges::move(best.poses, poses_.begin() + std::ptrdiff_t(best.range.first));
    count_ += best.count;
    return track({range.first, best.range.first}) && track({best.range.end, range.end});
  }

  TrackedWalk result() {
    join_stretches();
    return {std::move(poses_), start_, well_, count_};
  }

 private:
  std::size_t min_sweeps() const { return std::size_t(options_.first_sweeps); }

  // Sweeps tracked on one map.
  struct Tracked {
    Range range{0, 0};
    std::size_t start = 0;
    std::vector<SweepPose> poses;
    MatchCount count;
    bool alternates = false, well = false;
  };
  static bool better(const Tracked& a, const Tracked& b) {
    return a.alternates != b.alternates ? b.alternates : a.count.matches > b.count.matches;
  }
  struct Start {
    std::size_t sweep;
    double cost_m;
  };

  std::vector<std::size_t> starts(Range range) const {
    if (options_.start && range.size() == source_.count) return {std::min(*options_.start, range.end - 1)};
    return calm_starts(range);
  }

  // Sweeps from which on the rig moved little, over as many as a first pose is found from; the calmest first,
  // and the first one of all before those that are hardly better. None where the job was cancelled.
  std::vector<std::size_t> calm_starts(Range range) const {
    constexpr double kHardlyBetter = 0.8;  // tuned with MappingOptions
    const std::size_t pairs = min_sweeps() - 1;
    std::vector<double> costs_m;
    std::vector<Start> starts;
    PlacedSweep last = source_.place(range.first);
    for (std::size_t i = range.first; i + 1 < range.end; ++i) {
      if (job_.cancelled()) return {};
      PlacedSweep next = source_.place(i + 1);
      costs_m.push_back(is_whole(last, next) ? cost_at_rest_m(last, next, options_) : options_.cost_cap_m);
      last = std::move(next);
      if (costs_m.size() < pairs) continue;
      const double cost_m = *std::max_element(costs_m.end() - std::ptrdiff_t(pairs), costs_m.end());
      starts.push_back({i + 1 - pairs, cost_m * (starts.empty() ? kHardlyBetter : 1)});
    }
    std::ranges::stable_sort(starts, {}, &Start::cost_m);
    return apart(starts);
  }

  // A few of them that lie apart.
  std::vector<std::size_t> apart(const std::vector<Start>& starts) const {
    constexpr std::size_t kApart =
        3;  // nearer ones share most of the sweeps of a first pose, see first_sweeps
    std::vector<std::size_t> chosen;
    for (const Start& start : starts) {
      const bool is_apart = std::ranges::all_of(chosen, [&](std::size_t other) {
        return start.sweep + kApart <= other || other + kApart <= start.sweep;
      });
      if (is_apart && chosen.size() < std::size_t(options_.max_starts)) chosen.push_back(start.sweep);
    }
    return chosen;
  }

  SweepPose first_pose(std::size_t start, Range range) const {
    std::vector<PlacedSweep> sweeps;
    for (std::size_t i = start; i < range.end && sweeps.size() < min_sweeps(); ++i) {
      sweeps.push_back(source_.place(i));
      match_half(sweeps.back());
    }
    return find_first_pose(sweeps, options_);
  }

  // Leaves every other feature to the map alone: enough for a first guess.
  static void match_half(PlacedSweep& sweep) {
    for (std::vector<PlacedFeature>* features : {&sweep.edges, &sweep.planes}) {
      bool keep = false;
      for (PlacedFeature& feature : *features)
        if (feature.sharp) feature.sharp = keep = !keep;
    }
  }

  // From the start to the range's end, then back to its first sweep, each until track is lost for good.
  Tracked follow(std::size_t start, Range range) {
    Tracker tracker(options_, first_pose(start, range));
    Tracked found;
    found.start = start;
    const auto add = [&](const PlacedSweep& sweep) {
      SweepPose pose = tracker.add(sweep);
      if (tracker.settled()) found.count += tracker.last_count();
      job_.report("tracking", double(std::min(++done_, source_.count)) / double(source_.count));
      return pose;
    };
    const auto goes_on = [&] {
      return tracker.lost_in_a_row() < options_.give_up_after && !job_.cancelled();
    };
    std::size_t end = start, first = start;
    std::vector<SweepPose> before;
    for (; end < range.end && goes_on(); ++end) found.poses.push_back(add(source_.place(end)));
    const auto lost_at_end = std::size_t(tracker.lost_in_a_row());
    if (found.poses.empty()) return found;  // cancelled
    tracker.turn_back(found.poses.front());
    for (; first > range.first && goes_on(); --first)
      before.push_back(reversed(add(reversed(source_.place(first - 1)))));
    const auto lost_at_first = std::size_t(tracker.lost_in_a_row());
    found.poses.insert(found.poses.begin(), before.rbegin() + std::ptrdiff_t(lost_at_first), before.rend());
    found.poses.resize(found.poses.size() - lost_at_end);
    found.range = {first + lost_at_first, end - lost_at_end};
    judge(found);
    return found;
  }

  void judge(Tracked& found) const {
    const Eigen::Vector3d motor_axis = source_.place(found.start).turned_rad.normalized();
    found.alternates = alternating_sway_rad(found.poses, motor_axis) > options_.max_alternation_rad;
    found.well = found.count.matched_part() >= options_.well_tracked && !found.alternates;
  }

  // Puts the stretches into one frame, each where it was found on the map of those before it; one that is not
  // found goes on from where the one before it ended, at its velocity. So do sweeps that were not tracked.
  void join_stretches() {
    Relocaliser relocaliser(options_);
    Pose map_from_stretch;
    std::size_t next = 0;
    for (std::size_t i = 0; i < poses_.size(); i = next) {
      for (next = i + 1; next < poses_.size() && poses_[next].stretch == poses_[i].stretch;) ++next;
      const SweepPose* last = i > 0 ? &poses_[i - 1] : nullptr;
      if (poses_[i].stretch == 0) {
        carry_on(i, next);
        continue;
      }
      const auto found = last != nullptr ? relocated(relocaliser, {i, next}) : std::nullopt;
      if (found)
        map_from_stretch = *found;
      else
        map_from_stretch = carried_to(last, poses_[i].begin_s) * poses_[i].begin().inverse();
      for (std::size_t k = i; k < next; ++k)
        for (Pose& knot : poses_[k].knots) knot = map_from_stretch * knot;
      if (found) fill_gap(i);
      if (stretches_ > 1 && (last == nullptr || found))
        for (std::size_t k = i; k < next; ++k)
          if (!poses_[k].lost) relocaliser.insert(source_.place(k), poses_[k]);
    }
  }

  // Where a rig gets to that goes on after a sweep, or the map's origin.
  static Pose carried_to(const SweepPose* last, double time_s) {
    constexpr double kLongest_s = 0.5;  // as the tracker carries it
    if (last == nullptr) return {};
    return last->at(1 + std::min(time_s - last->end_s, kLongest_s) / (last->end_s - last->begin_s));
  }

  void carry_on(std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      poses_[i] = pose_of(source_.place(i));
      poses_[i].lost = true;
      if (i > 0) poses_[i].knots = {poses_[i - 1].end(), poses_[i - 1].at(2)};
    }
  }

  // map_from_stretch, of these sweeps, by what they see.
  std::optional<Pose> relocated(const Relocaliser& relocaliser, Range range) const {
    constexpr std::size_t kSweeps = 8;  // a full turn of the head, and cheap enough to try in several places
    const std::size_t before = last_tracked(range.first);
    if (before == range.first) return std::nullopt;
    Stretch stretch;
    for (std::size_t i = range.first; i < range.end && stretch.sweeps.size() < kSweeps; ++i) {
      if (poses_[i].lost) continue;
      stretch.sweeps.push_back(source_.place(i));
      stretch.poses.push_back(poses_[i]);
    }
    if (stretch.sweeps.empty()) return std::nullopt;
    const SweepPose& last = poses_[before];
    const double gap_s = stretch.poses.front().begin_s - last.end_s;
    return relocaliser.find(std::move(stretch), last.end(), gap_s);
  }

  // The last sweep before this one that was tracked; this one where there is none.
  std::size_t last_tracked(std::size_t i) const {
    for (std::size_t k = i; k-- > 0;)
      if (!poses_[k].lost) return k;
    return i;
  }

  // The sweeps before this one that were not tracked, evenly from where the rig was to where it is.
  void fill_gap(std::size_t i) {
    const std::size_t before = last_tracked(i);
    const Pose from = poses_[before].end(), to = poses_[i].begin();
    const double from_s = poses_[before].end_s, lasted_s = poses_[i].begin_s - from_s;
    for (std::size_t k = before + 1; k < i; ++k)
      poses_[k].knots = {interpolate(from, to, (poses_[k].begin_s - from_s) / lasted_s),
                         interpolate(from, to, (poses_[k].end_s - from_s) / lasted_s)};
  }

  const SweepSource& source_;
  const MappingOptions& options_;
  const Job& job_;
  std::vector<SweepPose> poses_;  // stretch 0: not tracked
  std::size_t stretches_ = 0, start_ = 0, done_ = 0;
  bool well_ = false;
  MatchCount count_;
};

// Sweeps without long gaps between them. After a longer one a rig that moves is beyond the reach of the next
// sweep's matches, or within that of wrong ones.
std::vector<Range> without_gaps(const SweepSource& source, const MappingOptions& options) {
  constexpr double kLongest_s = 1;
  if (options.given) return {{0, source.count}};  // which bridges them
  std::vector<Range> ranges;
  double last_s = 0;
  for (std::size_t i = 0; i < source.count; ++i) {
    const PlacedSweep sweep = source.place(i);
    if (i == 0 || sweep.begin_s - last_s > kLongest_s) ranges.push_back({i, i});
    ranges.back().end = i + 1;
    last_s = sweep.end_s;
  }
  return ranges;
}

// Along a given motion that is the truth; sweeps that it does not cover are lost.
TrackedWalk follow_given(const SweepSource& source, const MappingOptions& options) {
  TrackedWalk walk;
  const GivenMotion& given = *options.given;
  for (std::size_t i = 0; i < source.count; ++i) {
    SweepPose pose = pose_of(source.place(i));
    pose = along(given, pose, given.at(given.begin_s()), given.begin_s(), options.knot_s);
    pose.lost = !given.covers(pose.begin_s, pose.end_s);
    pose.stretch = 1;
    walk.sweeps.push_back(std::move(pose));
  }
  return walk;
}

Result<TrackedWalk> track(const SweepSource& source, const MappingOptions& options, const Job& job) {
  if (options.given && options.given->is_truth()) return follow_given(source, options);
  Walk walk(source, options, job);
  for (const Range& range : without_gaps(source, options))
    if (job.cancelled() || !walk.track(range))
      return failure(ExitCode::kInterrupted, "interrupted while tracking");
  return walk.result();
}

}  // namespace

std::size_t TrackedWalk::tracked() const {
  return std::size_t(std::ranges::count_if(sweeps, [](const SweepPose& pose) { return !pose.lost; }));
}

Result<TrackedWalk> track(const OffsetProblem& problem, double offset_s, const MappingOptions& options,
                          const Job& job) {
  SweepPlacer placer(problem, offset_s);
  const SweepSource source{placer.count(), [&](std::size_t i) {
                             PlacedSweep sweep;
                             placer.place(i, sweep);
                             return sweep;
                           }};
  return track(source, options, job);
}

Result<TrackedWalk> track(const std::vector<PlacedSweep>& sweeps, const MappingOptions& options,
                          const Job& job) {
  return track(SweepSource{sweeps.size(), [&](std::size_t i) { return sweeps[i]; }}, options, job);
}

std::vector<Interval> lost_intervals(const std::vector<SweepPose>& sweeps) {
  std::vector<Interval> lost;
  bool last_was = false;
  for (const SweepPose& sweep : sweeps) {
    if (sweep.lost && last_was)
      lost.back().end_s = sweep.end_s;
    else if (sweep.lost)
      lost.push_back({sweep.begin_s, sweep.end_s});
    last_was = sweep.lost;
  }
  return lost;
}

MatchCount count_matches(const OffsetProblem& problem, double offset_s, const std::vector<SweepPose>& poses,
                         const MappingOptions& options) {
  const Eigen::Vector3d motor_axis = problem.recording->rig.mount.axis.normalized();
  SweepPlacer placer(problem, offset_s);
  SweepMaps maps;
  MatchCount count;
  int in_map = 0;
  std::size_t stretch = 0;
  auto pose = poses.begin();
  for (PlacedSweep sweep; placer.next(sweep);) {
    while (pose != poses.end() && pose->sweep < sweep.sweep) ++pose;
    // Those at either end may come or go with the offset.
    if (pose == poses.end() || pose->sweep != sweep.sweep || pose->lost) continue;
    if (pose->stretch != stretch) {
      maps = SweepMaps();
      in_map = 0;
      stretch = pose->stretch;
    }
    const SweepFilter others = sweep.direction > 0 ? SweepFilter::kBackward : SweepFilter::kForward;
    if (in_map++ >= options.settling_sweeps)
      count += count_sweep(maps, sweep, *pose, search_rule(options, true, others), options, motor_axis);
    maps.insert(sweep, *pose);
  }
  return count;
}

}  // namespace sweepscope
