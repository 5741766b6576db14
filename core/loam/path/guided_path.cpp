#include "core/loam/path/guided_path.hpp"

#include <algorithm>
#include <cmath>

#include "core/loam/path/path_equations.hpp"

namespace sweepscope {
namespace {

// Ten samples a scan at 40 Hz: linear between them, at 30 rad/s^2, to 0.02 mrad. The margin is for time
// shifts and places beside the path.
constexpr double kSample_s = 0.0025, kMargin_s = 0.1;

double time_of(const SweepPose& sweep, std::size_t knot) {
  const double u = double(knot) / double(sweep.knots.size() - 1);
  return sweep.begin_s + u * (sweep.end_s - sweep.begin_s);
}

}  // namespace

GuidedPath::GuidedPath(const std::vector<SweepPose>& sweeps, double knot_s, const GivenMotion* given)
    : begin_s_(sweeps.front().begin_s), end_s_(sweeps.back().end_s) {
  if (given != nullptr && given->covers(begin_s_, end_s_)) {
    given_ = *given;
    uses_translation_ = given->has_translation();
    const SweepPose& middle = sweeps[sweeps.size() / 2];
    map_from_world_ = middle.begin() * given->at(middle.begin_s).inverse();
    sample();
    if (given->is_truth()) return;
    choose_parts(sweeps);
  }
  deviation_ = SmoothPath(given_ ? deviations(sweeps) : sweeps, knot_s);
}

// A part of the given motion from which the sweeps deviate less smoothly than they move would spoil them.
void GuidedPath::choose_parts(const std::vector<SweepPose>& sweeps) {
  constexpr std::size_t kPartsOfSweep = 2;  // as jerk_sigma
  const Eigen::Vector2d of_deviation = jerk(deviations(sweeps), kPartsOfSweep);
  const Eigen::Vector2d of_path = jerk(sweeps, kPartsOfSweep);
  uses_rotation_ = of_deviation[0] < of_path[0];
  uses_translation_ = uses_translation_ && of_deviation[1] < of_path[1];
  if (uses_rotation_ || uses_translation_)
    sample();
  else
    given_.reset();
}

void GuidedPath::sample() {
  const auto steps = std::size_t(std::ceil((end_s_ - begin_s_ + 2 * kMargin_s) / kSample_s));
  samples_.clear();
  for (std::size_t i = 0; i <= steps; ++i) {
    Pose pose = map_from_world_ * given_->at(begin_s_ - kMargin_s + double(i) * kSample_s);
    if (!uses_rotation_) pose.rotation.setIdentity();
    if (!uses_translation_) pose.translation_m.setZero();
    samples_.push_back(pose);
  }
}

Pose GuidedPath::given_at(double time_s) const {
  const double place = (time_s - begin_s_ + kMargin_s) / kSample_s;
  const auto i = std::size_t(std::clamp(std::floor(place), 0.0, double(samples_.size() - 2)));
  return interpolate(samples_[i], samples_[i + 1], place - double(i));
}

Pose GuidedPath::at(double time_s) const {
  if (!given_) return deviation_->at(time_s);
  const Pose given = given_at(time_s);
  if (!deviation_) return given;
  const Pose deviation = deviation_->at(time_s);
  return {deviation.rotation * given.rotation, deviation.translation_m + given.translation_m};
}

SweepPose GuidedPath::as_sweep(SweepPose sweep) const {
  if (!given_) return deviation_->as_sweep(std::move(sweep));
  constexpr double kStep_s = 0.025;  // a scan at 40 Hz
  const auto steps =
      std::max<std::size_t>(1, std::size_t(std::lround((sweep.end_s - sweep.begin_s) / kStep_s)));
  sweep.knots.resize(steps + 1);
  for (std::size_t i = 0; i <= steps; ++i) sweep.knots[i] = at(time_of(sweep, i));
  return sweep;
}

std::vector<SweepPose> GuidedPath::deviations(std::vector<SweepPose> sweeps) const {
  if (!given_) return sweeps;
  for (SweepPose& sweep : sweeps)
    for (std::size_t i = 0; i < sweep.knots.size(); ++i) {
      const Pose given = given_at(time_of(sweep, i));
      Pose& knot = sweep.knots[i];
      knot = {knot.rotation * given.rotation.conjugate(), knot.translation_m - given.translation_m};
    }
  return sweeps;
}

GuidedPath::Place GuidedPath::place(double time_s) const {
  Place place{{0, {0, 0, 0, 0}}, Vector6d::Zero()};
  if (deviation_) place.knots = deviation_->place(time_s);
  if (!given_) return place;
  const Vector6d twist_per_s =
      difference(given_at(time_s + kSample_s), given_at(time_s - kSample_s)) / (2 * kSample_s);
  const Eigen::Quaterniond turn =
      deviation_ ? deviation_->at(time_s).rotation : Eigen::Quaterniond::Identity();
  place.per_shift_second << -(turn * twist_per_s.head<3>()), -twist_per_s.tail<3>();
  return place;
}

void GuidedPath::move(const std::vector<Vector6d>& steps) {
  if (deviation_) deviation_->move({steps.begin(), steps.begin() + std::ptrdiff_t(knots())});
  if (!given_) return;
  constexpr double kLongestStep_s = 0.02;  // over which the path goes about linearly
  const double step_s = std::clamp(steps[knots()][0], -kLongestStep_s, kLongestStep_s);
  given_ = given_->with_time_shift(given_->time_shift_s() + step_s);
  sample();
}

}  // namespace sweepscope
