#include "core/simulation/motion/plan_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sweepscope::simulation {
namespace {

constexpr int kParts = 64;

/// The spline's slopes at its knots: those that make the second derivative continuous, by relaxation (the
/// system is diagonally dominant; it gains more than a bit per round).
std::vector<Vector2d> slopes_at(const std::vector<Vector2d>& knots, bool closed) {
  const std::size_t n = knots.size();
  std::vector<Vector2d> slopes(n, Vector2d::Zero());
  for (int round = 0; round < 80; ++round) {
    for (std::size_t i = 0; i < n; ++i) {
      const bool first = i == 0, last = i + 1 == n;
      if (first && !closed) {
        slopes[i] = (3 * (knots[1] - knots[0]) - slopes[1]) / 2;
      } else if (last && !closed) {
        slopes[i] = (3 * (knots[i] - knots[i - 1]) - slopes[i - 1]) / 2;
      } else {
        const std::size_t before = first ? n - 1 : i - 1, after = last ? 0 : i + 1;
        slopes[i] = (3 * (knots[after] - knots[before]) - slopes[before] - slopes[after]) / 4;
      }
    }
  }
  return slopes;
}

}  // namespace

PlanCurve::PlanCurve(const std::vector<Vector2d>& waypoints_m, bool closed) {
  const std::vector<Vector2d> slopes = slopes_at(waypoints_m, closed);
  const std::size_t n = waypoints_m.size();
  for (std::size_t i = 0; i + (closed ? 0 : 1) < n; ++i) {
    const std::size_t j = (i + 1) % n;
    const Vector2d step = waypoints_m[j] - waypoints_m[i];
    spans_.push_back(
        {waypoints_m[i], slopes[i], 3 * step - 2 * slopes[i] - slopes[j], slopes[i] + slopes[j] - 2 * step});
  }
  const auto speed = [&](double u) {
    const std::size_t i = std::min(static_cast<std::size_t>(u), spans_.size() - 1);
    const double v = u - static_cast<double>(i);
    return (spans_[i].c1 + v * (2 * spans_[i].c2 + 3 * v * spans_[i].c3)).norm();
  };
  distance_m_.push_back(0);
  per_unit_m_.push_back(speed(0));
  for (std::size_t part = 1; part <= spans_.size() * kParts; ++part) {
    const double to = static_cast<double>(part) / kParts;
    per_unit_m_.push_back(speed(to));
    const double simpson = per_unit_m_[part - 1] + 4 * speed(to - 0.5 / kParts) + per_unit_m_[part];
    distance_m_.push_back(distance_m_.back() + simpson / (6 * kParts));
  }
}

PlanCurve::Point PlanCurve::on_spline(double u) const {
  const std::size_t i = std::min(static_cast<std::size_t>(std::max(u, 0.0)), spans_.size() - 1);
  const Span& s = spans_[i];
  const double v = u - static_cast<double>(i);
  const Vector2d slope = s.c1 + v * (2 * s.c2 + 3 * v * s.c3);
  const Vector2d bend = 2 * s.c2 + 6 * v * s.c3;
  const double speed = slope.norm();
  return {s.c0 + v * (s.c1 + v * (s.c2 + v * s.c3)), slope / speed,
          (slope.x() * bend.y() - slope.y() * bend.x()) / (speed * speed * speed)};
}

PlanCurve::Point PlanCurve::at(double distance_m) const {
  const double wanted_m = std::clamp(distance_m, 0.0, length_m());
  const auto above = std::upper_bound(distance_m_.begin() + 1, distance_m_.end() - 1, wanted_m);
  const auto i = static_cast<std::size_t>(above - distance_m_.begin());
  // The inverse of the distance, a cubic with the right slopes at both ends of the part.
  const double step_m = distance_m_[i] - distance_m_[i - 1];
  const double w = (wanted_m - distance_m_[i - 1]) / step_m;
  const double begin = step_m * kParts / per_unit_m_[i - 1], end = step_m * kParts / per_unit_m_[i];
  const double part = w * (begin + w * (3 - 2 * begin - end + w * (begin + end - 2)));
  return on_spline((static_cast<double>(i - 1) + part) / kParts);
}

}  // namespace sweepscope::simulation
