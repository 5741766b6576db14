#include "core/loam/path/smooth_path.hpp"

#include <algorithm>
#include <cmath>

#include "core/loam/path/least_squares.hpp"
#include "core/loam/path/path_equations.hpp"

namespace sweepscope {
namespace {

Pose moved(const Pose& pose, const Vector6d& step) {
  return stepped(pose, step, pose.translation_m);
}

// Of a uniform cubic B-spline, at u in its segment: 0 to 1.
std::array<double, 4> basis(double u) {
  const double v = 1 - u;
  return {v * v * v / 6, (3 * u * u * u - 6 * u * u + 4) / 6, (3 * v * v * v - 6 * v * v + 4) / 6,
          u * u * u / 6};
}

// Tracked sweeps one after the other; where two do not meet, both are led to the middle.
class TrackedPath {
 public:
  explicit TrackedPath(const std::vector<SweepPose>& sweeps) : sweeps_(sweeps) {}

  Pose at(double time_s) const {
    const auto next =
        std::upper_bound(sweeps_.begin() + 1, sweeps_.end(), time_s,
                         [](double t_s, const SweepPose& sweep) { return t_s < sweep.begin_s; });
    const SweepPose& sweep = *(next - 1);
    const double u = (time_s - sweep.begin_s) / (sweep.end_s - sweep.begin_s);
    Vector6d step = Vector6d::Zero();
    if (next - 1 != sweeps_.begin()) step += (1 - u) / 2 * difference((next - 2)->end(), sweep.begin());
    if (next != sweeps_.end()) step += u / 2 * difference(next->begin(), sweep.end());
    return moved(sweep.at(u), step);
  }

 private:
  const std::vector<SweepPose>& sweeps_;
};

}  // namespace

SmoothPath::SmoothPath(const std::vector<SweepPose>& sweeps, double knot_s)
    : begin_s_(sweeps.front().begin_s),
      knot_s_(knot_s),
      segments_(std::max<std::size_t>(1, std::size_t(std::ceil((sweeps.back().end_s - begin_s_) / knot_s)))) {
  const TrackedPath tracked(sweeps);
  std::vector<Pose> wanted;
  for (std::size_t i = 0; i < segments_ + 3; ++i)
    wanted.push_back(tracked.at(begin_s_ + (double(i) - 1) * knot_s));
  knots_ = wanted;
  sample();
  // A spline passes its knots by on the inside: a few rounds bring it near what they were taken from.
  for (int round = 0; round < 3; ++round) {
    std::vector<Vector6d> steps;
    for (std::size_t i = 0; i < knots_.size(); ++i)
      steps.push_back(difference(wanted[i], at(begin_s_ + (double(i) - 1) * knot_s)));
    move(steps);
  }
}

Pose SmoothPath::at(double time_s) const {
  const double place = (time_s - begin_s_) / knot_s_ * kPosesPerKnot;
  const auto i = std::size_t(std::clamp(std::floor(place), 0.0, double(poses_.size() - 2)));
  return interpolate(poses_[i], poses_[i + 1], place - double(i));
}

SmoothPath::Place SmoothPath::place(double time_s) const {
  const double place = (time_s - begin_s_) / knot_s_;
  const auto segment = std::size_t(std::clamp(std::floor(place), 0.0, double(segments_ - 1)));
  return {segment, basis(std::clamp(place - double(segment), 0.0, 1.0))};
}

void SmoothPath::move(const std::vector<Vector6d>& knot_steps) {
  for (std::size_t i = 0; i < knots_.size(); ++i) knots_[i] = moved(knots_[i], knot_steps[i]);
  sample();
}

void SmoothPath::sample() {
  poses_.clear();
  poses_.reserve(segments_ * kPosesPerKnot + 1);
  for (std::size_t i = 0; i <= segments_ * kPosesPerKnot; ++i) {
    const std::size_t segment = std::min(i / kPosesPerKnot, segments_ - 1);
    const auto w = basis(double(i - segment * kPosesPerKnot) / kPosesPerKnot);
    const Pose* knot = &knots_[segment];
    Pose pose{knot[0].rotation, w[0] * knot[0].translation_m};
    double rest = 1;
    for (std::size_t k = 1; k < 4; ++k) {
      rest -= w[k - 1];
      const Eigen::Vector3d turn_rad = turn_between(knot[k - 1].rotation, knot[k].rotation);
      pose.rotation = pose.rotation * rotation_from_vector(rest * turn_rad);
      pose.translation_m += w[k] * knot[k].translation_m;
    }
    pose.rotation.normalize();
    poses_.push_back(pose);
  }
}

SweepPose SmoothPath::as_sweep(SweepPose sweep) const {
  constexpr double kStep_s = 0.025;  // a scan at 40 Hz
  const double duration_s = sweep.end_s - sweep.begin_s;
  const auto steps = std::max<std::size_t>(1, std::size_t(std::lround(duration_s / kStep_s)));
  sweep.knots.clear();
  for (std::size_t i = 0; i <= steps; ++i)
    sweep.knots.push_back(at(sweep.begin_s + double(i) / double(steps) * duration_s));
  return sweep;
}

}  // namespace sweepscope
