#include "core/simulation/worlds/carrier.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sweepscope::simulation {
namespace {

constexpr std::uint64_t kMoodPurpose = 111;
constexpr double kStride_s = 0.01;

/// `value` towards `target`, by at most `step`.
double towards(double value, double target, double step) {
  return value + std::clamp(target - value, -step, step);
}

/// When the carrier rests, and how his speed changes.
class Mood {
 public:
  Mood(const WalkStyle& style, const Carriage& carriage)
      : size_(style.mood), rests_{{-1, carriage.begins_s}} {
    Draw draw(carriage.seed, kMoodPurpose);
    for (Wave& wave : waves_) wave = {2 * kPi * draw.in(0.03, 0.12), draw.in(0, 2 * kPi)};
    if (style.rests_hz <= 0) return;
    for (double t_s = carriage.begins_s + draw.in(0.3, 1.5) / style.rests_hz; t_s < carriage.duration_s;
         t_s += draw.in(0.5, 1.5) / style.rests_hz)
      rests_.push_back({t_s, t_s + draw.in(0.7, 3.5)});
  }
  /// The factor of the speed.
  double at(double t_s) const {
    for (const Rest& rest : rests_)
      if (t_s >= rest.from_s && t_s < rest.to_s) return 0;
    double factor = 1;
    for (const Wave& wave : waves_)
      factor -= size_ / 2 * (1 + sin_cos(wave.rate_radps * t_s + wave.phase_rad).sin) / 2;
    return factor;
  }

 private:
  struct Wave {
    double rate_radps, phase_rad;
  };
  struct Rest {
    double from_s, to_s;
  };
  double size_;
  std::vector<Rest> rests_;
  Wave waves_[2] = {};
};

class Carrier {
 public:
  Carrier(const std::vector<Vector3d>& way, const WalkStyle& style, const Carriage& carriage)
      : way_(way),
        top_turn_radps_(radians(style.heading_dps)),
        cruise_mps_(carriage.cruise_mps),
        mood_(style, carriage) {
    now_.foot_m = way.front();
    now_.forward = (way[std::min<std::size_t>(3, way.size() - 1)] - way[0]).head<2>().normalized();
    now_.speed_mps = carriage.begins_s > 0 ? 0 : carriage.cruise_mps * mood_.at(0);
  }
  const Stride& now() const { return now_; }

  void step() {
    constexpr double kGain_hz = 2, kTurning_radps2 = 1.5, kAcceleration_mps2 = 0.9;
    look_ahead();
    const Vector2d to = (way_[ahead_] - now_.foot_m).head<2>(),
                   aim = to.norm() > 1e-6 ? Vector2d(to.normalized()) : now_.forward;
    const double facing = now_.forward.dot(aim),
                 cross = now_.forward.x() * aim.y() - now_.forward.y() * aim.x();
    const double off = facing > 0 ? cross : (cross < 0 ? -1.0 : 1.0);
    const double mood = mood_.at(now_.t_s);
    const double wished_radps = mood > 0 ? std::clamp(kGain_hz * off, -1.0, 1.0) * top_turn_radps_ : 0;
    turn_radps_ = towards(turn_radps_, wished_radps, kTurning_radps2 * kStride_s);
    const double faced = std::max(0.0, facing);
    double wished_mps =
        std::min(mood * cruise_mps_, bend_limit_mps()) * std::max(0.12, faced * faced * faced);
    if (mood <= 0 || now_.arrived) wished_mps = 0;
    now_.speed_mps = towards(now_.speed_mps, wished_mps, kAcceleration_mps2 * kStride_s);
    const SinCos turn = sin_cos(turn_radps_ * kStride_s);
    const Vector2d f = now_.forward;
    now_.forward =
        Vector2d(turn.cos * f.x() - turn.sin * f.y(), turn.sin * f.x() + turn.cos * f.y()).normalized();
    now_.foot_m.head<2>() += now_.speed_mps * kStride_s * now_.forward;
    now_.foot_m.z() = floor_m();
    now_.t_s += kStride_s;
  }

 private:
  double flat_m(std::size_t i) const { return (way_[i] - now_.foot_m).head<2>().norm(); }

  void look_ahead() {
    const double reach_m = 0.5 + 0.4 * now_.speed_mps;
    while (ahead_ + 1 < way_.size() && flat_m(ahead_) < reach_m) ++ahead_;
    for (std::size_t i = near_ + 1; i <= ahead_; ++i)
      if (flat_m(i) <= flat_m(near_)) near_ = i;
    const double to_stop_m = now_.speed_mps * now_.speed_mps / 1.8 + 0.3;
    now_.arrived = now_.arrived || (ahead_ + 1 == way_.size() && flat_m(ahead_) < to_stop_m);
  }

  /// The speed at which the bends of the next steps can be walked.
  double bend_limit_mps() const {
    constexpr std::size_t kArm = 3, kAhead = 5;
    double limit_mps = 10;
    for (std::size_t i = near_; i < near_ + kAhead; ++i) {
      if (i < kArm || i + kArm >= way_.size()) continue;
      const Vector2d in = (way_[i] - way_[i - kArm]).head<2>(), out = (way_[i + kArm] - way_[i]).head<2>();
      const double size = in.norm() * out.norm();
      if (size < 1e-9) continue;
      const double sine = std::abs(in.x() * out.y() - in.y() * out.x()) / size;
      const double bend = in.dot(out) > 0 ? sine : 1.5;
      limit_mps = std::min(limit_mps, 0.8 * top_turn_radps_ * in.norm() / std::max(bend, 1e-6));
    }
    return std::max(limit_mps, 0.15);
  }

  /// Of the way beside the carrier.
  double floor_m() const {
    const Vector3d from = way_[near_], to = way_[std::min(near_ + 1, way_.size() - 1)];
    const Vector2d along = (to - from).head<2>();
    const double square = along.squaredNorm();
    const double u =
        square > 1e-9 ? std::clamp((now_.foot_m - from).head<2>().dot(along) / square, 0.0, 1.0) : 0;
    return from.z() + u * (to.z() - from.z());
  }

  const std::vector<Vector3d>& way_;
  double top_turn_radps_, cruise_mps_;
  Mood mood_;
  std::size_t ahead_ = 0, near_ = 0;
  double turn_radps_ = 0;
  Stride now_;
};

/// The floor's steps are taken evenly.
void smooth_floor(std::vector<Stride>& strides) {
  constexpr std::size_t kHalf = 30;  // of a window, in steps
  for (int round = 0; round < 2; ++round) {
    std::vector<double> sums{0};
    for (const Stride& stride : strides) sums.push_back(sums.back() + stride.foot_m.z());
    for (std::size_t i = 0; i < strides.size(); ++i) {
      const std::size_t from = i < kHalf ? 0 : i - kHalf, to = std::min(strides.size(), i + kHalf + 1);
      strides[i].foot_m.z() = (sums[to] - sums[from]) / static_cast<double>(to - from);
    }
  }
}

}  // namespace

std::vector<Stride> walk_along(const std::vector<Vector3d>& way, const WalkStyle& style,
                               const Carriage& carriage) {
  Carrier carrier(way, style, carriage);
  std::vector<Stride> strides{carrier.now()};
  const auto steps = static_cast<int>(std::ceil(carriage.duration_s / kStride_s - 1e-9));
  for (int i = 1; i <= steps; ++i) {
    carrier.step();
    strides.push_back(carrier.now());
    strides.back().t_s = std::min(i * kStride_s, carriage.duration_s);
  }
  smooth_floor(strides);
  return strides;
}

}  // namespace sweepscope::simulation
