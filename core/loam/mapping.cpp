#include "core/loam/mapping.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>

#include "core/loam/least_squares.hpp"
#include "core/loam/patch_search.hpp"
#include "core/loam/sweep_motion.hpp"

namespace sweepscope {
namespace {

struct SweepMaps {
  FeatureMap edges, planes;

  void insert(const PlacedSweep& sweep, const SweepPose& pose) {
    const SweepMotion motion = pose.motion();
    for (const PlacedFeature& feature : sweep.edges)
      edges.insert(motion(feature.p_in_base_m, feature.u).cast<float>(), feature.line, sweep.direction);
    for (const PlacedFeature& feature : sweep.planes)
      planes.insert(motion(feature.p_in_base_m, feature.u).cast<float>(), feature.line, sweep.direction);
  }
};

SearchRule rule_for(const MappingOptions& options, bool grown, SweepFilter filter) {
  SearchRule rule{options.patch, options.search_radius_m, options.search_radius_slope, filter};
  if (!grown) {
    rule.patch.per_line = 3;
    rule.patch.least_lines = 3;
    rule.radius_slope = std::max(rule.radius_slope, 0.25);
  }
  return rule;
}

void count_one(bool found, double distance_m, double gate_m, double cap_m, MatchCount& count) {
  ++count.features;
  count.capped_sum_m += found ? std::min(distance_m, cap_m) : cap_m;
  if (!found || !(distance_m < gate_m)) return;
  ++count.matches;
  count.distance_sum_m += distance_m;
}

// A feature to be matched, and the patch that it was matched to last.
template <typename Patch>
struct MatchedFeature {
  Eigen::Vector3d p_in_base_m;
  double u;
  float range_m;
  std::optional<Patch> patch = std::nullopt;
  Eigen::Vector3d searched_at_m = Eigen::Vector3d::Constant(1e30);
};

template <typename Patch>
std::vector<MatchedFeature<Patch>> to_match(const std::vector<PlacedFeature>& features) {
  std::vector<MatchedFeature<Patch>> found;
  found.reserve(features.size() / 2);
  for (const PlacedFeature& feature : features)
    if (feature.sharp) found.push_back({feature.p_in_base_m, feature.u, feature.range_m});
  return found;
}

// One sweep's matches with the map, kept from step to step while their points hardly move.
class SweepMatcher {
 public:
  SweepMatcher(const SweepMaps& maps, const PlacedSweep& sweep, const SearchRule& rule,
               const MappingOptions& options)
      : maps_(maps),
        rule_(rule),
        options_(options),
        planes_(to_match<PlanePatch>(sweep.planes)),
        edges_(to_match<LinePatch>(sweep.edges)) {}

  // Adds the matches of every `stride`-th feature at the given poses to the equations; counts them too.
  MatchCount linearise(const SweepPose& pose, std::size_t stride, SweepEquations& equations) {
    const SweepMotion motion = pose.motion();
    const Eigen::Vector3d pivot_m = pose.pivot_m();
    MatchCount count;
    for (std::size_t i = 0; i < planes_.size(); i += stride) {
      MatchedFeature<PlanePatch>& feature = planes_[i];
      const Eigen::Vector3d p_m = motion(feature.p_in_base_m, feature.u);
      refresh(feature, p_m, [&] { return find_plane(maps_.planes, p_m, feature.range_m, rule_, near_); });
      const auto& plane = feature.patch;
      const double distance_m = plane ? (p_m - plane->centre_m).dot(plane->normal) : 0.0;
      count_one(plane.has_value(), std::abs(distance_m), options_.plane_gate_m, options_.cost_cap_m, count);
      if (plane) add(p_m, plane->normal, distance_m, feature.u, pivot_m, equations);
    }
    for (std::size_t i = 0; i < edges_.size(); i += stride) {
      MatchedFeature<LinePatch>& feature = edges_[i];
      const Eigen::Vector3d p_m = motion(feature.p_in_base_m, feature.u);
      refresh(feature, p_m, [&] { return find_line(maps_.edges, p_m, feature.range_m, rule_, near_); });
      const auto& line = feature.patch;
      const Eigen::Vector3d away_m = line ? from_line(*line, p_m) : Eigen::Vector3d::Zero();
      const double distance_m = away_m.norm();
      count_one(line.has_value(), distance_m, options_.edge_gate_m, options_.cost_cap_m, count);
      if (distance_m > 1e-9) add(p_m, away_m / distance_m, distance_m, feature.u, pivot_m, equations);
    }
    return count;
  }

 private:
  template <typename Patch, typename Search>
  void refresh(MatchedFeature<Patch>& feature, const Eigen::Vector3d& p_m, const Search& search) {
    const double reach_m = options_.reuse_within_m;
    if ((p_m - feature.searched_at_m).squaredNorm() < reach_m * reach_m) return;
    feature.patch = search();
    feature.searched_at_m = p_m;
  }

  void add(const Eigen::Vector3d& p_m, const Eigen::Vector3d& normal, double distance_m, double u,
           const Eigen::Vector3d& pivot_m, SweepEquations& equations) const {
    const double weight =
        cauchy_weight(distance_m, options_.loss_width_m) / (options_.match_sigma_m * options_.match_sigma_m);
    equations.add(distance_jacobian(p_m, normal, pivot_m), distance_m, weight, u);
  }

  const SweepMaps& maps_;
  SearchRule rule_;
  const MappingOptions& options_;
  std::vector<MatchedFeature<PlanePatch>> planes_;
  std::vector<MatchedFeature<LinePatch>> edges_;
  Neighbours near_;
};

// A soft tie: the sum of signed pose steps plus a residual is near zero, rotation and translation alike.
struct Tie {
  Eigen::Matrix<double, 6, 18> jacobian = Eigen::Matrix<double, 6, 18>::Zero();
  Vector6d residual;

  // How a pose's step about the pivot moves the pose itself.
  void moves(int block, const Pose& pose, const Eigen::Vector3d& pivot_m, double sign) {
    const Eigen::Vector3d d = pose.translation_m - pivot_m;
    Eigen::Matrix3d cross;  // step_rotation x d = -[d]x step_rotation
    cross << 0, d.z(), -d.y(), -d.z(), 0, d.x(), d.y(), -d.x(), 0;
    jacobian.block<3, 3>(0, 6 * block) += sign * Eigen::Matrix3d::Identity();
    jacobian.block<3, 3>(3, 6 * block) += sign * cross;
    jacobian.block<3, 3>(3, 6 * block + 3) += sign * Eigen::Matrix3d::Identity();
  }
  void add_to(Matrix18d& a, Vector18d& g, double sigma) const {
    a.noalias() += jacobian.transpose() * jacobian / (sigma * sigma);
    g.noalias() += jacobian.transpose() * residual / (sigma * sigma);
  }
};

Vector6d difference(const Pose& to, const Pose& from) {  // in the map frame
  Vector6d d;
  d << vector_from_rotation(to.rotation * from.rotation.conjugate()), to.translation_m - from.translation_m;
  return d;
}

class Tracker {
 public:
  Tracker(const MappingOptions& options, const Eigen::Vector3d& motor_axis, const Vector6d& first_twist_per_s)
      : options_(options), motor_axis_(motor_axis), first_twist_per_s_(first_twist_per_s) {}

  void add(const PlacedSweep& sweep) {
    SweepPose pose = predict(sweep);
    if (!walk_.sweeps.empty()) solve(sweep, pose);
    if (!walk_.sweeps.empty()) learn_jump(pose);
    maps_.insert(sweep, pose);
    walk_.sweeps.push_back(pose);
  }
  TrackedWalk& walk() { return walk_; }

 private:
  SweepPose predict(const PlacedSweep& sweep) const {
    SweepPose pose;
    pose.sweep = sweep.sweep;
    pose.direction = sweep.direction;
    pose.begin_s = sweep.begin_s;
    pose.end_s = sweep.end_s;
    const double duration_s = sweep.end_s - sweep.begin_s;
    if (walk_.sweeps.empty()) {
      const Vector6d twist = first_twist_per_s_ * duration_s;
      pose.end = {rotation_from_vector(twist.head<3>()), twist.tail<3>()};
      return pose;
    }
    const SweepPose& last = walk_.sweeps.back();
    const double ratio = duration_s / (last.end_s - last.begin_s);
    pose.begin = joined_to(last, pose.direction);
    const Pose gone = last.begin.inverse() * last.end;
    pose.end = pose.begin * interpolate(Pose{}, gone, ratio);
    return pose;
  }

  // Where a sweep is expected to begin. A wrong offset makes the pose jump at every reversal, to and fro
  // about the motor's axis; by how much is learned on the way.
  Pose joined_to(const SweepPose& last, int direction) const {
    Pose begin = last.end;
    begin.rotation =
        (begin.rotation * rotation_from_vector(direction * jump_rad_ * motor_axis_)).normalized();
    return begin;
  }

  void learn_jump(const SweepPose& pose) {
    if (!options_.expects_jump) return;
    const Eigen::Quaterniond jump = walk_.sweeps.back().end.rotation.conjugate() * pose.begin.rotation;
    const double jump_rad = pose.direction * motor_axis_.dot(vector_from_rotation(jump));
    ++jumps_;
    jump_rad_ += std::max(options_.jump_gain, 1.0 / jumps_) * (jump_rad - jump_rad_);
  }

  void solve(const PlacedSweep& sweep, SweepPose& pose) {
    const bool grown = walk_.sweeps.size() >= std::size_t(options_.settling_sweeps);
    SweepMatcher matcher(maps_, sweep, rule_for(options_, grown, SweepFilter::kAny), options_);
    const SweepPose last = walk_.sweeps.back();
    MatchCount count;
    for (int iteration = 0; iteration < options_.most_iterations; ++iteration) {
      const Eigen::Vector3d pivot_m = pose.pivot_m();
      const bool rough = grown && iteration < options_.rough_iterations;
      SweepEquations equations;
      count = matcher.linearise(pose, rough ? std::size_t(options_.rough_stride) : 1, equations);
      const Vector18d step = step_of(equations, last, pose, pivot_m);
      pose.begin = stepped(pose.begin, step.head<6>(), pivot_m);
      pose.end = stepped(pose.end, step.segment<6>(6), pivot_m);
      pose.bend += step.tail<6>();
      if (!rough && step.cwiseAbs().maxCoeff() < options_.step_tolerance) break;
    }
    pose.features = count.features;
    pose.matches = count.matches;
    if (walk_.sweeps.size() >= std::size_t(options_.settling_sweeps)) walk_.count += count;
  }

  double tie_sigma() const {
    if (!options_.expects_jump) return options_.continuous_tie_sigma;
    constexpr int kUnknownJumps = 4;
    return jumps_ < kUnknownJumps ? options_.first_tie_sigma : options_.tie_sigma;
  }

  Vector18d step_of(const SweepEquations& equations, const SweepPose& last, const SweepPose& pose,
                    const Eigen::Vector3d& pivot_m) const {
    Matrix18d a = equations.matrix();
    Vector18d g = equations.gradient();
    const double bend_weight = 1 / (options_.bend_sigma * options_.bend_sigma);
    a.diagonal().tail<6>().array() += bend_weight;
    g.tail<6>() += bend_weight * pose.bend;
    Tie joint;
    joint.moves(0, pose.begin, pivot_m, 1);
    joint.residual = difference(pose.begin, joined_to(last, pose.direction));
    joint.add_to(a, g, tie_sigma());
    Tie steady;
    steady.moves(1, pose.end, pivot_m, 1);
    steady.moves(0, pose.begin, pivot_m, -1);
    const double ratio = (pose.end_s - pose.begin_s) / (last.end_s - last.begin_s);
    steady.residual = difference(pose.end, pose.begin) - ratio * difference(last.end, last.begin);
    steady.add_to(a, g, options_.twist_change_sigma);
    return -a.ldlt().solve(g);
  }

  const MappingOptions& options_;
  Eigen::Vector3d motor_axis_;
  Vector6d first_twist_per_s_;
  double jump_rad_ = 0;
  int jumps_ = 0;
  SweepMaps maps_;
  TrackedWalk walk_;
};

// The first sweep has no map to be matched to, so the velocity within it is guessed, tried and averaged:
// taken at its word the new estimate would swing to and fro for ever.
Vector6d find_first_twist_per_s(const std::vector<PlacedSweep>& sweeps, const Eigen::Vector3d& motor_axis,
                                const MappingOptions& options) {
  Vector6d twist_per_s = Vector6d::Zero();
  const std::size_t tried = std::min<std::size_t>(std::size_t(options.velocity_sweeps), sweeps.size());
  if (tried < 2) return twist_per_s;
  for (int round = 0; round < options.velocity_rounds; ++round) {
    Tracker tracker(options, motor_axis, twist_per_s);
    for (std::size_t i = 0; i < tried; ++i) tracker.add(sweeps[i]);
    Vector6d found = Vector6d::Zero();
    for (std::size_t i = 1; i < tried; ++i) {
      const SweepPose& pose = tracker.walk().sweeps[i];
      found += difference(pose.end, pose.begin) / (pose.end_s - pose.begin_s);
    }
    const Vector6d next = (twist_per_s + found / double(tried - 1)) / 2;
    const bool settled = (next - twist_per_s).cwiseAbs().maxCoeff() < 0.01;
    twist_per_s = next;
    if (settled) break;
  }
  return twist_per_s;
}

// Leaves every other feature to the map alone: enough for a first guess.
void match_half(PlacedSweep& sweep) {
  for (std::vector<PlacedFeature>* features : {&sweep.edges, &sweep.planes}) {
    bool keep = false;
    for (PlacedFeature& feature : *features)
      if (feature.sharp) feature.sharp = keep = !keep;
  }
}

// A recording mostly begins within a sweep. What is left of that one may see too little to be matched to, and
// the whole map would stand on it.
std::size_t first_whole_sweep(const std::vector<PlacedSweep>& sweeps) {
  return sweeps.size() > 2 && 4 * sweeps[0].scans < 3 * sweeps[1].scans ? 1 : 0;
}

// The pose of a sweep before the first one tracked: the motion goes on backwards.
void prepend_backwards(const PlacedSweep& sweep, std::vector<SweepPose>& poses) {
  const SweepPose& next = poses.front();
  const double ratio = (sweep.end_s - sweep.begin_s) / (next.end_s - next.begin_s);
  SweepPose pose;
  pose.sweep = sweep.sweep;
  pose.direction = sweep.direction;
  pose.begin_s = sweep.begin_s;
  pose.end_s = sweep.end_s;
  pose.begin = interpolate(next.begin, next.end, -ratio);
  pose.end = next.begin;
  poses.insert(poses.begin(), pose);
}

bool lost_track(const TrackedWalk& walk, const MappingOptions& options) {
  std::size_t judged = 0, poor = 0;
  for (std::size_t i = std::size_t(options.settling_sweeps); i < walk.sweeps.size(); ++i) {
    ++judged;
    if (walk.sweeps[i].matches * 4 < walk.sweeps[i].features) ++poor;
  }
  return poor * 4 > judged;
}

}  // namespace

namespace {

// Gives the next sweep in place of the one it is given; false at the end.
using NextSweep = std::function<bool(PlacedSweep&)>;

NextSweep one_by_one(const std::vector<PlacedSweep>& sweeps) {
  return [&sweeps, next = std::size_t{0}](PlacedSweep& sweep) mutable {
    if (next == sweeps.size()) return false;
    sweep = sweeps[next++];
    return true;
  };
}

NextSweep placed_one_by_one(const OffsetProblem& problem, double offset_s) {
  return [placer = std::make_shared<SweepPlacer>(problem, offset_s)](PlacedSweep& sweep) {
    return placer->next(sweep);
  };
}

// The first sweeps, as many as the first velocity is found from, and one more.
std::vector<PlacedSweep> beginning_of(const NextSweep& next, const MappingOptions& options) {
  std::vector<PlacedSweep> beginning;
  for (PlacedSweep sweep; beginning.size() <= std::size_t(options.velocity_sweeps) && next(sweep); sweep = {})
    beginning.push_back(std::move(sweep));
  return beginning;
}

Result<TrackedWalk> track(const NextSweep& next, std::size_t count, const Eigen::Vector3d& motor_axis,
                          const MappingOptions& options, const Job& job) {
  const std::vector<PlacedSweep> beginning = beginning_of(next, options);
  const std::size_t first = first_whole_sweep(beginning);
  std::vector<PlacedSweep> tried(
      beginning.begin() + std::ptrdiff_t(first),
      beginning.begin() +
          std::ptrdiff_t(std::min(beginning.size(), first + std::size_t(options.velocity_sweeps))));
  for (PlacedSweep& sweep : tried) match_half(sweep);
  Tracker tracker(options, motor_axis, find_first_twist_per_s(tried, motor_axis, options));
  std::size_t done = first;
  const auto add = [&](const PlacedSweep& sweep) {
    if (job.cancelled()) return false;
    tracker.add(sweep);
    job.report("tracking", double(++done) / double(count));
    return true;
  };
  bool whole = true;
  for (std::size_t i = first; i < beginning.size() && whole; ++i) whole = add(beginning[i]);
  for (PlacedSweep sweep; whole && next(sweep);) whole = add(sweep);
  if (!whole) return failure(ExitCode::kInterrupted, "interrupted while tracking");
  tracker.walk().lost = lost_track(tracker.walk(), options);
  if (first > 0) prepend_backwards(beginning[0], tracker.walk().sweeps);
  return std::move(tracker.walk());
}

}  // namespace

Result<TrackedWalk> track(const OffsetProblem& problem, double offset_s, const MappingOptions& options,
                          const Job& job) {
  return track(placed_one_by_one(problem, offset_s), problem.motor.sweeps.size(),
               problem.recording->rig.mount.axis.normalized(), options, job);
}

Result<TrackedWalk> track(const std::vector<PlacedSweep>& sweeps, const Eigen::Vector3d& motor_axis,
                          const MappingOptions& options, const Job& job) {
  return track(one_by_one(sweeps), sweeps.size(), motor_axis, options, job);
}

AlternatingRoll take_out_alternating_roll(const std::vector<SweepPose>& sweeps,
                                          const Eigen::Vector3d& motor_axis, int settling_sweeps) {
  AlternatingRoll result;
  result.sweeps = sweeps;
  const std::size_t count = sweeps.size();
  if (count < 5) return result;
  std::vector<double> jump_rad(count, 0.0);  // from each sweep's predecessor
  for (std::size_t k = 1; k < count; ++k) {
    const Eigen::Quaterniond turn = sweeps[k - 1].end.rotation.conjugate() * sweeps[k].begin.rotation;
    jump_rad[k] = motor_axis.dot(vector_from_rotation(turn));
  }
  const std::size_t settled = std::max<std::size_t>(2, std::size_t(settling_sweeps));
  std::vector<double> away_rad;
  for (std::size_t k = settled + 2 < count ? settled : 2; k + 1 < count; ++k) {
    const double alternating_rad = (-jump_rad[k - 1] + 2 * jump_rad[k] - jump_rad[k + 1]) / 4;
    // A wrong offset turns the pose against the sweep.
    away_rad.push_back(-sweeps[k].direction * alternating_rad / 2);
    result.sweep_s.push_back(sweeps[k].begin_s);
    result.sweep_roll_rad.push_back(2 * away_rad.back());
  }
  // The middle four fifths: a sweep that slipped does not count.
  std::sort(away_rad.begin(), away_rad.end());
  const std::size_t cut = away_rad.size() / 10;
  double sum_rad = 0;
  for (std::size_t i = cut; i < away_rad.size() - cut; ++i) sum_rad += away_rad[i];
  const double mean_rad = sum_rad / double(away_rad.size() - 2 * cut);
  result.signed_rotation_rad = 2 * mean_rad;
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Quaterniond back = rotation_from_vector(sweeps[k].direction * mean_rad * motor_axis);
    result.sweeps[k].begin.rotation = (sweeps[k].begin.rotation * back).normalized();
    result.sweeps[k].end.rotation = (sweeps[k].end.rotation * back).normalized();
  }
  return result;
}

namespace {

// Counts one sweep after the other, each against the map of those before it that turned the other way.
class MatchCounter {
 public:
  explicit MatchCounter(const MappingOptions& options) : options_(options) {}

  void add(const PlacedSweep& sweep, const SweepPose& pose) {
    if (sweeps_++ >= std::size_t(options_.settling_sweeps)) count_sweep(sweep, pose.motion());
    maps_.insert(sweep, pose);
  }
  const MatchCount& count() const { return count_; }

 private:
  void count_sweep(const PlacedSweep& sweep, const SweepMotion& motion) {
    const SearchRule rule =
        rule_for(options_, true, sweep.direction > 0 ? SweepFilter::kBackward : SweepFilter::kForward);
    for (const PlacedFeature& feature : sweep.planes) {
      if (!feature.sharp) continue;
      const Eigen::Vector3d p_m = motion(feature.p_in_base_m, feature.u);
      const auto plane = find_plane(maps_.planes, p_m, feature.range_m, rule, near_);
      const double distance_m = plane ? std::abs((p_m - plane->centre_m).dot(plane->normal)) : 0.0;
      count_one(plane.has_value(), distance_m, options_.plane_gate_m, options_.cost_cap_m, count_);
    }
    for (const PlacedFeature& feature : sweep.edges) {
      if (!feature.sharp) continue;
      const Eigen::Vector3d p_m = motion(feature.p_in_base_m, feature.u);
      const auto line = find_line(maps_.edges, p_m, feature.range_m, rule, near_);
      const double distance_m = line ? from_line(*line, p_m).norm() : 0.0;
      count_one(line.has_value(), distance_m, options_.edge_gate_m, options_.cost_cap_m, count_);
    }
  }

  const MappingOptions& options_;
  std::size_t sweeps_ = 0;
  SweepMaps maps_;
  MatchCount count_;
  Neighbours near_;
};

}  // namespace

MatchCount count_matches(const OffsetProblem& problem, double offset_s, const std::vector<SweepPose>& poses,
                         const MappingOptions& options) {
  MatchCounter counter(options);
  SweepPlacer placer(problem, offset_s);
  auto pose = poses.begin();
  for (PlacedSweep sweep; placer.next(sweep);) {
    while (pose != poses.end() && pose->sweep < sweep.sweep) ++pose;
    // Those at either end may come or go with the offset.
    if (pose != poses.end() && pose->sweep == sweep.sweep) counter.add(sweep, *pose);
  }
  return counter.count();
}

MatchCount count_matches(const std::vector<PlacedSweep>& sweeps, const std::vector<SweepPose>& poses,
                         const MappingOptions& options) {
  MatchCounter counter(options);
  for (std::size_t k = 0; k < sweeps.size(); ++k) counter.add(sweeps[k], poses[k]);
  return counter.count();
}

}  // namespace sweepscope
