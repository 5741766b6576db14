#include "core/rig_solve/rig_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

// The encoder's angle by cubic interpolation, at mostly ascending times. Linear interpolation errs by up to
// 0.05 deg for a motor that follows a sine.
class SmoothAngle {
 public:
  explicit SmoothAngle(const MotorTrack& track) : track_(track) {}

  double at(double motor_s) {
    const auto& t = track_.time_s;
    while (next_ + 3 < t.size() && t[next_ + 1] <= motor_s) ++next_;
    while (next_ > 1 && t[next_] > motor_s) --next_;
    if (t.size() < 4) return track_.angle_at(std::clamp(motor_s, t.front(), t.back()));
    if (next_ != weighed_) weigh();
    const double a = motor_s - t[next_ - 1], b = motor_s - t[next_], c = motor_s - t[next_ + 1],
                 d = motor_s - t[next_ + 2];
    return a * b * (weights_[2] * d + weights_[3] * c) + c * d * (weights_[0] * b + weights_[1] * a);
  }

 private:
  // Lagrange's weights of the four samples about an instant: the angle of each, over the products of its
  // distances from the others.
  void weigh() {
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      const double t = track_.time_s[next_ - 1 + i];
      weights_[i] = track_.angle_rad[next_ - 1 + i];
      for (std::size_t j = 0; j < weights_.size(); ++j)
        if (j != i) weights_[i] /= t - track_.time_s[next_ - 1 + j];
    }
    weighed_ = next_;
  }

  const MotorTrack& track_;
  std::size_t next_ = 1, weighed_ = 0;  // 0: nothing yet
  std::array<double, 4> weights_{};
};

// Whether an instant is used. Play shows best where the motor is slow, so that all instants are used for it
// except those in which the gear is between its flanks.
bool counts(const Sweep& sweep, double motor_s, double turned_rad, const RigUnknowns& rig,
            bool near_reversals) {
  if (!near_reversals) return motor_s >= sweep.steady_begin_s && motor_s <= sweep.steady_end_s;
  constexpr double kBeyondPlay_rad = 0.2 * kRadPerDeg;  // two steps of the usual encoder
  return motor_s >= sweep.begin_s && motor_s <= sweep.end_s &&
         turned_rad > 1.2 * std::abs(rig.play_rad) + kBeyondPlay_rad;
}

}  // namespace

RigCloud place_with_rig(const OffsetProblem& problem, const RigUnknowns& rig,
                        const RigCloudOptions& options) {
  const Recording& recording = *problem.recording;
  const RigGeometry geometry(recording.rig.mount, rig);
  const std::vector<std::size_t> sweep_of =
      assign_sweeps(recording.scans, problem.motor.sweeps, rig.offset_s);
  const FeatureList& planes = problem.features->planes;
  MotorSpeedReader speed(recording.motor);
  SmoothAngle motor(recording.motor);
  const std::size_t stride = planes.features.size() / std::max<std::size_t>(1, options.max_points) + 1;
  RigCloud cloud;
  for (std::size_t scan = 0; scan < recording.scans.size(); ++scan) {
    if (!problem.scan_used[scan] || sweep_of[scan] == kNoSweep) continue;
    const Sweep& sweep = problem.motor.sweeps[sweep_of[scan]];
    const double begin_rad = recording.motor.angle_at(sweep.begin_s);
    for (std::size_t i = planes.scan_begin[scan]; i < planes.scan_begin[scan + 1]; i += stride) {
      const Feature& feature = planes.features[i];
      const double motor_s = feature.time_s + rig.offset_s;
      const double angle_rad = motor.at(motor_s);
      if (!counts(sweep, motor_s, std::abs(angle_rad - begin_rad), rig, options.near_reversals)) continue;
      cloud.placed.push_back(geometry.place(feature.p_in_motor_m.cast<double>(),
                                            {angle_rad, speed.speed_rad_s(motor_s), sweep.direction}));
      cloud.p_m.push_back(cloud.placed.back().p_in_base_m);
      cloud.angle_rad.push_back(angle_rad);
      cloud.feature.push_back(static_cast<std::uint32_t>(i));
    }
  }
  return cloud;
}

}  // namespace sweepscope
