#include "core/live/stream_window.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <utility>

#include "core/numbers.hpp"
#include "core/recording/stream_stamps.hpp"
#include "core/recording/take_messages.hpp"

namespace sweepscope {
namespace {

template <typename Values>
void append_part(const Values& from, std::size_t first, std::size_t count, Values& to) {
  const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first);
  to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
}

/// Appends scan `i` of a laser to another laser's.
void append_scan(const RawLaser& from, std::size_t i, RawLaser& to) {
  const RawScan& scan = from.scans[i];
  to.scans.push_back(scan);
  to.scans.back().first_range = to.ranges_m.size();
  append_part(from.ranges_m, scan.first_range, scan.beams, to.ranges_m);
  to.has_intensities = to.has_intensities && from.has_intensities;
  if (to.has_intensities)
    append_part(from.intensities, scan.first_range, scan.beams, to.intensities);
  else
    std::vector<float>().swap(to.intensities);
  if (!from.directions.empty()) append_part(from.directions, scan.first_range, scan.beams, to.directions);
}

void append_sample(const RawJoint& from, std::size_t i, RawJoint& to) {
  to.stamps.push_back(from.stamps[i]);
  to.positions.push_back(from.positions[i]);
  if (!from.publisher.empty()) to.publisher.push_back(from.publisher[i]);
}

template <typename Stamps, typename Projection>
std::vector<std::int64_t> sorted_stamps_ns(const Stamps& of, StampSource source, Projection stamps) {
  std::vector<std::int64_t> all_ns;
  all_ns.reserve(of.size());
  for (const auto& one : of)
    if (const std::int64_t ns = stamp_ns(std::invoke(stamps, one), source); ns != 0) all_ns.push_back(ns);
  std::ranges::sort(all_ns);
  all_ns.erase(std::ranges::unique(all_ns).begin(), all_ns.end());
  return all_ns;
}

}  // namespace

SteadyClock::Answer SteadyClock::take(std::int64_t ns) {
  constexpr std::int64_t kMaxStep_ns = 5 * kSecond_ns;
  constexpr int kMaxRefused = 10;
  if (!latest_ns_ || std::abs(ns - *latest_ns_) <= kMaxStep_ns) {
    latest_ns_ = latest_ns_ ? std::max(*latest_ns_, ns) : ns;
    refused_ = 0;
    return Answer::kGoesOn;
  }
  if (++refused_ < kMaxRefused) return Answer::kRefused;
  latest_ns_ = ns;
  refused_ = 0;
  return Answer::kBeganAnew;
}

StreamWindow::Change StreamWindow::add(RawRecording heard) {
  if (chosen()) {
    const Change scans =
        heard.lasers.size() > *laser_ ? add_scans(std::move(heard.lasers[*laser_])) : Change::kNone;
    const Change samples =
        heard.joints.size() > joint_ ? add_samples(std::move(heard.joints[joint_])) : Change::kNone;
    return scans == Change::kNone ? samples : scans;
  }
  RawRecording before = std::exchange(raw_, std::move(heard));
  for (std::size_t i = 0; i < before.lasers.size(); ++i) {
    RawLaser& later = raw_.lasers[i];
    std::swap(before.lasers[i], later);
    if (later.scans.empty()) later.frame = before.lasers[i].frame;
    for (std::size_t k = 0; k < before.lasers[i].scans.size(); ++k) append_scan(before.lasers[i], k, later);
  }
  for (std::size_t i = 0; i < before.joints.size(); ++i) {
    std::swap(before.joints[i], raw_.joints[i]);
    for (std::size_t k = 0; k < before.joints[i].stamps.size(); ++k)
      append_sample(before.joints[i], k, raw_.joints[i]);
  }
  raw_.warnings.insert(raw_.warnings.begin(), before.warnings.begin(), before.warnings.end());
  return Change::kNone;
}

StreamWindow::Change StreamWindow::add_scans(RawLaser heard) {
  RawLaser& laser = raw_.lasers.front();
  Change change = Change::kNone;
  for (std::size_t i = 0; i < heard.scans.size(); ++i) {
    const std::int64_t ns = stamp_ns(heard.scans[i].stamps, laser_stamp_);
    const auto answer = ns == 0 ? SteadyClock::Answer::kRefused : scan_clock_.take(ns);
    if (answer == SteadyClock::Answer::kRefused) continue;
    if (answer == SteadyClock::Answer::kBeganAnew) {
      laser = without_scans(laser);
      change = Change::kBeganAnew;
    }
    append_scan(heard, i, laser);
  }
  return change;
}

StreamWindow::Change StreamWindow::add_samples(RawJoint heard) {
  RawJoint& joint = raw_.joints.front();
  joint.publishers = std::move(heard.publishers);
  Change change = Change::kNone;
  for (std::size_t i = 0; i < heard.stamps.size(); ++i) {
    const std::int64_t ns = stamp_ns(heard.stamps[i], motor_stamp_);
    const auto answer = ns == 0 ? SteadyClock::Answer::kRefused : sample_clock_.take(ns);
    if (answer == SteadyClock::Answer::kRefused) continue;
    if (answer == SteadyClock::Answer::kBeganAnew) {
      joint = without_samples(joint);
      change = Change::kBeganAnew;
    }
    append_sample(heard, i, joint);
  }
  return change;
}

void StreamWindow::keep_only(std::size_t laser, std::size_t joint, StampSource laser_stamp,
                             StampSource motor_stamp) {
  RawRecording all = std::exchange(raw_, {});
  laser_ = laser;
  joint_ = joint;
  laser_stamp_ = laser_stamp;
  motor_stamp_ = motor_stamp;
  raw_.file = all.file;
  raw_.name = all.name;
  raw_.lasers.push_back(without_scans(all.lasers[laser]));
  raw_.joints.push_back(without_samples(all.joints[joint]));
  add_scans(std::move(all.lasers[laser]));
  add_samples(std::move(all.joints[joint]));
}

void StreamWindow::drop_scans_before(std::int64_t ns) {
  RawLaser& laser = raw_.lasers.front();
  const auto is_old = [&](const RawScan& scan) { return stamp_ns(scan.stamps, laser_stamp_) < ns; };
  // What stays is copied: not for every scan.
  if (4 * std::size_t(std::ranges::count_if(laser.scans, is_old)) <= laser.scans.size()) return;
  const RawLaser all = std::exchange(laser, without_scans(laser));
  for (std::size_t i = 0; i < all.scans.size(); ++i)
    if (!is_old(all.scans[i])) append_scan(all, i, laser);
}

void StreamWindow::drop_samples_before(std::int64_t ns) {
  RawJoint& joint = raw_.joints.front();
  const auto is_old = [&](const MessageStamps& stamps) { return stamp_ns(stamps, motor_stamp_) < ns; };
  if (4 * std::size_t(std::ranges::count_if(joint.stamps, is_old)) <= joint.stamps.size()) return;
  const RawJoint all = std::exchange(joint, without_samples(joint));
  for (std::size_t i = 0; i < all.stamps.size(); ++i)
    if (!is_old(all.stamps[i])) append_sample(all, i, joint);
}

RawRecording StreamWindow::without_ranges() const {
  RawRecording copy;
  copy.file = raw_.file;
  copy.name = raw_.name;
  copy.topics = raw_.topics;
  copy.joints = raw_.joints;
  copy.frames = raw_.frames;
  copy.warnings = raw_.warnings;
  for (const RawLaser& laser : raw_.lasers) {
    RawLaser& headers = copy.lasers.emplace_back(without_scans(laser));
    headers.has_intensities = false;
    headers.scans = laser.scans;
  }
  return copy;
}

RawRecording StreamWindow::with_scans(std::int64_t from_ns, std::int64_t to_ns) const {
  const RawLaser& laser = raw_.lasers.front();
  RawRecording copy;
  copy.file = raw_.file;
  copy.name = raw_.name;
  copy.joints = raw_.joints;
  RawLaser& some = copy.lasers.emplace_back(without_scans(laser));
  for (std::size_t i = 0; i < laser.scans.size(); ++i) {
    const std::int64_t ns = stamp_ns(laser.scans[i].stamps, laser_stamp_);
    if (ns >= from_ns && ns <= to_ns) append_scan(laser, i, some);
  }
  return copy;
}

std::vector<std::int64_t> StreamWindow::scan_stamps_ns() const {
  return sorted_stamps_ns(raw_.lasers.front().scans, laser_stamp_, &RawScan::stamps);
}

std::vector<std::int64_t> StreamWindow::sample_stamps_ns() const {
  return sorted_stamps_ns(raw_.joints.front().stamps, motor_stamp_, std::identity());
}

std::size_t StreamWindow::bytes() const {
  std::size_t bytes = 0;
  for (const RawLaser& laser : raw_.lasers)
    bytes += laser.scans.size() * sizeof(RawScan) + laser.directions.size() * sizeof(Eigen::Vector3f) +
             (laser.ranges_m.size() + laser.intensities.size()) * sizeof(float);
  for (const RawJoint& joint : raw_.joints)
    bytes += joint.stamps.size() * (sizeof(MessageStamps) + sizeof(double));
  return bytes;
}

}  // namespace sweepscope
