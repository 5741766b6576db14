#include "core/recording/sweeps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/numbers.hpp"
#include "core/recording/mirror_shift.hpp"

namespace sweepscope {
namespace {

// The time at which the track crosses a level between samples i - 1 and i.
double crossing_s(const MotorTrack& track, std::size_t i, double level_rad) {
  const double a = track.angle_rad[i - 1], b = track.angle_rad[i];
  if (a == b) return track.time_s[i];
  const double u = std::clamp((level_rad - a) / (b - a), 0.0, 1.0);
  return track.time_s[i - 1] + u * (track.time_s[i] - track.time_s[i - 1]);
}

// Samples at which the angle is extreme between turns by more than `turn_rad`; the first and last sample
// besides.
std::vector<std::size_t> extremes(const MotorTrack& track, double turn_rad) {
  std::vector<std::size_t> found;
  const auto& angle = track.angle_rad;
  std::size_t low = 0, high = 0;
  int direction = 0;
  for (std::size_t i = 1; i < angle.size(); ++i) {
    if (angle[i] >= angle[high]) high = i;
    if (angle[i] <= angle[low]) low = i;
    if (direction >= 0 && angle[high] - angle[i] > turn_rad) {
      if (direction != 0 || high > low) found.push_back(high);
      direction = -1;
      low = i;
    } else if (direction <= 0 && angle[i] - angle[low] > turn_rad) {
      if (direction != 0 || low > high) found.push_back(low);
      direction = 1;
      high = i;
    }
  }
  found.insert(found.begin(), 0);
  if (found.back() + 1 < angle.size()) found.push_back(angle.size() - 1);
  return found;
}

struct Crossings {
  double leave_s, arrive_s;
};

// Where the track between two extremes leaves the first by `margin_rad` and comes as near to the second.
Crossings between(const MotorTrack& track, std::size_t first, std::size_t last, double margin_rad) {
  const double sign = track.angle_rad[last] > track.angle_rad[first] ? 1.0 : -1.0;
  const double leave_rad = track.angle_rad[first] + sign * margin_rad;
  const double arrive_rad = track.angle_rad[last] - sign * margin_rad;
  std::size_t leave = first + 1, arrive = last;
  while (leave < last && sign * (track.angle_rad[leave] - leave_rad) < 0) ++leave;
  while (arrive > leave && sign * (track.angle_rad[arrive - 1] - arrive_rad) > 0) --arrive;
  return {crossing_s(track, leave, leave_rad), crossing_s(track, arrive, arrive_rad)};
}

// The reversal between two sweeps: the middle between where the angle comes near the extreme and where it
// leaves it again, since a clipped or stepped extreme has no sharp instant of its own.
void join_at_reversal(Sweep& before, Sweep& after, const Crossings& near_before,
                      const Crossings& near_after) {
  const double reversal_s = (near_before.arrive_s + near_after.leave_s) / 2;
  before.end_s = reversal_s;
  after.begin_s = reversal_s;
}

// The half turns of a motor that turned one way.
std::vector<Sweep> half_turns(const MotorTrack& track) {
  const auto& angle = track.angle_rad;
  const int direction = angle.back() > angle.front() ? 1 : -1;
  std::vector<Sweep> sweeps;
  double begin_s = track.time_s.front(), begin_rad = angle.front();
  const auto close = [&](double end_s, double end_rad) {
    if (!(end_s > begin_s)) return;
    const double speed_rad_s = std::abs(end_rad - begin_rad) / (end_s - begin_s);
    sweeps.push_back({begin_s, end_s, begin_s, end_s, direction, 0, speed_rad_s});
    begin_s = end_s;
    begin_rad = end_rad;
  };
  double next_rad = std::numbers::pi * (direction > 0 ? std::floor(begin_rad / std::numbers::pi) + 1
                                                      : std::ceil(begin_rad / std::numbers::pi) - 1);
  for (std::size_t i = 1; i < angle.size(); ++i)
    for (; direction * (angle[i] - next_rad) >= 0; next_rad += direction * std::numbers::pi)
      close(crossing_s(track, i, next_rad), next_rad);
  close(track.time_s.back(), angle.back());
  return sweeps;
}

struct TurnedBy {
  double duration_s = 0, turned_rad = 0;
  void add(const Sweep& sweep) {
    duration_s += sweep.end_s - sweep.begin_s;
    turned_rad += sweep.speed_rad_s * (sweep.end_s - sweep.begin_s);
  }
  double mean_rad_s() const { return turned_rad / duration_s; }
};

// Parts half turns into slower and faster ones.
void part_by_speed(std::vector<Sweep>& sweeps) {
  std::vector<Sweep> ascending = sweeps;
  std::ranges::stable_sort(ascending, {}, &Sweep::speed_rad_s);
  TurnedBy all, slow;
  for (const Sweep& sweep : ascending) all.add(sweep);
  double best = 0, threshold_rad_s = 0;
  for (std::size_t i = 0; i + 1 < ascending.size(); ++i) {
    slow.add(ascending[i]);
    const TurnedBy fast{all.duration_s - slow.duration_s, all.turned_rad - slow.turned_rad};
    const double apart_rad_s = fast.mean_rad_s() - slow.mean_rad_s();
    const double between = slow.duration_s * fast.duration_s * apart_rad_s * apart_rad_s;
    if (between <= best) continue;
    best = between;
    threshold_rad_s = ascending[i].speed_rad_s;
  }
  for (Sweep& sweep : sweeps) sweep.side = sweep.speed_rad_s > threshold_rad_s ? 1 : -1;
}

// Whether a track with one sweep is that of a motor that turned on and on; a jump is none.
bool turned_on(const MotorTrack& track, const MotorMotion& motion) {
  constexpr double kMinTurned_rad = 4 * std::numbers::pi;
  return motion.sweeps.size() == 1 && motion.range_rad > kMinTurned_rad &&
         motion.range_rad < std::numbers::pi * double(track.angle_rad.size());
}

// By how much the motor turns from scan to scan at its median speed.
double even_spacing_rad(const Recording& recording, const MotorMotion& motor) {
  return motor.median_speed_rad_s * median(spacings(scan_stamps_s(recording)));
}

// From scan line to scan line of a motor that goes in steps and rests, as all scans of a rest fall on one
// line: half of its way lies in longer gaps. 0 of a motor that turns on.
double spacing_in_steps_rad(const Recording& recording, const MotorMotion& motor) {
  constexpr double kInSteps = 1.5;  // of the even spacing; a speed that only varies stays below
  const std::vector<double> stamps_s = scan_stamps_s(recording);
  const double gap_s = 1.5 * median(spacings(stamps_s));
  MotorReader reader(recording.motor);
  std::vector<double> turned_rad;
  for (std::size_t i = 1; i < stamps_s.size(); ++i) {
    const double before_rad = reader.angle_at(stamps_s[i - 1]), rad = reader.angle_at(stamps_s[i]);
    if (stamps_s[i] - stamps_s[i - 1] < gap_s) turned_rad.push_back(std::abs(rad - before_rad));
  }
  std::ranges::sort(turned_rad);
  double left_rad = std::accumulate(turned_rad.begin(), turned_rad.end(), 0.0) / 2;
  const auto half = std::ranges::find_if(turned_rad, [&](double rad) { return (left_rad -= rad) <= 0; });
  return half != turned_rad.end() && *half > kInSteps * even_spacing_rad(recording, motor) ? *half : 0;
}

}  // namespace

bool MotorMotion::one_way() const {
  const auto as_first = [&](const Sweep& sweep) { return sweep.direction == sweeps.front().direction; };
  return sweeps.size() > 1 && sweeps.front().direction != 0 && std::ranges::all_of(sweeps, as_first);
}

double MotorMotion::speeds_apart_rad_s() const {
  TurnedBy slow, fast;
  for (const Sweep& sweep : sweeps) (sweep.side > 0 ? fast : slow).add(sweep);
  return slow.duration_s > 0 && fast.duration_s > 0 ? fast.mean_rad_s() - slow.mean_rad_s() : 0;
}

double MotorMotion::lever_speed_rad_s() const {
  return one_way() ? speeds_apart_rad_s() / 2 : median_speed_rad_s;
}

MotorMotion find_sweeps(const MotorTrack& track) {
  MotorMotion motion;
  if (track.angle_rad.size() < 3) return motion;
  const auto [min, max] = std::minmax_element(track.angle_rad.begin(), track.angle_rad.end());
  motion.range_rad = *max - *min;
  const double turn_rad = std::max(0.5 * kRadPerDeg, 0.05 * motion.range_rad);
  if (motion.range_rad < 2 * turn_rad) return motion;

  const std::vector<std::size_t> turns = extremes(track, turn_rad);
  std::vector<Crossings> near;
  for (std::size_t i = 0; i + 1 < turns.size(); ++i) {
    const double turned_rad = track.angle_rad[turns[i + 1]] - track.angle_rad[turns[i]];
    if (std::abs(turned_rad) < turn_rad) continue;
    const double margin_rad = std::min(0.03 * motion.range_rad, std::abs(turned_rad) / 4);
    const Crossings crossings = between(track, turns[i], turns[i + 1], margin_rad);
    Sweep sweep;
    sweep.direction = sweep.side = turned_rad > 0 ? 1 : -1;
    sweep.begin_s = sweep.steady_begin_s = crossings.leave_s;
    sweep.end_s = sweep.steady_end_s = crossings.arrive_s;
    if (sweep.end_s <= sweep.begin_s) continue;
    sweep.speed_rad_s = (std::abs(turned_rad) - 2 * margin_rad) / (sweep.end_s - sweep.begin_s);
    // A rest longer than the sweep itself parts two sweeps: nothing was turned meanwhile.
    const bool joined =
        !motion.sweeps.empty() && crossings.leave_s - near.back().arrive_s < sweep.end_s - sweep.begin_s;
    if (joined) join_at_reversal(motion.sweeps.back(), sweep, near.back(), crossings);
    motion.sweeps.push_back(sweep);
    near.push_back(crossings);
  }
  if (turned_on(track, motion)) {
    motion.sweeps = half_turns(track);
    part_by_speed(motion.sweeps);
  }
  std::vector<double> speeds, durations;
  for (std::size_t i = 0; i < motion.sweeps.size(); ++i) {
    speeds.push_back(motion.sweeps[i].speed_rad_s);
    const bool partial = i == 0 || i + 1 == motion.sweeps.size();
    if (!partial || motion.sweeps.size() <= 2)
      durations.push_back(motion.sweeps[i].end_s - motion.sweeps[i].begin_s);
  }
  motion.median_speed_rad_s = median(speeds);
  motion.median_sweep_s = median(durations);
  motion.mirror_shift_s = mirror_shift_s(track, motion);
  return motion;
}

MotorMotion find_sweeps(const Recording& recording) {
  MotorMotion motion = find_sweeps(recording.motor);
  const auto& profile = recording.rig.motor.profile;
  if (profile && profile->between && !profile->mirrors_itself())
    motion.mirror_shift_s = std::max(motion.mirror_shift_s, 2 * motion.median_sweep_s);
  return motion;
}

std::vector<std::size_t> assign_sweeps(const std::vector<LaserScan>& scans, const std::vector<Sweep>& sweeps,
                                       double offset_s) {
  std::vector<std::size_t> assigned(scans.size(), kNoSweep);
  std::size_t sweep = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const double middle_s = (scans[i].first_beam_s + scans[i].last_beam_s()) / 2 + offset_s;
    while (sweep < sweeps.size() && sweeps[sweep].end_s <= middle_s) ++sweep;
    if (sweep < sweeps.size() && sweeps[sweep].begin_s <= middle_s) assigned[i] = sweep;
  }
  return assigned;
}

std::vector<double> scan_stamps_s(const Recording& recording) {
  std::vector<double> stamps_s;
  for (const LaserScan& scan : recording.scans)
    if (scan.ring == recording.scans.front().ring) stamps_s.push_back(scan.first_beam_s);
  return stamps_s;
}

bool goes_in_steps(const Recording& recording, const MotorMotion& motor) {
  return spacing_in_steps_rad(recording, motor) > 0;
}

double line_spacing_rad(const Recording& recording, const MotorMotion& motor) {
  return std::max(even_spacing_rad(recording, motor), spacing_in_steps_rad(recording, motor));
}

double distinct_lines(const Recording& recording, const MotorMotion& motor, double offset_s) {
  constexpr double kUncounted = std::numeric_limits<double>::infinity();
  if (!recording.directions.empty()) return kUncounted;
  const std::vector<std::size_t> sweep_of = assign_sweeps(recording.scans, motor.sweeps, offset_s);
  std::vector<double> places[2];
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    // The first and the last sweep may be cut off: their places are not known.
    if (sweep_of[i] == kNoSweep || sweep_of[i] == 0 || sweep_of[i] + 1 == motor.sweeps.size()) continue;
    const Sweep& sweep = motor.sweeps[sweep_of[i]];
    const LaserScan& scan = recording.scans[i];
    const double middle_s = (scan.first_beam_s + scan.last_beam_s()) / 2 + offset_s;
    places[sweep.side > 0].push_back((middle_s - sweep.begin_s) / (sweep.end_s - sweep.begin_s));
  }
  double min = kUncounted;
  for (std::vector<double>& of_direction : places) {
    if (of_direction.empty()) continue;
    std::sort(of_direction.begin(), of_direction.end());
    std::vector<double> gaps = spacings(of_direction);
    gaps.push_back(of_direction.front() + 1 - of_direction.back());
    std::sort(gaps.begin(), gaps.end());
    std::size_t i = 0;
    for (double within = gaps[0]; i + 1 < gaps.size() && within < 0.5; within += gaps[i]) ++i;
    min = std::min(min, 1 / gaps[i]);
  }
  if (const double spacing_rad = spacing_in_steps_rad(recording, motor); spacing_rad > 0)
    min = std::min(min, motor.median_speed_rad_s * motor.median_sweep_s / spacing_rad);
  return min;
}

}  // namespace sweepscope
