#include "core/loam/path/given_motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/loam/path/path_equations.hpp"
#include "core/numbers.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// A walking body sways at about 1 Hz, and over a quarter of a period a cubic follows it. Where all poses come
// slower than that, two may be missing.
constexpr double kLongestBridgedGap_s = 0.25, kLongestGapInSpacings = 3;

double longest_gap_s(const std::vector<StampedPose>& poses) {
  return std::max(kLongestBridgedGap_s,
                  kLongestGapInSpacings * median(spacings(poses, &StampedPose::time_s)));
}

Vector3d turn_rad(const StampedPose& from, const StampedPose& to) {
  return turn_between(from.orientation, to.orientation);
}

// The derivative at the middle of three values, from the steps before and after it.
Vector3d central(const Vector3d& before, double before_s, const Vector3d& after, double after_s) {
  return (before / before_s * after_s + after / after_s * before_s) / (before_s + after_s);
}

// A cubic from 0 to `change`, by its derivatives at both ends.
Vector3d hermite(const Vector3d& change, const Vector3d& slope_begin, const Vector3d& slope_end, double u) {
  const double u2 = u * u, u3 = u2 * u;
  return (3 * u2 - 2 * u3) * change + (u3 - 2 * u2 + u) * slope_begin + (u3 - u2) * slope_end;
}

// Of the rotation vector `turn_rad` by a rate at its end, in the frame that it turns to: the inverse of
// SO(3)'s right Jacobian, to the first order, since neighbouring poses lie close.
Vector3d vector_rate(const Vector3d& turn_rad, const Vector3d& rate_rad_s) {
  return rate_rad_s + turn_rad.cross(rate_rad_s) / 2;
}

}  // namespace

GivenMotion::GivenMotion(std::vector<StampedPose> poses, Parts parts, Role role)
    : parts_(parts), role_(role) {
  auto data = std::make_shared<Data>();
  data->poses = std::move(poses);
  const auto& p = data->poses;
  const std::size_t n = p.size();
  const double gap_s = longest_gap_s(p);
  data->covered_until.resize(n);
  data->rates_rad_s.resize(n);
  data->velocities_m_s.resize(n);
  const auto joined = [&](std::size_t i) { return p[i + 1].time_s - p[i].time_s <= gap_s; };
  for (std::size_t i = n; i-- > 0;)
    data->covered_until[i] = i + 1 < n && joined(i) ? data->covered_until[i + 1] : i;
  for (std::size_t i = 0; i < n; ++i) {
    // At an end, and beside a gap, from the one side alone.
    const std::size_t a = i > 0 && (joined(i - 1) || i + 1 == n) ? i - 1 : i;
    const std::size_t b = i + 1 < n && (joined(i) || a == i) ? i + 1 : i;
    const double before_s = p[i].time_s - p[a].time_s, after_s = p[b].time_s - p[i].time_s;
    if (a < i && i < b) {
      data->rates_rad_s[i] = central(turn_rad(p[a], p[i]), before_s, turn_rad(p[i], p[b]), after_s);
      data->velocities_m_s[i] =
          central(p[i].position_m - p[a].position_m, before_s, p[b].position_m - p[i].position_m, after_s);
    } else {
      data->rates_rad_s[i] = turn_rad(p[a], p[b]) / (before_s + after_s);
      data->velocities_m_s[i] = (p[b].position_m - p[a].position_m) / (before_s + after_s);
    }
  }
  data_ = std::move(data);
}

GivenMotion GivenMotion::from_rates(const std::vector<double>& times_s,
                                    const std::vector<Vector3d>& rates_rad_s) {
  std::vector<StampedPose> poses{{times_s.front(), Vector3d::Zero(), Eigen::Quaterniond::Identity()}};
  for (std::size_t i = 1; i < times_s.size(); ++i) {
    const double step_s = times_s[i] - times_s[i - 1];
    const Vector3d turn_rad = step_s / 2 * (rates_rad_s[i - 1] + rates_rad_s[i]);
    poses.push_back({times_s[i], Vector3d::Zero(),
                     (poses.back().orientation * rotation_from_vector(turn_rad)).normalized()});
  }
  return GivenMotion(std::move(poses), Parts::kRotation, Role::kPrior);
}

GivenMotion GivenMotion::with_time_shift(double time_shift_s) const {
  GivenMotion shifted = *this;
  shifted.time_shift_s_ = time_shift_s;
  return shifted;
}

GivenMotion GivenMotion::as_prior() const {
  GivenMotion prior = *this;
  prior.role_ = Role::kPrior;
  return prior;
}

bool GivenMotion::covers(double from_s, double to_s) const {
  const auto& poses = data_->poses;
  const double own_s = from_s - time_shift_s_;
  const auto after = std::upper_bound(poses.begin(), poses.end(), own_s,
                                      [](double t_s, const StampedPose& pose) { return t_s < pose.time_s; });
  if (after == poses.begin()) return false;
  return to_s - time_shift_s_ <= poses[data_->covered_until[std::size_t(after - poses.begin()) - 1]].time_s;
}

Pose GivenMotion::at(double time_s) const {
  const auto& poses = data_->poses;
  const double own_s = std::clamp(time_s - time_shift_s_, poses.front().time_s, poses.back().time_s);
  const auto after = std::upper_bound(poses.begin() + 1, poses.end() - 1, own_s,
                                      [](double t_s, const StampedPose& pose) { return t_s < pose.time_s; });
  const auto b = std::size_t(after - poses.begin()), a = b - 1;
  const double step_s = poses[b].time_s - poses[a].time_s, u = (own_s - poses[a].time_s) / step_s;
  const Vector3d turned_rad = turn_rad(poses[a], poses[b]);
  const Vector3d part_rad = hermite(turned_rad, step_s * data_->rates_rad_s[a],
                                    step_s * vector_rate(turned_rad, data_->rates_rad_s[b]), u);
  Pose pose{(poses[a].orientation * rotation_from_vector(part_rad)).normalized(), Vector3d::Zero()};
  if (has_translation())
    pose.translation_m = poses[a].position_m + hermite(poses[b].position_m - poses[a].position_m,
                                                       step_s * data_->velocities_m_s[a],
                                                       step_s * data_->velocities_m_s[b], u);
  return pose;
}

std::vector<Vector6d> deviation_twists_per_s(const SweepPose& pose, std::size_t parts,
                                             const GivenMotion* given, double time_sign) {
  const double first_s = std::min(time_sign * pose.begin_s, time_sign * pose.end_s);
  const double last_s = std::max(time_sign * pose.begin_s, time_sign * pose.end_s);
  if (given == nullptr || !given->covers(first_s, last_s)) return twists_per_s(pose, parts);
  const double n = double(parts), part_s = (pose.end_s - pose.begin_s) / n;
  std::vector<Vector6d> twists;
  for (std::size_t i = 0; i < parts; ++i) {
    const double from_s = pose.begin_s + double(i) * part_s;
    const Pose expected =
        pose.at(double(i) / n) * given->move(time_sign * from_s, time_sign * (from_s + part_s));
    twists.push_back(difference(pose.at(double(i + 1) / n), expected) / part_s);
  }
  return twists;
}

std::vector<std::vector<SweepPose>> tracked_runs(const std::vector<SweepPose>& sweeps,
                                                 const GivenMotion* given) {
  const auto covered = [&](const SweepPose& sweep) {
    return given != nullptr && given->covers(sweep.begin_s, sweep.end_s);
  };
  std::vector<std::vector<SweepPose>> runs;
  const SweepPose* last = nullptr;  // of the run
  for (const SweepPose& sweep : sweeps) {
    if (sweep.lost) {
      last = nullptr;
      continue;
    }
    if (last == nullptr || sweep.stretch != last->stretch || covered(sweep) != covered(*last))
      runs.emplace_back();
    runs.back().push_back(sweep);
    last = &sweep;
  }
  return runs;
}

SweepPose along(const GivenMotion& given, SweepPose sweep, const Pose& start, double start_s, double knot_s) {
  const Pose map_from_world = start * given.at(start_s).inverse();
  const double duration_s = sweep.end_s - sweep.begin_s;
  const auto steps = std::max<std::size_t>(1, std::size_t(std::lround(duration_s / knot_s)));
  sweep.knots.clear();
  for (std::size_t i = 0; i <= steps; ++i)
    sweep.knots.push_back(map_from_world * given.at(sweep.begin_s + double(i) / double(steps) * duration_s));
  return sweep;
}

}  // namespace sweepscope
