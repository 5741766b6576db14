#include "core/offset/kind/stationary_motion.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/numbers.hpp"
#include "core/offset/kind/sweep_shift.hpp"

namespace sweepscope {
namespace {

// They bound the cost: beyond, a recording's length adds nothing to it.
constexpr std::size_t kMaxPairs = 16, kMaxFarPairs = 4, kMaxPairsOverTime = 64;

using SweepPair = std::pair<std::size_t, std::size_t>;

// The sweep of each of the grid's lines; kNoSweep where none.
std::vector<std::size_t> sweep_of_lines(const StationaryGrid& grid, double offset_s) {
  const auto sweep_of_scan =
      assign_sweeps(grid.problem->recording->scans, grid.problem->motor.sweeps, offset_s);
  std::vector<std::size_t> sweep_of;
  for (const std::uint32_t scan : grid.scan) sweep_of.push_back(sweep_of_scan[scan]);
  return sweep_of;
}

// The grid's lines of these sweeps (ascending) alone: the points of all would take more memory than the
// recording.
StationaryGrid lines_of(const StationaryGrid& grid, const std::vector<std::size_t>& sweep_of,
                        const std::vector<std::size_t>& sweeps) {
  StationaryGrid part;
  part.problem = grid.problem;
  part.bins = grid.bins;
  const auto append = [&](const auto& from, std::size_t line, auto& to) {
    const auto first = from.begin() + static_cast<std::ptrdiff_t>(line * grid.bins);
    to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(grid.bins));
  };
  for (std::size_t line = 0; line < grid.lines(); ++line) {
    if (!std::binary_search(sweeps.begin(), sweeps.end(), sweep_of[line])) continue;
    part.scan.push_back(grid.scan[line]);
    append(grid.feature, line, part.feature);
    append(grid.time_s, line, part.time_s);
    append(grid.range_m, line, part.range_m);
  }
  return part;
}

// Half turns take the longer and have the more lines the slower they are.
std::vector<std::size_t> whole_half_turns(const MotorMotion& motor, const std::vector<std::size_t>& lines) {
  std::vector<std::size_t> full;
  std::vector<double> lines_per_s(lines.size(), 0.0);
  double most_per_s = 0;
  for (std::size_t sweep = 0; sweep < lines.size(); ++sweep) {
    const double duration_s = motor.sweeps[sweep].end_s - motor.sweeps[sweep].begin_s;
    if (motor.sweeps[sweep].speed_rad_s * duration_s < 0.7 * std::numbers::pi) continue;
    lines_per_s[sweep] = double(lines[sweep]) / duration_s;
    most_per_s = std::max(most_per_s, lines_per_s[sweep]);
    full.push_back(sweep);
  }
  std::erase_if(full, [&](std::size_t sweep) { return lines_per_s[sweep] < 0.7 * most_per_s; });
  return full;
}

std::vector<std::size_t> whole_sweeps(const StationaryGrid& grid, const std::vector<std::size_t>& sweep_of) {
  std::vector<std::size_t> lines;
  for (const std::size_t sweep : sweep_of) {
    if (sweep == kNoSweep) continue;
    if (sweep >= lines.size()) lines.resize(sweep + 1);
    ++lines[sweep];
  }
  const MotorMotion& motion = grid.problem->motor;
  if (motion.one_way()) return whole_half_turns(motion, lines);
  std::size_t most = 0;  // of those without a rest within
  for (std::size_t sweep = 0; sweep < lines.size(); ++sweep)
    if (motion.sweeps[sweep].end_s - motion.sweeps[sweep].begin_s < 1.5 * motion.median_sweep_s)
      most = std::max(most, lines[sweep]);
  std::vector<std::size_t> whole;
  for (std::size_t sweep = 0; sweep < lines.size(); ++sweep) {
    const Sweep& motor = motion.sweeps[sweep];
    const bool full_turn = motor.end_s - motor.begin_s > 0.7 * motion.median_sweep_s;
    if (full_turn && 10 * lines[sweep] > 7 * most) whole.push_back(sweep);
  }
  return whole;
}

// Some of the pairs, evenly.
std::vector<SweepPair> spread(const std::vector<SweepPair>& all, std::size_t max_pairs) {
  std::vector<SweepPair> chosen;
  const std::size_t stride = std::max<std::size_t>(1, all.size() / max_pairs);
  for (std::size_t i = 0; i < all.size(); i += stride) chosen.push_back(all[i]);
  return chosen;
}

// Of opposite directions, one after the other, spread over the recording: any that have lines.
std::vector<SweepPair> neighbouring_pairs(std::vector<std::size_t> sweeps) {
  std::sort(sweeps.begin(), sweeps.end());
  sweeps.erase(std::unique(sweeps.begin(), sweeps.end()), sweeps.end());
  std::vector<SweepPair> all;
  for (std::size_t i = 0; i + 1 < sweeps.size() && sweeps[i + 1] != kNoSweep; ++i)
    if (sweeps[i + 1] == sweeps[i] + 1) all.push_back({sweeps[i], sweeps[i + 1]});
  return spread(all, kMaxPairs);
}

// Of the same direction, one after the other, spread over the recording.
std::vector<SweepPair> near_pairs(const MotorMotion& motor, const std::vector<std::size_t>& whole,
                                  std::size_t max_pairs = kMaxPairs) {
  std::vector<SweepPair> all;
  const bool one_way = motor.one_way();
  for (const std::size_t sweep : whole) {
    if (!std::binary_search(whole.begin(), whole.end(), sweep + 2)) continue;
    // An offset turns half turns of different speeds against each other.
    if (one_way && motor.sweeps[sweep].side != motor.sweeps[sweep + 2].side) continue;
    all.push_back({sweep, sweep + 2});
  }
  return spread(all, max_pairs);
}

// Of the same direction, the first with the last, the second with the last but one, and so on.
std::vector<SweepPair> far_pairs(const std::vector<std::size_t>& whole) {
  constexpr std::size_t kMinSweepsApart = 4;  // twice as far as near pairs lie
  std::vector<SweepPair> chosen;
  std::size_t first = 0, end = whole.size();
  for (; chosen.size() < kMaxFarPairs && first + 1 < end; ++first) {
    std::size_t last = end - 1;
    while (last > first && (whole[last] - whole[first]) % 2 != 0) --last;
    if (whole[last] - whole[first] < kMinSweepsApart) break;
    chosen.push_back({whole[first], whole[last]});
    end = last;
  }
  return chosen;
}

// The same for a motor that turns one way, for each side separately.
std::vector<SweepPair> far_pairs_of_sides(const MotorMotion& motor, const std::vector<std::size_t>& whole) {
  if (!motor.one_way()) return far_pairs(whole);
  std::vector<SweepPair> chosen;
  for (const int side : {-1, 1}) {
    std::vector<std::size_t> of_side;
    std::ranges::copy_if(whole, std::back_inserter(of_side),
                         [&](std::size_t sweep) { return motor.sweeps[sweep].side == side; });
    const std::vector<SweepPair> pairs = far_pairs(of_side);
    chosen.insert(chosen.end(), pairs.begin(), pairs.end());
  }
  return chosen;
}

// Found by simulation of stationary rigs among trees and people, and of walks: those of
// stationary_motion_test.
constexpr double kEnoughMatches = 12, kMinApart_m = 0.006;

bool moved(const SweepShift& shift) {
  return shift.gained_matches > kEnoughMatches && shift.apart_m > kMinApart_m;
}

// That a pair moved, from 0 to 1. A few matches count where the shift is long: sparse sweeps of a stationary
// rig gain as many, with shifts as short as their noise.
double evidence_of(const SweepShift& shift) {
  if (moved(shift)) return 1;
  return shift.apart_m > 2 * kMinApart_m ? std::clamp(shift.gained_matches / kEnoughMatches, 0.0, 1.0) : 0;
}

// Whether two pairs, one after the other, show the same long shift, and fit about as well there as at rest.
// The bounds were found as those above.
bool same_long_shift(const SweepShift& one, const SweepShift& next) {
  constexpr double kMin_m = 0.15, kMaxDifference = 0.3, kMaxLostMatches = 0.05;
  const auto fits = [](const SweepShift& shift) {
    return shift.far_gained_matches > -kMaxLostMatches * double(shift.matches);
  };
  const double one_m = one.far_translation_m.norm(), next_m = next.far_translation_m.norm();
  return std::min(one_m, next_m) > kMin_m && fits(one) && fits(next) &&
         (one.far_translation_m - next.far_translation_m).norm() < kMaxDifference * std::max(one_m, next_m);
}

// Whether a pair shows the same long shift as the one before it, or as the one after it.
bool is_long_shift(const std::vector<SweepShift>& shifts, std::size_t i) {
  const bool as_before = i > 0 && same_long_shift(shifts[i - 1], shifts[i]);
  return as_before || (i + 1 < shifts.size() && same_long_shift(shifts[i], shifts[i + 1]));
}

// The shifts of the pairs; those with too few matches are left out.
class Shifts {
 public:
  Shifts(const StationaryGrid& grid, const std::vector<std::size_t>& sweep_of,
         const std::vector<SweepPair>& near, const std::vector<SweepPair>& far, double offset_s)
      : part_(lines_of(grid, sweep_of, sweeps_of(near, far))),
        points_(place_stationary(part_, offset_s, StationaryDetail::kPoints)),
        pools_(pools_by_sweep(points_)) {}

  std::vector<SweepShift> of(const std::vector<SweepPair>& pairs) const {
    std::vector<SweepShift> shifts;
    for (const SweepPair& pair : pairs)
      if (const auto shift = of(pair)) shifts.push_back(*shift);
    return shifts;
  }
  std::optional<SweepShift> of(const SweepPair& pair) const {
    return shift_between(points_, pools_[pair.first], pools_[pair.second], part_);
  }

 private:
  static std::vector<std::size_t> sweeps_of(const std::vector<SweepPair>& near,
                                            const std::vector<SweepPair>& far) {
    std::vector<std::size_t> sweeps;
    for (const auto* pairs : {&near, &far})
      for (const auto& [target, source] : *pairs) sweeps.insert(sweeps.end(), {target, source});
    std::sort(sweeps.begin(), sweeps.end());
    return sweeps;
  }

  StationaryGrid part_;
  StationaryPoints points_;
  std::vector<LinePool> pools_;
};

// The lines of the two sweeps of a pool that are nearest to a sweep.
LinePool nearest_lines(const StationaryPoints& points, const LinePool& pool, std::size_t sweep) {
  std::vector<std::size_t> sweeps;
  for (const std::uint32_t line : pool) sweeps.push_back(points.sweep[line]);
  std::ranges::sort(sweeps);
  sweeps.erase(std::unique(sweeps.begin(), sweeps.end()), sweeps.end());
  std::ranges::stable_sort(sweeps, {},
                           [&](std::size_t other) { return other > sweep ? other - sweep : sweep - other; });
  sweeps.resize(std::min<std::size_t>(sweeps.size(), 2));
  LinePool lines;
  std::ranges::copy_if(pool, std::back_inserter(lines), [&](std::uint32_t line) {
    return std::ranges::find(sweeps, points.sweep[line]) != sweeps.end();
  });
  return lines;
}

// A sweep's lines in groups of equal times.
std::vector<LinePool> groups_in_time(const LinePool& sweep, const std::vector<double>& time_s) {
  constexpr std::size_t kGroups = 8;  // 120 matches each, of a scanner with a few hundred beams
  std::vector<LinePool> groups(kGroups);
  const auto [first, last] =
      std::ranges::minmax_element(sweep, {}, [&](std::uint32_t line) { return time_s[line]; });
  const double begin_s = time_s[*first], step_s = (time_s[*last] - begin_s) / double(kGroups);
  for (const std::uint32_t line : sweep) {
    const double place = step_s > 0 ? (time_s[line] - begin_s) / step_s : 0;
    groups[std::min(kGroups - 1, std::size_t(place))].push_back(line);
  }
  std::erase_if(groups, [](const LinePool& group) { return group.empty(); });
  return groups;
}

}  // namespace

MotionTest test_motion(const StationaryGrid& grid, double offset_s) {
  const std::vector<std::size_t> sweep_of = sweep_of_lines(grid, offset_s);
  const std::vector<std::size_t> whole = whole_sweeps(grid, sweep_of);
  const std::vector<SweepPair> near = near_pairs(grid.problem->motor, whole),
                               far = far_pairs_of_sides(grid.problem->motor, whole);
  const Shifts shifts(grid, sweep_of, near, far, offset_s);
  MotionTest test;
  const std::vector<SweepShift> of_near = shifts.of(near), of_far = shifts.of(far);
  std::vector<double> translations_m, rotations_rad, apart_m;
  for (std::size_t i = 0; i < of_near.size(); ++i) {
    const bool long_shift = is_long_shift(of_near, i);
    const SweepShift& shift = of_near[i];
    if (long_shift || moved(shift)) ++test.moved;
    test.evidence += long_shift ? 1 : evidence_of(shift);
    translations_m.push_back((long_shift ? shift.far_translation_m : shift.translation_m).norm());
    rotations_rad.push_back(long_shift ? shift.far_rotation_rad : shift.rotation_rad);
    apart_m.push_back(of_near[i].apart_in_all_m);
  }
  test.pairs = of_near.size();
  test.far_pairs = of_far.size();
  test.far_moved = std::size_t(std::count_if(of_far.begin(), of_far.end(), moved));
  test.median_translation_m = median(translations_m);
  test.median_rotation_rad = median(rotations_rad);
  test.median_apart_m = median(apart_m);
  return test;
}

bool has_few_pairs(const MotionTest& test) {
  return test.pairs < 3;  // of four sweeps or fewer: the motion of one alone may go unseen
}

void add_neighbours(const StationaryGrid& grid, double offset_s, MotionTest& test) {
  if (grid.problem->motor.one_way()) return;  // half turns that follow each other see different surfaces
  const std::vector<std::size_t> sweep_of = sweep_of_lines(grid, offset_s);
  const std::vector<SweepPair> pairs = neighbouring_pairs(sweep_of);
  const std::vector<SweepShift> shifts = Shifts(grid, sweep_of, pairs, {}, offset_s).of(pairs);
  test.neighbours = shifts.size();
  test.neighbours_moved = std::size_t(std::ranges::count_if(shifts, moved));
  if (test.pairs > 0) return;
  std::vector<double> apart_m;
  for (const SweepShift& shift : shifts)
    apart_m.push_back(2 * shift.apart_m);  // next but one lies twice as far
  test.median_apart_m = median(apart_m);
}

bool moved_within_sweeps(const StationaryGrid& grid, double offset_s) {
  // A group has a few rests, and scans on the way between them, where an encoder's samples are too few to
  // tell.
  if (goes_in_steps(*grid.problem->recording, grid.problem->motor)) return false;
  const std::vector<MotionPart> groups =
      motion_of_lines(grid, offset_s, {0, std::numeric_limits<double>::infinity()});
  for (std::size_t i = 2; i < groups.size(); ++i)
    if (groups[i - 2].moved + groups[i - 1].moved + groups[i].moved >= 2) return true;
  return false;
}

std::vector<MotionPart> motion_over_time(const StationaryGrid& grid, double offset_s) {
  const std::vector<std::size_t> sweep_of = sweep_of_lines(grid, offset_s);
  const MotorMotion& motor = grid.problem->motor;
  const std::vector<SweepPair> pairs = near_pairs(motor, whole_sweeps(grid, sweep_of), kMaxPairsOverTime);
  const Shifts all(grid, sweep_of, pairs, {}, offset_s);
  std::vector<SweepShift> shifts;
  std::vector<double> begins_s;  // of the pairs that overlap enough to be compared
  const auto& scans = grid.problem->recording->scans;
  for (const SweepPair& pair : pairs) {
    const auto shift = all.of(pair);
    if (!shift) continue;
    shifts.push_back(*shift);
    begins_s.push_back(motor.sweeps[pair.first].begin_s - scans.front().first_beam_s);
  }
  std::vector<MotionPart> parts;
  for (std::size_t i = 0; i < shifts.size(); ++i) {
    const bool has_moved = is_long_shift(shifts, i) || moved(shifts[i]);
    const double begin_s = parts.empty() ? 0 : std::max(begins_s[i], parts.back().begin_s);
    if (parts.empty() || parts.back().moved != has_moved) {
      if (!parts.empty()) parts.back().end_s = begin_s;
      parts.push_back({begin_s, begin_s, has_moved});
    }
  }
  if (!parts.empty()) parts.back().end_s = scans.back().first_beam_s - scans.front().first_beam_s;
  return parts;
}

std::vector<MotionPart> motion_of_lines(const StationaryGrid& grid, double offset_s,
                                        const RecordingPart& reference) {
  std::vector<MotionPart> parts;
  const MotorMotion& motor = grid.problem->motor;
  if (motor.one_way() || grid.lines() == 0) return parts;
  const StationaryPoints points = place_stationary(grid, offset_s, StationaryDetail::kPoints);
  const auto& scans = grid.problem->recording->scans;
  std::vector<double> time_s;  // since the first scan
  for (const std::uint32_t scan : grid.scan)
    time_s.push_back(scans[scan].first_beam_s - scans[0].first_beam_s);
  std::array<LinePool, 2> pools = points.pool;
  for (LinePool& pool : pools)
    std::erase_if(pool, [&](std::uint32_t line) {
      const Sweep& sweep = motor.sweeps[points.sweep[line]];
      const double middle_s = (sweep.begin_s + sweep.end_s) / 2 - offset_s - scans[0].first_beam_s;
      return middle_s < reference.begin_s || middle_s > reference.end_s;
    });
  for (const LinePool& sweep : pools_by_sweep(points)) {
    if (sweep.empty()) continue;
    const std::uint32_t any = sweep.front();
    const LinePool against =
        nearest_lines(points, pools[points.direction[any] > 0 ? 0 : 1], points.sweep[any]);
    for (const LinePool& group : groups_in_time(sweep, time_s)) {
      const auto shift = shift_between(points, against, group, grid);
      if (!shift) continue;
      const auto [first, last] =
          std::ranges::minmax_element(group, {}, [&](std::uint32_t line) { return time_s[line]; });
      parts.push_back({time_s[*first], time_s[*last], moved(*shift)});
    }
  }
  return parts;
}

}  // namespace sweepscope
