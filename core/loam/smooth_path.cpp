#include "core/loam/smooth_path.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope {
namespace {

Vector6d difference(const Pose& to, const Pose& from) {
  Vector6d d;
  d << vector_from_rotation(to.rotation * from.rotation.conjugate()), to.translation_m - from.translation_m;
  return d;
}

Pose moved(const Pose& pose, const Vector6d& step) {
  return stepped(pose, step, pose.translation_m);
}

}  // namespace

SmoothPath::SmoothPath(const std::vector<SweepPose>& sweeps, double knot_s)
    : begin_s_(sweeps.front().begin_s),
      pose_s_(knot_s / kPosesPerKnot),
      knots_(std::size_t(std::ceil((sweeps.back().end_s - begin_s_) / knot_s)) + 1) {
  knots_ = std::max<std::size_t>(2, knots_);
  poses_.reserve((knots_ - 1) * kPosesPerKnot + 1);
  std::size_t k = 0;
  for (std::size_t i = 0; i <= (knots_ - 1) * kPosesPerKnot; ++i) {
    const double time_s = begin_s_ + double(i) * pose_s_;
    while (k + 1 < sweeps.size() && sweeps[k + 1].begin_s <= time_s) ++k;
    const SweepPose& sweep = sweeps[k];
    const double u = (time_s - sweep.begin_s) / (sweep.end_s - sweep.begin_s);
    Vector6d step = Vector6d::Zero();
    if (k > 0) step += (1 - u) / 2 * difference(sweeps[k - 1].end, sweep.begin);
    if (k + 1 < sweeps.size()) step += u / 2 * difference(sweeps[k + 1].begin, sweep.end);
    poses_.push_back(moved(sweep.at(u), step));
  }
}

Pose SmoothPath::at(double time_s) const {
  const double place = (time_s - begin_s_) / pose_s_;
  const auto i = std::size_t(std::clamp(std::floor(place), 0.0, double(poses_.size() - 2)));
  return interpolate(poses_[i], poses_[i + 1], place - double(i));
}

SmoothPath::Place SmoothPath::place(double time_s) const {
  const double knot = (time_s - begin_s_) / (pose_s_ * kPosesPerKnot);
  const auto i = std::size_t(std::clamp(std::floor(knot), 0.0, double(knots_ - 2)));
  return {i, std::clamp(knot - double(i), 0.0, 1.0)};
}

void SmoothPath::move(const std::vector<Vector6d>& knot_steps) {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const std::size_t knot = std::min(i / kPosesPerKnot, knots_ - 2);
    const double u = double(i - knot * kPosesPerKnot) / kPosesPerKnot;
    poses_[i] = moved(poses_[i], (1 - u) * knot_steps[knot] + u * knot_steps[knot + 1]);
  }
}

SweepPose SmoothPath::as_sweep(SweepPose sweep) const {
  sweep.begin = at(sweep.begin_s);
  sweep.end = at(sweep.end_s);
  const Pose straight = interpolate(sweep.begin, sweep.end, 0.5);
  const Pose middle = at((sweep.begin_s + sweep.end_s) / 2);
  sweep.bend.head<3>() = vector_from_rotation(middle.rotation * straight.rotation.conjugate());
  sweep.bend.tail<3>() =
      middle.translation_m - straight.translation_m -
      (rotation_from_vector(sweep.bend.head<3>()) * (straight.translation_m - sweep.pivot_m()) -
       (straight.translation_m - sweep.pivot_m()));
  return sweep;
}

}  // namespace sweepscope
