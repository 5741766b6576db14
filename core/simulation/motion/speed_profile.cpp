#include "core/simulation/motion/speed_profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "core/simulation/math/portable_math.hpp"

namespace sweepscope::simulation {
namespace {

constexpr double kStep_m = 0.05;
constexpr double kStep_s = 0.02;
constexpr int kHalfWindow = 25;  // of the smoothing, in steps of time: 1 s in all
constexpr double kAcceleration_mps2 = 0.7;
constexpr double kHurry_m = 6.0;  // half the stretch that is hurried along

struct Plan {
  std::vector<double> bend_per_m;  // |curvature| every kStep_m
  double step_m = 0, hurry_at_m = 0;
};

Plan plan_of(const PlanCurve& curve) {
  Plan plan;
  const auto parts = static_cast<std::size_t>(std::ceil(curve.length_m() / kStep_m));
  plan.step_m = curve.length_m() / static_cast<double>(parts);
  for (std::size_t i = 0; i <= parts; ++i)
    plan.bend_per_m.push_back(std::abs(curve.at(static_cast<double>(i) * plan.step_m).curvature_per_m));
  const auto reach = static_cast<std::size_t>(kHurry_m / plan.step_m);
  double least = 1e9;
  for (std::size_t i = 2 * reach; i + 2 * reach < parts; ++i) {
    const double worst = *std::max_element(plan.bend_per_m.begin() + static_cast<std::ptrdiff_t>(i - reach),
                                           plan.bend_per_m.begin() + static_cast<std::ptrdiff_t>(i + reach));
    if (worst >= least) continue;
    least = worst;
    plan.hurry_at_m = static_cast<double>(i) * plan.step_m;
  }
  return plan;
}

/// Speeds at the plan's steps when walking at about cruise_mps.
std::vector<double> speeds(const Plan& plan, const SpeedProfile::Limits& limits, double cruise_mps) {
  std::vector<double> v(plan.bend_per_m.size());
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double s_m = static_cast<double>(i) * plan.step_m;
    const double mood = 1 + 0.12 * sin_cos(2 * kPi * s_m / 17).sin;
    const double hurry = smooth_step(1.5 * (1 - std::abs(s_m - plan.hurry_at_m) / kHurry_m));
    const double wished = std::min(cruise_mps * mood, limits.top_speed_mps);
    v[i] = std::min(wished + hurry * (limits.top_speed_mps - wished),
                    limits.top_turn_rate_radps / std::max(plan.bend_per_m[i], 1e-6));
  }
  const double gain = 2 * kAcceleration_mps2 * plan.step_m;
  v.front() = v.back() = 0;
  for (std::size_t i = 1; i < v.size(); ++i) v[i] = std::min(v[i], std::sqrt(v[i - 1] * v[i - 1] + gain));
  for (std::size_t i = v.size() - 1; i-- > 0;) v[i] = std::min(v[i], std::sqrt(v[i + 1] * v[i + 1] + gain));
  return v;
}

double duration_of(const std::vector<double>& v, double step_m) {
  double t_s = 0;
  for (std::size_t i = 1; i < v.size(); ++i) t_s += 2 * step_m / (v[i - 1] + v[i]);
  return t_s;
}

/// The cruising speed at which the plan takes duration_s.
std::vector<double> speeds_for(const Plan& plan, const SpeedProfile::Limits& limits, double duration_s) {
  double slow = 0.05, fast = limits.top_speed_mps;
  if (duration_of(speeds(plan, limits, fast), plan.step_m) > duration_s)
    throw std::invalid_argument("a walk is too long for its duration and its tops");
  for (int round = 0; round < 50; ++round) {
    const double middle = (slow + fast) / 2;
    (duration_of(speeds(plan, limits, middle), plan.step_m) > duration_s ? slow : fast) = middle;
  }
  return speeds(plan, limits, (slow + fast) / 2);
}

/// Speeds every kStep_s; between the plan's steps the acceleration is constant.
std::vector<double> over_time(const std::vector<double>& v, double step_m, std::size_t samples) {
  std::vector<double> sampled(samples, 0.0);
  double from_s = 0;
  std::size_t next = 0;
  for (std::size_t i = 1; i < v.size(); ++i) {
    const double took_s = 2 * step_m / (v[i - 1] + v[i]);
    for (; next < samples && static_cast<double>(next) * kStep_s <= from_s + took_s; ++next)
      sampled[next] = v[i - 1] + (v[i] - v[i - 1]) * (static_cast<double>(next) * kStep_s - from_s) / took_s;
    from_s += took_s;
  }
  return sampled;
}

/// A moving average with a raised cosine of 2 * kHalfWindow + 1 steps; begins half a window earlier than `v`.
std::vector<double> smoothed(const std::vector<double>& v) {
  std::vector<double> weights;
  for (int k = -kHalfWindow; k <= kHalfWindow; ++k)
    weights.push_back((1 + sin_cos(kPi * k / (kHalfWindow + 1)).cos) / (2 * (kHalfWindow + 1)));
  std::vector<double> result(v.size() + weights.size() - 1, 0.0);
  for (std::size_t i = 0; i < v.size(); ++i)
    for (std::size_t k = 0; k < weights.size(); ++k) result[i + k] += weights[k] * v[i];
  return result;
}

}  // namespace

SpeedProfile::SpeedProfile(const PlanCurve& curve, const Limits& limits) {
  const Plan plan = plan_of(curve);
  const double brisk_s = limits.duration_s - 2 * kHalfWindow * kStep_s;
  const auto samples = static_cast<std::size_t>(std::ceil(brisk_s / kStep_s)) + 1;
  speed_mps_ = smoothed(over_time(speeds_for(plan, limits, brisk_s), plan.step_m, samples));
  distance_m_.assign(1, 0.0);
  for (std::size_t i = 1; i < speed_mps_.size(); ++i)
    distance_m_.push_back(distance_m_.back() + kStep_s / 2 * (speed_mps_[i - 1] + speed_mps_[i]));
  const double stretch = curve.length_m() / distance_m_.back();
  for (double& v : speed_mps_) v *= stretch;
  for (double& s : distance_m_) s *= stretch;
}

SpeedProfile::Progress SpeedProfile::at(double t_s) const {
  if (t_s <= 0) return {0, 0};
  const double steps = t_s / kStep_s;
  const auto i = static_cast<std::size_t>(steps);
  if (i + 1 >= speed_mps_.size()) return {distance_m_.back(), 0};
  const double u = steps - static_cast<double>(i);
  const double gain = speed_mps_[i + 1] - speed_mps_[i];
  return {distance_m_[i] + kStep_s * u * (speed_mps_[i] + u * gain / 2), speed_mps_[i] + u * gain};
}

}  // namespace sweepscope::simulation
