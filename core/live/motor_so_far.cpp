#include "core/live/motor_so_far.hpp"

#include <algorithm>
#include <limits>

namespace sweepscope {
namespace {

// A reversal is seen by so much of the range, and more than an encoder's steps and jitter. find_sweeps waits
// for a twentieth, 20 ms longer.
constexpr double kTurnsBack = 1.0 / 90, kMinTurn_rad = 0.0087;

// How far the motor is from the farthest that it came in a sweep.
double turned_back_rad(const MotorTrack& track, const Sweep& sweep) {
  double farthest_rad = -std::numeric_limits<double>::infinity();
  for (std::size_t i = track.time_s.size(); i-- > 0 && track.time_s[i] >= sweep.begin_s;)
    farthest_rad = std::max(farthest_rad, sweep.direction * track.angle_rad[i]);
  return farthest_rad - sweep.direction * track.angle_rad.back();
}

}  // namespace

std::span<const Sweep> MotorSoFar::ended(bool all) const {
  const std::span<const Sweep> sweeps(motion.sweeps);
  return all || last_ended || sweeps.empty() ? sweeps : sweeps.first(sweeps.size() - 1);
}

double MotorSoFar::rested_s(double now_s) const {
  if (motion.sweeps.empty()) return end_s - begin_s;
  return last_ended ? std::min(now_s, end_s) - motion.sweeps.back().end_s : 0;
}

double MotorSoFar::begin_s_after(double time_s, double otherwise_s) const {
  for (const Sweep& sweep : motion.sweeps)
    if (sweep.end_s > time_s) return std::min(sweep.begin_s, otherwise_s);
  return otherwise_s;
}

double MotorSoFar::needed_from_s(double placed_s, double now_s) const {
  // More than two turns show that a motor turns one way; its range and the way of a sweep show by two sweeps.
  const std::size_t before = motion.one_way() ? 8 : 3;
  const auto& sweeps = motion.sweeps;
  if (sweeps.empty()) return begin_s;
  if (rested_s(now_s) > 5 + 3 * motion.median_sweep_s) return now_s - 5;
  std::size_t next = 0;
  while (next < sweeps.size() && sweeps[next].end_s <= placed_s) ++next;
  return sweeps[next > before ? next - before : 0].begin_s;
}

MotorSoFar motor_so_far(const MotorTrack& track) {
  MotorSoFar so_far;
  if (track.time_s.empty()) return so_far;
  so_far.begin_s = track.time_s.front();
  so_far.end_s = track.time_s.back();
  so_far.motion = find_sweeps(track);
  const auto& sweeps = so_far.motion.sweeps;
  if (sweeps.empty() || so_far.motion.one_way()) return so_far;
  const Sweep last = sweeps.back();
  so_far.last_ended = so_far.end_s - last.end_s > last.end_s - last.begin_s;
  if (so_far.last_ended || sweeps.size() < 2) return so_far;
  const auto [min, max] = std::ranges::minmax(track.angle_rad);
  const double angle_rad = track.angle_rad.back();
  const bool turns_back = turned_back_rad(track, last) > std::max(kTurnsBack * (max - min), kMinTurn_rad);
  const bool upwards = (last.direction > 0) != turns_back;
  const double rest_rad = upwards ? max - angle_rad : angle_rad - min;
  if (!(rest_rad > 0) || !(so_far.motion.median_speed_rad_s > 0)) return so_far;
  MotorTrack whole = track;
  whole.time_s.push_back(so_far.end_s + rest_rad / so_far.motion.median_speed_rad_s);
  whole.angle_rad.push_back(upwards ? max : min);
  so_far.motion = find_sweeps(whole);
  return so_far;
}

}  // namespace sweepscope
