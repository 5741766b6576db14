#include "core/recording/assemble/motor_publishers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/numbers.hpp"
#include "core/recording/stream_stamps.hpp"

namespace sweepscope {
namespace {

constexpr double kMinMotion_rad = 1 * kRadPerDeg;

/// What one node published, in the order of time.
struct Publisher {
  std::uint16_t number = 0;
  MotorTrack track;
  double range_rad = 0;
  std::size_t new_angles = 0;  // that differ from the one before

  bool moves() const { return range_rad > kMinMotion_rad; }
  double first_s() const { return track.time_s.front(); }
  double last_s() const { return track.time_s.back(); }
};

std::vector<Publisher> publishers_of(const RawJoint& raw, const JointSamples& samples) {
  std::vector<Publisher> found;
  for (std::uint16_t number = 0; number < raw.publishers.size(); ++number) {
    std::vector<double> times_s, angles_rad;
    for (std::size_t i = 0; i < samples.times_s.size(); ++i) {
      if (samples.publisher[i] != number) continue;
      times_s.push_back(samples.times_s[i]);
      angles_rad.push_back(samples.angles_rad[i]);
    }
    if (times_s.empty()) continue;
    Publisher& added = found.emplace_back();
    added.number = number;
    for (const std::size_t i : order_by_time(times_s).kept) {
      added.new_angles += added.track.angle_rad.empty() || angles_rad[i] != added.track.angle_rad.back();
      added.track.time_s.push_back(times_s[i]);
      added.track.angle_rad.push_back(angles_rad[i]);
    }
    const auto [min_rad, max_rad] = std::ranges::minmax(added.track.angle_rad);
    added.range_rad = max_rad - min_rad;
  }
  return found;
}

/// The one that sends most new angles; of about equal ones the one that repeats least.
const Publisher& source_of(const std::vector<Publisher>& publishers) {
  constexpr double kAboutAsMany = 0.8;
  std::size_t most = 0;
  for (const Publisher& one : publishers) most = std::max(most, one.moves() ? one.new_angles : 0);
  const Publisher* source = &publishers.front();
  double best_part = -1;
  for (const Publisher& one : publishers) {
    if (most > 0 && (!one.moves() || double(one.new_angles) < kAboutAsMany * double(most))) continue;
    const double part = double(one.new_angles) / double(one.track.time_s.size());
    if (part <= best_part) continue;
    best_part = part;
    source = &one;
  }
  return *source;
}

bool overlap(const Publisher& one, const Publisher& other) {
  return std::min(one.last_s(), other.last_s()) > std::max(one.first_s(), other.first_s());
}

/// How far one's angles lie from the other's at their times, at the median.
double apart_rad(const Publisher& one, const Publisher& source) {
  const MotorTrack& track = source.track;
  std::vector<double> apart_rad;
  for (std::size_t i = 0; i < one.track.time_s.size(); ++i) {
    const double time_s = one.track.time_s[i];
    const auto next = std::ranges::upper_bound(track.time_s, time_s) - track.time_s.begin();
    if (next == 0 || next == std::ssize(track.time_s)) continue;
    const std::size_t after = std::size_t(next);
    const double part = (time_s - track.time_s[after - 1]) / (track.time_s[after] - track.time_s[after - 1]);
    apart_rad.push_back(std::abs(one.track.angle_rad[i] -
                                 std::lerp(track.angle_rad[after - 1], track.angle_rad[after], part)));
  }
  return median(std::move(apart_rad));
}

void erase_samples(JointSamples samples, const std::vector<char>& left_out) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    if (left_out[i]) continue;
    samples.times_s[kept] = samples.times_s[i];
    samples.angles_rad[kept] = samples.angles_rad[i];
    samples.publisher[kept++] = samples.publisher[i];
  }
  samples.times_s.resize(kept);
  samples.angles_rad.resize(kept);
  samples.publisher.resize(kept);
}

std::string in_words(const RawJoint& raw, const Publisher& one) {
  return fmt::format("{} ({} samples over {:.1f} deg)", raw.publishers[one.number], one.track.time_s.size(),
                     one.range_rad * kDegPerRad);
}

}  // namespace

void keep_one_publisher(const RawJoint& raw, JointSamples samples, ReadReport& report) {
  constexpr double kMaxApart = 0.1;  // of the range: a node that sends old angles again is late by less
  // Messages without a name among others, as after a change of the recorder: nothing is known then.
  if (raw.publishers.size() < 2 || samples.publisher.size() != samples.times_s.size()) return;
  const std::vector<Publisher> publishers = publishers_of(raw, samples);
  if (publishers.size() < 2) return;
  const Publisher& source = source_of(publishers);
  std::vector<std::string> others;
  std::vector<char> is_other(raw.publishers.size(), 0);
  for (const Publisher& one : publishers) {
    if (one.number == source.number || !overlap(one, source)) continue;
    others.push_back(in_words(raw, one));
    is_other[one.number] = 1;
    if (one.moves() && apart_rad(one, source) > kMaxApart * source.range_rad)
      report.motor_faults.sources = fmt::format("{} and {}", in_words(raw, source), in_words(raw, one));
  }
  if (others.empty()) return;
  std::vector<char> left_out;
  for (const std::uint16_t number : samples.publisher) left_out.push_back(is_other[number]);
  report.motor_of_others += std::size_t(std::ranges::count(left_out, 1));
  erase_samples(samples, left_out);
  report.warnings.push_back(fmt::format(
      "joint {} on {} has several publishers, {} and {}: only the samples of {} "
      "are used",
      raw.joint, raw.topic, in_words(raw, source), fmt::join(others, ", "), raw.publishers[source.number]));
}

void leave_out_constant(const RawJoint& raw, MotorTrack& motor, ReadReport& report) {
  constexpr std::size_t kMin = 5;
  constexpr double kMinPart = 0.02, kMinAside = 0.6, kFar = 2;
  if (raw.publishers.size() > 1) return;
  const std::vector<double>& angles_rad = motor.angle_rad;
  struct Seen {
    std::size_t alone = 0, aside = 0;  // between two other angles, and far to one side of both
  };
  // Farther away than the motor turns: at a reversal it comes back to an angle, too.
  std::vector<double> turns_rad;
  for (std::size_t i = 1; i + 1 < angles_rad.size(); ++i)
    turns_rad.push_back(std::abs(angles_rad[i + 1] - angles_rad[i - 1]));
  const double far_rad = std::max(kMinMotion_rad, kFar * median(std::move(turns_rad)));
  std::map<double, Seen> seen;
  for (std::size_t i = 1; i + 1 < angles_rad.size(); ++i) {
    const double before_rad = angles_rad[i - 1] - angles_rad[i],
                 after_rad = angles_rad[i + 1] - angles_rad[i];
    if (before_rad == 0 || after_rad == 0) continue;
    Seen& here = seen[angles_rad[i]];
    ++here.alone;
    here.aside += before_rad * after_rad > 0 && std::min(std::abs(before_rad), std::abs(after_rad)) > far_rad;
  }
  const auto often = std::ranges::max_element(seen, {}, [](const auto& one) { return one.second.aside; });
  if (often == seen.end() || often->second.aside < kMin) return;
  const auto& [constant_rad, counts] = *often;
  if (double(counts.aside) < kMinPart * double(angles_rad.size()) ||
      double(counts.aside) < kMinAside * double(counts.alone))
    return;
  MotorTrack kept;
  for (std::size_t i = 0; i < angles_rad.size(); ++i) {
    if (angles_rad[i] == constant_rad) continue;
    kept.time_s.push_back(motor.time_s[i]);
    kept.angle_rad.push_back(angles_rad[i]);
  }
  const std::size_t left_out = angles_rad.size() - kept.time_s.size();
  report.motor_of_others += left_out;
  report.warnings.push_back(
      fmt::format("{} of {} samples of joint {} on {} are {:.2f} deg while it moves elsewhere: another node "
                  "publishes a constant. They are left out",
                  left_out, angles_rad.size(), raw.joint, raw.topic, constant_rad * kDegPerRad));
  motor = std::move(kept);
}

std::string interleaved_sources(const RawJoint& raw, const MotorTrack& motor) {
  constexpr double kTurn_rad = 2 * std::numbers::pi;
  // A motor that is sampled three times per sweep turns back at every third sample; two sources do at most.
  constexpr double kMinPart = 0.45, kMinBack = 0.05;
  if (motor.time_s.size() < 20) return "";
  const auto [min_rad, max_rad] = std::ranges::minmax(motor.angle_rad);
  std::size_t back = 0;
  std::vector<double> sizes_rad;
  for (std::size_t i = 1; i + 1 < motor.angle_rad.size(); ++i) {
    const double before_rad = std::remainder(motor.angle_rad[i] - motor.angle_rad[i - 1], kTurn_rad),
                 after_rad = std::remainder(motor.angle_rad[i + 1] - motor.angle_rad[i], kTurn_rad);
    const double size_rad = std::min(std::abs(before_rad), std::abs(after_rad));
    if (before_rad * after_rad >= 0 || size_rad < kMinBack * (max_rad - min_rad)) continue;
    ++back;
    sizes_rad.push_back(size_rad);
  }
  if (double(back) < kMinPart * double(motor.angle_rad.size())) return "";
  return fmt::format("those of joint {} on {} jump to and fro by {:.0f} deg from one to the next", raw.joint,
                     raw.topic, median(std::move(sizes_rad)) * kDegPerRad);
}

}  // namespace sweepscope
