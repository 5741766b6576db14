#include "core/loam/mapping.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <functional>
#include <optional>
#include <span>

#include "core/loam/judged_walk.hpp"
#include "core/loam/path/agreement.hpp"
#include "core/loam/path/given_motion.hpp"
#include "core/loam/path/least_squares.hpp"
#include "core/loam/tracker.hpp"
#include "core/numbers.hpp"

namespace sweepscope {
namespace {

struct SweepSource {
  std::size_t count = 0;
  std::function<PlacedSweep(std::size_t)> place;
};

SweepSource source_of(SweepPlacer& placer) {
  return {placer.count(), [&placer](std::size_t i) {
            PlacedSweep sweep;
            placer.place(i, sweep);
            return sweep;
          }};
}

// Sweeps [first, end) of the recording.
struct Range {
  std::size_t first, end;
  std::size_t size() const { return end - first; }
};

// How two sweeps in a row fit each other, were the rig at rest or moved as given.
struct FitAtRest {
  double cost_m;      // how far the later one's features lie from where the earlier one saw them
  double determined;  // by its matches, of the direction of motion that they determine least
};

// Turns count by how far they move a feature at the mean range.
double determined_by(const RigidEquations& matches, const MatchCount& count) {
  Vector6d scale = Vector6d::Ones();
  scale.head<3>().setConstant(double(count.features) / count.range_sum_m);
  const Matrix6d scaled = scale.asDiagonal() * matches.matrix * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Matrix6d>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[0] /
         double(count.features);
}

FitAtRest fit_at_rest(const PlacedSweep& from, const PlacedSweep& to, const MappingOptions& options) {
  SweepMaps maps;
  const auto pose = [&](const PlacedSweep& sweep) {
    const bool given = options.given && options.given->covers(from.begin_s, to.end_s);
    return given ? along(*options.given, pose_of(sweep), Pose{}, from.begin_s, options.knot_s) : SweepPose{};
  };
  maps.insert(from, pose(from));
  PatchSearch search{maps.edges, maps.planes, search_rule(options, false, SweepFilter::kAny)};
  const SweepMotion motion = pose(to).motion();
  MatchCount count;
  RigidEquations matches;
  const auto place = [&](const PlacedFeature& feature) { return motion(feature.p_in_base_m, feature.u); };
  match_features(to, place, search,
                 [&](MatchedKind kind, const PlacedFeature& feature, const Eigen::Vector3d& p_m,
                     const std::optional<MatchResidual>& residual) {
                   count.add(residual, feature.range_m, gate_m(kind, options), options.cost_cap_m);
                   if (residual && residual->has_normal) matches.add(p_m, residual->normal, 0, 1);
                 });
  if (count.features == 0) return {0, 0};
  return {count.capped_cost_m(), determined_by(matches, count)};
}

// A recording mostly begins within a sweep. What is left of that one may see too little to be matched to.
bool is_whole(const PlacedSweep& sweep, const PlacedSweep& next) {
  return 4 * sweep.scans >= 3 * next.scans;
}

// Tracks a recording stretch by stretch.
class Walk {
 public:
  Walk(const SweepSource& source, const MappingOptions& options, const JudgedWalk* earlier, const Job& job)
      : source_(source),
        options_(options),
        earlier_(earlier),
        job_(job),
        poses_(source.count),
        agreed_(source.count, 0) {}

  // False where the job was cancelled.
  bool track(Range range) {
    if (range.size() < min_sweeps()) return true;  // they stay lost
    std::vector<Stretch> tried;                    // the best first
    for (const std::size_t start : starts(range)) {
      tried.push_back(follow(start, {first_pose(start, range)}, range));
      if (job_.cancelled()) return false;
      compare_latest(tried);
      std::ranges::stable_sort(tried, better);
      if (confirmed(tried.front(), range) || hopeless(tried)) break;
    }
    if (job_.cancelled()) return false;
    if (tried.empty()) return true;
    Stretch& best = tried.front();
    if (stretches_ == 0) {
      for (const Stretch& stretch : tried) starts_.push_back(stretch.start);
      well_ = range.size() == source_.count && confirmed(best, range);
      mend(tried);
    }
    return take(best, range);
  }
  // The same from sweeps whose poses are known.
  bool track_from(KnownSweeps known) {
    const Range all{0, source_.count};
    Stretch found = follow(known.first, std::move(known.poses), all);
    return !job_.cancelled() && take(found, all);
  }

  JudgedWalk result() {
    join_stretches();
    return {{std::move(poses_), std::move(starts_), well_, count_},
            std::move(agreed_),
            std::move(contradictions_)};
  }

 private:
  std::size_t min_sweeps() const { return std::size_t(options_.first_sweeps); }

  // Sweeps tracked on one map.
  struct Stretch {
    Range range{0, 0};
    std::size_t start = 0;
    std::vector<SweepPose> poses;
    MatchCount count;
    bool alternates = false;
    std::vector<char> agreed;  // of each sweep, whether another track found the same motion

    std::size_t agreed_sweeps() const { return std::size_t(std::ranges::count(agreed, 1)); }
  };
  // As the next stretch; then what is before and after it.
  bool take(Stretch& found, Range range) {
    ++stretches_;
    for (SweepPose& pose : found.poses) pose.stretch = stretches_;
    std::ranges::move(found.poses, poses_.begin() + std::ptrdiff_t(found.range.first));
    count_ += found.count;
    return track({range.first, found.range.first}) && track({found.range.end, range.end});
  }
  static bool better(const Stretch& a, const Stretch& b) {
    if (a.alternates != b.alternates) return b.alternates;
    if (a.agreed_sweeps() != b.agreed_sweeps()) return a.agreed_sweeps() > b.agreed_sweeps();
    return a.count.matches > b.count.matches;
  }

  static void compare_latest(std::vector<Stretch>& tried) {
    Stretch& latest = tried.back();
    for (Stretch& other : std::span(tried).first(tried.size() - 1)) {
      const std::size_t first = std::max(latest.range.first, other.range.first);
      const std::size_t end = std::min(latest.range.end, other.range.end);
      if (first >= end) continue;
      const auto part = [&](const Stretch& of) {
        return std::span(of.poses).subspan(first - of.range.first, end - first);
      };
      const std::vector<char> agreed = agreeing(part(latest), part(other));
      for (Stretch* of : {&latest, &other})
        for (std::size_t i = first; i < end; ++i) of->agreed[i - of->range.first] |= agreed[i - first];
    }
  }
  // The best one, where the others or the track at a near offset are more to be trusted.
  void mend(std::vector<Stretch>& tried) {
    Stretch& best = tried.front();
    const auto [first, end] = best.range;
    std::vector<JudgedTrack> others;
    for (const Stretch& other : std::span(tried).subspan(1))
      if (other.range.first <= first && end <= other.range.end)
        others.push_back({std::span(other.poses).subspan(first - other.range.first, end - first),
                          std::span(other.agreed).subspan(first - other.range.first, end - first)});
    Stretch earlier;
    if (earlier_ != nullptr) {
      earlier = same_sweeps(*earlier_, best.poses);
      const std::vector<char> agreed = agreeing(best.poses, earlier.poses);
      for (std::size_t i = 0; i < agreed.size(); ++i) best.agreed[i] |= agreed[i];
      others.push_back({earlier.poses, earlier.agreed, true});
    }
    MendedTrack track = mended(std::move(best.poses), std::move(best.agreed), others);
    best.poses = std::move(track.poses);
    best.agreed = std::move(track.agreed);
    contradictions_ = std::move(track.contradictions);
    std::ranges::copy(best.agreed, agreed_.begin() + std::ptrdiff_t(first));
  }
  // Of a walk; those that its first stretch lacks are lost.
  static Stretch same_sweeps(const JudgedWalk& walk, const std::vector<SweepPose>& sweeps) {
    Stretch stretch;
    for (const SweepPose& sweep : sweeps) {
      const auto found = std::ranges::lower_bound(walk.sweeps, sweep.sweep, {}, &SweepPose::sweep);
      const bool has = found != walk.sweeps.end() && found->sweep == sweep.sweep && found->stretch == 1;
      stretch.poses.push_back(has ? *found : sweep);
      stretch.poses.back().lost |= !has;
      stretch.agreed.push_back(has ? walk.agreed[std::size_t(found - walk.sweeps.begin())] : char(0));
    }
    return stretch;
  }
  // Whether a second track found nearly the same, of all but what the first and the last sweep hold.
  bool confirmed(const Stretch& best, Range range) const {
    if (best.alternates || best.range.first > range.first + 1 || best.range.end + 1 < range.end) return false;
    constexpr double kMostSweeps = 0.9;
    return double(best.agreed_sweeps()) >= kMostSweeps * double(range.size());
  }
  // Whether hardly anything matches, wherever it begins.
  bool hopeless(const std::vector<Stretch>& tried) const {
    return tried.size() > 1 && std::ranges::all_of(tried, [&](const Stretch& stretch) {
             return stretch.count.matched_part() < options_.well_followed;
           });
  }
  struct Start {
    std::size_t sweep;
    double cost_m, determined;  // of the worst of its pairs of sweeps
  };

  std::vector<std::size_t> starts(Range range) const {
    if (options_.starts.empty() || range.size() != source_.count) return good_starts(range);
    std::vector<std::size_t> wanted = options_.starts;
    for (std::size_t& start : wanted) start = std::min(start, range.end - 1);
    return wanted;
  }

  // Sweeps to begin with, the best first, over as many as a first pose is found from: those from which on the
  // matches determine the motion, and of these those where the rig moved little; the first one of all before
  // those that are hardly better. Places that show little of the motion look calm. None where the job was
  // cancelled.
  std::vector<std::size_t> good_starts(Range range) const {
    constexpr double kHardlyBetter = 0.8;  // tuned with MappingOptions
    const auto pairs = std::ptrdiff_t(min_sweeps() - 1);
    std::vector<double> costs_m, determined;
    std::vector<Start> starts;
    PlacedSweep last = source_.place(range.first);
    for (std::size_t i = range.first; i + 1 < range.end; ++i) {
      if (job_.cancelled()) return {};
      PlacedSweep next = source_.place(i + 1);
      const FitAtRest fit =
          is_whole(last, next) ? fit_at_rest(last, next, options_) : FitAtRest{options_.cost_cap_m, 0};
      costs_m.push_back(fit.cost_m);
      determined.push_back(fit.determined);
      last = std::move(next);
      if (std::ssize(costs_m) < pairs) continue;
      starts.push_back({i + 1 - std::size_t(pairs), *std::max_element(costs_m.end() - pairs, costs_m.end()),
                        *std::min_element(determined.end() - pairs, determined.end())});
    }
    if (starts.empty()) return {};
    starts.front().cost_m *= kHardlyBetter;
    return apart(ranked(std::move(starts)));
  }

  std::vector<Start> ranked(std::vector<Start> starts) const {
    std::vector<double> determined;
    for (const Start& start : starts) determined.push_back(start.determined);
    const double enough = std::min(options_.well_determined, median(std::move(determined)));
    std::ranges::stable_sort(starts, [&](const Start& a, const Start& b) {
      const bool a_enough = a.determined >= enough, b_enough = b.determined >= enough;
      return a_enough != b_enough ? a_enough : a.cost_m < b.cost_m;
    });
    return starts;
  }

  // A few of them that lie apart.
  std::vector<std::size_t> apart(const std::vector<Start>& starts) const {
    // Nearer than 3 they share most of the sweeps of a first pose, see first_sweeps; near ones also err
    // alike.
    const std::size_t min_distance = std::max<std::size_t>(3, starts.size() / 8);
    std::vector<std::size_t> chosen;
    for (const Start& start : starts) {
      const bool is_apart = std::ranges::all_of(chosen, [&](std::size_t other) {
        return start.sweep + min_distance <= other || other + min_distance <= start.sweep;
      });
      if (is_apart && chosen.size() < std::size_t(options_.max_starts)) chosen.push_back(start.sweep);
    }
    return chosen;
  }

  SweepPose first_pose(std::size_t start, Range range) const {
    std::vector<PlacedSweep> sweeps;
    for (std::size_t i = start; i < range.end && sweeps.size() < min_sweeps(); ++i) {
      sweeps.push_back(source_.place(i));
      thin(sweeps.back(), 2);  // enough for a first guess
    }
    return find_first_pose(sweeps, options_);
  }

  // From sweeps whose poses are known, the first of them at the start, to the range's end, then back to its
  // first sweep, each until track is lost for good.
  Stretch follow(std::size_t start, std::vector<SweepPose> known, Range range) {
    Tracker tracker(options_);
    Stretch found;
    found.start = start;
    found.poses = std::move(known);
    std::size_t end = start, first = start;
    for (const SweepPose& pose : found.poses) tracker.know(source_.place(end++), pose);
    const auto add = [&](const PlacedSweep& sweep) {
      SweepPose pose = tracker.add(sweep);
      if (tracker.settled()) found.count += tracker.last_count();
      job_.report("tracking", double(std::min(++done_, source_.count)) / double(source_.count));
      return pose;
    };
    const auto goes_on = [&] {
      return tracker.lost_in_a_row() < options_.give_up_after && !job_.cancelled();
    };
    std::vector<SweepPose> before;
    for (; end < range.end && goes_on(); ++end) found.poses.push_back(add(source_.place(end)));
    const auto lost_at_end = std::size_t(tracker.lost_in_a_row());
    tracker.turn_back(found.poses.front());
    for (; first > range.first && goes_on(); --first)
      before.push_back(reversed(add(reversed(source_.place(first - 1)))));
    const auto lost_at_first = std::size_t(tracker.lost_in_a_row());
    found.poses.insert(found.poses.begin(), before.rbegin() + std::ptrdiff_t(lost_at_first), before.rend());
    found.poses.resize(found.poses.size() - lost_at_end);
    found.range = {first + lost_at_first, end - lost_at_end};
    found.agreed.assign(found.range.size(), 0);
    found.alternates = alternates(found);
    return found;
  }

  bool alternates(const Stretch& stretch) const {
    const Eigen::Vector3d motor_axis = source_.place(stretch.start).turned_rad.normalized();
    return alternating_sway_rad(stretch.poses, motor_axis) > options_.max_alternation_rad;
  }

  // Each stretch goes on from where the one before it ended, at its velocity; so do sweeps that were not
  // tracked at all.
  void join_stretches() {
    Pose map_from_stretch;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      SweepPose& pose = poses_[i];
      const SweepPose* last = i > 0 ? &poses_[i - 1] : nullptr;
      const bool tracked = pose.stretch > 0;
      if (!tracked) {
        pose = pose_of(source_.place(i));
        pose.lost = true;
        if (last != nullptr) pose.knots = {last->end(), last->at(2)};
        continue;
      }
      if (last != nullptr && last->stretch != pose.stretch)
        map_from_stretch = last->end() * pose.begin().inverse();
      else if (last == nullptr)
        map_from_stretch = pose.begin().inverse();
      for (Pose& knot : pose.knots) knot = map_from_stretch * knot;
    }
  }

  const SweepSource& source_;
  const MappingOptions& options_;
  const JudgedWalk* earlier_;
  const Job& job_;
  std::vector<SweepPose> poses_;  // stretch 0: not tracked
  std::size_t stretches_ = 0, done_ = 0;
  std::vector<std::size_t> starts_;
  bool well_ = false;
  std::vector<char> agreed_;  // of the first stretch
  std::vector<Contradiction> contradictions_;
  MatchCount count_;
};

// Along a given motion that is the truth; sweeps that it does not cover are lost.
JudgedWalk follow_given(const SweepSource& source, const MappingOptions& options) {
  JudgedWalk walk;
  const GivenMotion& given = *options.given;
  for (std::size_t i = 0; i < source.count; ++i) {
    SweepPose pose = pose_of(source.place(i));
    pose = along(given, pose, given.at(given.begin_s()), given.begin_s(), options.knot_s);
    pose.lost = !given.covers(pose.begin_s, pose.end_s);
    pose.stretch = 1;
    walk.sweeps.push_back(std::move(pose));
  }
  walk.agreed.assign(source.count, 1);
  return walk;
}

Result<JudgedWalk> track(const SweepSource& source, const MappingOptions& options, const JudgedWalk* earlier,
                         const Job& job) {
  if (options.given && options.given->is_truth()) return follow_given(source, options);
  Walk walk(source, options, earlier, job);
  if (job.cancelled() || !walk.track({0, source.count}))
    return failure(ExitCode::kInterrupted, "interrupted while tracking");
  return walk.result();
}

}  // namespace

std::size_t TrackedWalk::tracked() const {
  return std::size_t(std::ranges::count_if(sweeps, [](const SweepPose& pose) { return !pose.lost; }));
}

Result<JudgedWalk> track_and_judge(const OffsetProblem& problem, double offset_s,
                                   const MappingOptions& options, const JudgedWalk* earlier, const Job& job) {
  SweepPlacer placer(problem, offset_s);
  return track(source_of(placer), options, earlier, job);
}

Result<JudgedWalk> track_from(const OffsetProblem& problem, double offset_s, KnownSweeps known,
                              const MappingOptions& options, const Job& job) {
  SweepPlacer placer(problem, offset_s);
  const SweepSource source = source_of(placer);
  Walk walk(source, options, nullptr, job);
  if (!walk.track_from(std::move(known)))
    return failure(ExitCode::kInterrupted, "interrupted while tracking");
  return walk.result();
}

Result<TrackedWalk> track(const OffsetProblem& problem, double offset_s, const MappingOptions& options,
                          const Job& job) {
  return track_and_judge(problem, offset_s, options, nullptr, job);
}

Result<TrackedWalk> track(const std::vector<PlacedSweep>& sweeps, const MappingOptions& options,
                          const Job& job) {
  return track(SweepSource{sweeps.size(), [&](std::size_t i) { return sweeps[i]; }}, options, nullptr, job);
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
                         const MappingOptions& options, const Job& job) {
  const Eigen::Vector3d motor_axis = problem.recording->rig.mount.axis.normalized();
  SweepPlacer placer(problem, offset_s);
  SweepMaps maps;
  MatchCount count;
  int in_map = 0;
  std::size_t stretch = 0;
  auto pose = poses.begin();
  for (PlacedSweep sweep; !job.cancelled() && placer.next(sweep);) {
    while (pose != poses.end() && pose->sweep < sweep.sweep) ++pose;
    // Those at either end may come or go with the offset.
    if (pose == poses.end() || pose->sweep != sweep.sweep || pose->lost) continue;
    if (pose->stretch != stretch) {
      maps = SweepMaps();
      in_map = 0;
      stretch = pose->stretch;
    }
    const SweepFilter others = sweep.side > 0 ? SweepFilter::kBackward : SweepFilter::kForward;
    if (in_map++ >= options.settling_sweeps)
      count += count_sweep(maps, sweep, *pose, search_rule(options, true, others), options, motor_axis);
    maps.insert(sweep, *pose);
  }
  return count;
}

}  // namespace sweepscope
