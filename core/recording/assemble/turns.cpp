#include "core/recording/assemble/turns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numbers.hpp"
#include "core/recording/stream_stamps.hpp"

namespace sweepscope {
namespace {

constexpr double kSameDirection = 1.5;  // increments

bool same_direction(double a_rad, double b_rad, double increment_rad) {
  return std::abs(std::remainder(a_rad - b_rad, kFullCircle_rad)) < kSameDirection * std::abs(increment_rad);
}

bool continues(const LaserScan& scan, const LaserScan& next) {
  constexpr double kLate = 0.25;  // of a scan: stamps jitter
  const double end_s = scan.beam_s(scan.beams), duration_s = end_s - scan.first_beam_s;
  return same_direction(scan.beam_angle_rad(scan.beams), next.angle_min_rad, scan.angle_increment_rad) &&
         std::abs(next.first_beam_s - end_s) <= kLate * duration_s &&
         scan.angle_increment_rad * next.angle_increment_rad > 0;
}

// Messages that begin where the one before ended, or end where it began: the turns of those before, and how
// much later they come.
struct Followers {
  std::vector<double> turned, later_s;
  std::size_t count() const { return turned.size(); }
  void add(double turned_by, double later_by_s) {
    turned.push_back(turned_by);
    later_s.push_back(later_by_s);
  }
};

// The header's stamp, or the receive time where there is none.
double time_s(const RawScan& scan) {
  const std::int64_t header_ns = stamp_ns(scan.stamps, StampSource::kHeader);
  return 1e-9 * double(header_ns != 0 ? header_ns : stamp_ns(scan.stamps, StampSource::kReceive));
}

// A beam of a run of scans.
struct BeamOfRun {
  std::size_t scan = 0;
  std::uint32_t beam = 0;
};

// The beams of a run at which the mirror passes a direction; the run's first beam is one, whatever its
// direction.
std::vector<BeamOfRun> beginnings(std::span<const LaserScan> run, double direction_rad) {
  std::vector<BeamOfRun> found{{0, 0}};
  for (std::size_t i = 0; i < run.size(); ++i) {
    const LaserScan& scan = run[i];
    // Beams from the first one to the direction, a turn or less ahead.
    const double turn_beams = kFullCircle_rad / std::abs(scan.angle_increment_rad);
    double ahead =
        std::remainder(direction_rad - scan.angle_min_rad, kFullCircle_rad) / scan.angle_increment_rad;
    if (ahead < -0.5) ahead += turn_beams;
    for (double beam = std::max(0.0, std::round(ahead)); beam < scan.beams; beam += turn_beams)
      if (i > 0 || beam >= 0.5) found.push_back({i, std::uint32_t(beam)});
  }
  return found;
}

void append_turns(std::span<const LaserScan> run, double direction_rad, std::vector<LaserScan>& turns) {
  const std::vector<BeamOfRun> begins = beginnings(run, direction_rad);
  for (std::size_t i = 0; i < begins.size(); ++i) {
    const LaserScan& first = run[begins[i].scan];
    const bool last_turn = i + 1 == begins.size();
    const LaserScan& end = last_turn ? run.back() : run[begins[i + 1].scan];
    const std::uint32_t end_beam = last_turn ? end.beams : begins[i + 1].beam;
    LaserScan turn = first;
    turn.first_beam_s = first.beam_s(begins[i].beam);
    turn.angle_min_rad = first.beam_angle_rad(begins[i].beam);
    turn.first_range = first.first_range + begins[i].beam;
    turn.beams = std::uint32_t(end.first_range + end_beam - turn.first_range);
    if (turn.beams > 0) turn.time_increment_s = (end.beam_s(end_beam) - turn.first_beam_s) / turn.beams;
    if (turn.beams > 0) turns.push_back(turn);
  }
}

}  // namespace

MessageTurns turns_of_messages(const std::vector<RawScan>& messages) {
  constexpr double kNearlyAll = 0.9;
  Followers onwards, back;
  for (std::size_t i = 0; i + 1 < messages.size(); ++i) {
    const RawScan &message = messages[i], &next = messages[i + 1];
    const double begin_rad = double{message.angle_min_rad}, next_rad = double{next.angle_min_rad},
                 increment_rad = double{message.angle_increment_rad},
                 span_rad = message.beams * increment_rad;
    if (same_direction(begin_rad, next_rad, increment_rad)) continue;
    const double turned = std::abs(span_rad) / kFullCircle_rad, later_s = time_s(next) - time_s(message);
    if (same_direction(begin_rad + span_rad, next_rad, increment_rad)) onwards.add(turned, later_s);
    if (same_direction(next_rad + next.beams * increment_rad, begin_rad, increment_rad))
      back.add(turned, later_s);
  }
  // Halves of a turn follow each other both ways.
  if (2 * onwards.count() > messages.size()) return {median(onwards.turned), false};
  if (2 * back.count() > messages.size()) return {median(back.turned), true};
  // So do two parts beside a blind sector, by turns; the pair behind the sector comes later.
  if (double(onwards.count() + back.count()) < kNearlyAll * double(messages.size())) return {};
  const bool backwards = median(back.later_s) < median(onwards.later_s);
  return {median(backwards ? back.turned : onwards.turned), backwards};
}

std::vector<LaserScan> whole_turns(const std::vector<LaserScan>& scans) {
  std::vector<LaserScan> turns;
  for (std::size_t first = 0, end = 1; first < scans.size(); first = end++) {
    while (end < scans.size() && continues(scans[end - 1], scans[end])) ++end;
    append_turns({scans.data() + first, end - first}, scans.front().angle_min_rad, turns);
  }
  return turns;
}

}  // namespace sweepscope
