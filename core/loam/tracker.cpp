#include "core/loam/tracker.hpp"

#include <algorithm>
#include <cmath>

#include "core/loam/path/given_motion.hpp"
#include "core/loam/path/least_squares.hpp"
#include "core/loam/path/path_equations.hpp"

namespace sweepscope {
namespace {

// Beyond the sweep's end, so that no feature of it is left out.
constexpr double kWhole = 2;

// Of the first sweep, and where scans are missing, the velocity is carried on for no longer than this: a
// sweep of most recordings, and about half a stride.
constexpr double kLongestCarriedGap_s = 0.5;

// Without scans for longer, a rig that moves may be where other surfaces match: the next sweep must match
// better.
constexpr double kLongGap_s = 1;

std::size_t steps_of(const PlacedSweep& sweep, const MappingOptions& options) {
  return std::max<std::size_t>(1, std::size_t(std::lround((sweep.end_s - sweep.begin_s) / options.knot_s)));
}

bool is_given(const MappingOptions& options, double from_s, double to_s) {
  return options.given && options.given->covers(std::min(from_s, to_s), std::max(from_s, to_s));
}

// At a constant velocity, or deviation from a given motion, from the map's origin on.
SweepPose steady_pose(const PlacedSweep& sweep, const Vector6d& twist_per_s, const MappingOptions& options) {
  SweepPose pose = pose_of(sweep);
  if (is_given(options, sweep.begin_s, sweep.end_s)) {
    pose = along(*options.given, pose, Pose{}, sweep.begin_s, options.knot_s);
    const double step_s = (sweep.end_s - sweep.begin_s) / double(pose.knots.size() - 1);
    for (std::size_t i = 0; i < pose.knots.size(); ++i)
      pose.knots[i] = stepped(pose.knots[i], double(i) * step_s * twist_per_s, pose.knots[i].translation_m);
    return pose;
  }
  const Vector6d gone = (sweep.end_s - sweep.begin_s) * twist_per_s;
  const Pose end{rotation_from_vector(gone.head<3>()), gone.tail<3>()};
  const std::size_t steps = steps_of(sweep, options);
  pose.knots.clear();
  for (std::size_t i = 0; i <= steps; ++i)
    pose.knots.push_back(interpolate(Pose{}, end, double(i) / double(steps)));
  return pose;
}

// Scan lines that a body turns back as fast as the motor turns them lie on each other, and match well.
bool undoes_motor(const std::vector<Pose>& path, const std::vector<Pose>& moves, const PlacedSweep& sweep) {
  Eigen::Quaterniond turn = path.front().rotation.conjugate() * path.back().rotation;
  for (std::size_t i = moves.size(); i-- > 1;) turn = turn * moves[i].rotation.conjugate();
  const Eigen::Vector3d turned_rad = vector_from_rotation(turn);
  return turned_rad.dot(sweep.turned_rad) < -0.4 * sweep.turned_rad.squaredNorm();
}

Pose carried_on(const Pose& from, const Pose& to, double steps) {
  return to * interpolate(Pose{}, from.inverse() * to, steps);
}

}  // namespace

Tracker::Tracker(const MappingOptions& options, double time_sign)
    : options_(options),
      time_sign_(time_sign),
      acceleration2_(
          Eigen::Vector2d::Constant(std::pow(options.first_acceleration / options.acceleration_factor, 2))) {}

void Tracker::know(const PlacedSweep& sweep, const SweepPose& pose) {
  path_ = pose.knots;
  end_s_ = sweep.end_s;
  step_s_ = (sweep.end_s - sweep.begin_s) / double(path_.size() - 1);
  maps_.insert(sweep, pose);
  learn_acceleration(pose);
  ++sweeps_;
}

SweepPose Tracker::add(const PlacedSweep& sweep) {
  SweepPose pose = pose_of(sweep);
  const std::size_t steps = steps_of(sweep, options_);
  if (sweep.begin_s - end_s_ > kLongGap_s) after_gap_ = true;
  if (!begin_along_given(sweep, steps)) begin_path(sweep, steps);
  Solved best = solved(sweep, steps);
  path_ = std::move(best.path);
  pose.features = best.count.features;
  pose.matches = best.count.matches;
  judge(best.count);
  last_count_ = best.count;
  end_s_ = sweep.end_s;
  pose.knots = path_;
  pose.lost = lost_in_a_row_ > 0;
  if (!pose.lost) {
    maps_.insert(sweep, pose);
    learn_acceleration(pose);
  }
  ++sweeps_;
  return pose;
}

void Tracker::turn_back(const SweepPose& first) {
  const SweepPose back = reversed(first);
  path_ = back.knots;
  end_s_ = back.end_s;
  step_s_ = (back.end_s - back.begin_s) / double(path_.size() - 1);
  time_sign_ = -time_sign_;
  last_twist_per_s_ = deviation_twists_per_s(back, 2, options_.given.get(), time_sign_).back();
  lost_in_a_row_ = 0;
  after_gap_ = false;
}

Pose Tracker::given_move(double from_s, double to_s) const {
  return options_.given->move(time_sign_ * from_s, time_sign_ * to_s);
}

// A sweep's path begins where the last one's ended.
void Tracker::begin_path(const PlacedSweep& sweep, std::size_t steps) {
  const double step_s = (sweep.end_s - sweep.begin_s) / double(steps);
  const double gap_s = std::min(sweep.begin_s - end_s_, kLongestCarriedGap_s);
  const double last = double(path_.size() - 1);
  const auto at = [&](double after_s) { return pose_between(path_, 1 + after_s / step_s_ / last); };
  before_ = at(gap_s - step_s);
  path_ = {at(gap_s)};
  step_s_ = step_s;
}

// The same where a motion is given; false where it does not cover the sweep and the step before it.
bool Tracker::begin_along_given(const PlacedSweep& sweep, std::size_t steps) {
  moves_.clear();
  const double step_s = (sweep.end_s - sweep.begin_s) / double(steps), gap_s = sweep.begin_s - end_s_;
  const double first_s = std::min(sweep.begin_s - step_s, end_s_ - step_s_);
  if (!is_given(options_, time_sign_ * first_s, time_sign_ * sweep.end_s)) return false;
  const Pose expected = path_[path_.size() - 2] * given_move(end_s_ - step_s_, end_s_);
  const Vector6d deviation_per_s = difference(path_.back(), expected) / step_s_;
  const Pose carried = path_.back() * given_move(end_s_, sweep.begin_s);
  const auto at = [&](double after_s) {
    return stepped(carried, after_s * deviation_per_s, carried.translation_m);
  };
  const double carried_s = std::min(gap_s, kLongestCarriedGap_s);
  path_ = {at(carried_s)};
  before_ = at(carried_s - step_s) * given_move(sweep.begin_s, sweep.begin_s - step_s);
  step_s_ = step_s;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double to_s = sweep.begin_s + double(i) * step_s;
    moves_.push_back(given_move(to_s - step_s, to_s));
  }
  return true;
}

// One more knot, at the velocity of the last ones.
std::vector<Pose> Tracker::extrapolated(std::vector<Pose> path, double carried) const {
  const std::size_t back = std::min<std::size_t>(path.size(), 2);
  const Pose& from = back == path.size() ? before_ : path[path.size() - 1 - back];
  if (!moves_.empty()) {
    Pose expected = from;
    for (std::size_t i = path.size() - back; i < path.size(); ++i) expected = expected * moves_[i];
    const Vector6d deviation = difference(path.back(), expected) / double(back);
    const Pose next = path.back() * moves_[path.size()];
    path.push_back(stepped(next, carried * deviation, next.translation_m));
    return path;
  }
  path.push_back(carried_on(from, path.back(), carried / double(back)));
  return path;
}

Tracker::Solved Tracker::solved(const PlacedSweep& sweep, std::size_t steps) const {
  const SearchRule rule = search_rule(options_, grown(), SweepFilter::kAny);
  Solved best = attempt(sweep, steps, rule, {1, 1});
  const double enough = options_.doubtful_below * usual_part_, lost = options_.lost_below * usual_part_;
  // Another velocity only where the sweep would be lost: of 6600 tries with one, on four costly walks of
  // tests/benchmark/worlds, 110 matched better.
  constexpr Attempt kOthers[] = {{3, 1}, {1.0 / 3, 1}, {1, 0.3}, {3, 0}, {3, -0.7}};
  for (const Attempt& other : kOthers) {
    if (best.count.matched_part() >= (other.carried < 1 ? lost : enough)) break;
    Solved found = attempt(sweep, steps, rule, other);
    if (found.count.matched_part() > best.count.matched_part()) best = std::move(found);
  }
  return best;
}

// Knot by knot, then all of them.
Tracker::Solved Tracker::attempt(const PlacedSweep& sweep, std::size_t steps, const SearchRule& rule,
                                 const Attempt& attempt) const {
  SweepMatcher matcher(maps_, sweep, rule, options_);
  Solved solved{path_, {}};
  for (std::size_t step = 1; step <= steps; ++step) {
    solved.path = extrapolated(std::move(solved.path), step == 1 ? attempt.carried : 1);
    const bool whole = step == steps;
    const double end_u = double(step) / double(steps);
    const SweepMatcher::Share share = whole ? SweepMatcher::Share{kWhole, 1}
                                            : SweepMatcher::Share{end_u, std::size_t(options_.rough_stride)};
    for (int i = 0; i < (whole ? options_.max_iterations : options_.rough_iterations); ++i) {
      PathEquations equations(solved.path.size(), end_u);
      const Eigen::Vector3d pivot_m = solved.path[step / 2].translation_m;
      solved.count = matcher.linearise(SweepMotion(solved.path, end_u), share, pivot_m, equations);
      const double moved = improve(solved.path, equations, attempt.acceleration_factor, pivot_m);
      if (moved < options_.step_tolerance * (whole ? 1 : 4)) break;
    }
  }
  if (undoes_motor(solved.path, moves_, sweep)) solved.count.matches = 0;
  return solved;
}

// One step of the least squares; how far it moved.
double Tracker::improve(std::vector<Pose>& path, PathEquations& equations, double acceleration_factor,
                        const Eigen::Vector3d& pivot_m) const {
  const Eigen::Vector2d acceleration = (options_.acceleration_factor * acceleration2_.cwiseSqrt())
                                           .cwiseMax(options_.min_acceleration)
                                           .cwiseMin(options_.max_acceleration);
  equations.add_accelerations(path, before_, acceleration_factor * step_s_ * step_s_ * acceleration, pivot_m,
                              moves_);
  equations.add_velocities(path, step_s_ * options_.velocity_sigma, pivot_m, moves_);
  equations.add_tie(path.front(), path_.front(), options_.tie_sigma, pivot_m);
  const std::vector<Vector6d> steps = equations.solve();
  double moved = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    path[i] = stepped(path[i], steps[i], pivot_m);
    moved = std::max(moved, steps[i].cwiseAbs().maxCoeff());
  }
  return moved;
}

void Tracker::judge(const MatchCount& count) {
  const double part = count.matched_part();
  if (grown()) usual_part_ += 0.1 * (part - usual_part_);
  const double lost_below = after_gap_ ? options_.doubtful_below : options_.lost_below;
  const bool lost = (grown() || after_gap_) && part < lost_below * usual_part_;
  lost_in_a_row_ = lost ? lost_in_a_row_ + 1 : 0;
  after_gap_ = after_gap_ && lost;
}

// From the velocities of half sweeps, which the map determines whatever was expected.
void Tracker::learn_acceleration(const SweepPose& pose) {
  const double half_s = (pose.end_s - pose.begin_s) / 2;
  for (const Vector6d& twist_per_s : deviation_twists_per_s(pose, 2, options_.given.get(), time_sign_)) {
    const Vector6d change = (twist_per_s - last_twist_per_s_) / half_s;
    last_twist_per_s_ = twist_per_s;
    constexpr int kFirst = 4;  // which a guessed velocity is in
    if (++learned_ <= kFirst) continue;
    const Eigen::Vector2d square(change.head<3>().squaredNorm() / 3, change.tail<3>().squaredNorm() / 3);
    for (int i = 0; i < 2; ++i) {
      const double gain = square[i] > acceleration2_[i] ? 0.15 : 0.05;
      acceleration2_[i] += gain * (square[i] - acceleration2_[i]);
    }
  }
}

PlacedSweep reversed(PlacedSweep sweep) {
  std::swap(sweep.begin_s, sweep.end_s);
  sweep.begin_s = -sweep.begin_s;
  sweep.end_s = -sweep.end_s;
  sweep.turned_rad = -sweep.turned_rad;
  for (std::vector<PlacedFeature>* features : {&sweep.edges, &sweep.planes}) {
    std::reverse(features->begin(), features->end());
    for (PlacedFeature& feature : *features) feature.u = 1 - feature.u;
  }
  return sweep;
}

SweepPose reversed(SweepPose pose) {
  std::swap(pose.begin_s, pose.end_s);
  pose.begin_s = -pose.begin_s;
  pose.end_s = -pose.end_s;
  std::reverse(pose.knots.begin(), pose.knots.end());
  return pose;
}

namespace {

Vector6d find_first_twist_per_s(const std::vector<PlacedSweep>& sweeps, const MappingOptions& options) {
  Vector6d twist_per_s = Vector6d::Zero();
  for (int round = 0; round < options.velocity_rounds; ++round) {
    Tracker tracker(options);
    tracker.know(sweeps[0], steady_pose(sweeps[0], twist_per_s, options));
    Vector6d found = Vector6d::Zero();
    for (std::size_t i = 1; i < sweeps.size(); ++i) {
      const SweepPose pose = tracker.add(sweeps[i]);
      found += options.given ? deviation_twists_per_s(pose, 1, options.given.get(), 1).front()
                             : difference(pose.end(), pose.begin()) / (pose.end_s - pose.begin_s);
    }
    const Vector6d next = (twist_per_s + found / double(sweeps.size() - 1)) / 2;
    const bool settled = (next - twist_per_s).cwiseAbs().maxCoeff() < 0.01;
    twist_per_s = next;
    if (settled) break;
  }
  return twist_per_s;
}

struct LastPose {
  SweepPose pose;
  double matched_part;  // the least of the sweeps
};
LastPose track_once(const std::vector<PlacedSweep>& sweeps, const SweepPose& first,
                    const MappingOptions& options, double time_sign) {
  Tracker tracker(options, time_sign);
  tracker.know(sweeps[0], first);
  LastPose last{first, 1};
  for (std::size_t i = 1; i < sweeps.size(); ++i) {
    last.pose = tracker.add(sweeps[i]);
    last.matched_part = std::min(last.matched_part, tracker.last_count().matched_part());
  }
  return last;
}

}  // namespace

SweepPose find_first_pose(const std::vector<PlacedSweep>& sweeps, const MappingOptions& options) {
  if (sweeps.size() < 2) return steady_pose(sweeps[0], Vector6d::Zero(), options);
  std::vector<PlacedSweep> backwards;
  for (const PlacedSweep& sweep : sweeps) backwards.insert(backwards.begin(), reversed(sweep));
  SweepPose first = steady_pose(sweeps[0], find_first_twist_per_s(sweeps, options), options), best = first;
  double best_part = 0;
  for (int round = 0; round <= options.first_pose_rounds; ++round) {
    const LastPose there = track_once(sweeps, first, options, 1);
    if (there.matched_part > best_part) best = first, best_part = there.matched_part;
    if (best_part >= options.well_followed) break;
    first = reversed(track_once(backwards, reversed(there.pose), options, -1).pose);
  }
  return best;
}

}  // namespace sweepscope
