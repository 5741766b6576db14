#include "core/live/live_clouds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/apply/added_messages.hpp"
#include "core/apply/added_topics.hpp"
#include "core/live/calibration.hpp"
#include "core/live/motor_so_far.hpp"
#include "core/map/place_beams.hpp"
#include "core/numbers.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "core/recording/assemble/assemble.hpp"
#include "core/recording/assemble/choose_streams.hpp"
#include "core/recording/assemble/turns.hpp"
#include "core/recording/stream_stamps.hpp"

namespace sweepscope {
namespace {

constexpr double kSecond_per_ns = 1e-9;
constexpr double kWaits_s = 120;  // the longest that a scan waits for motor samples, or for the sweep's end
constexpr double kSoon_s = 10;    // after which there is a warning that nothing is placed

std::int64_t ns_of(double time_s) {
  return std::llround(time_s * 1e9);
}

double middle_s(const LaserScan& scan) {
  return (scan.first_beam_s + scan.last_beam_s()) / 2;
}

/// The last stamp before which none is missing. One that is missing is waited for until a stamp is
/// `max_late_s` later than it.
std::int64_t complete_until_ns(const std::vector<std::int64_t>& stamps_ns, double max_late_s) {
  constexpr double kGap = 1.6;  // of the median spacing: a missing one makes 2
  std::vector<double> all_s;
  for (const std::int64_t ns : stamps_ns) all_s.push_back(double(ns - stamps_ns.front()) * kSecond_per_ns);
  const double period_s = median(spacings(all_s));
  for (std::size_t i = 1; i < all_s.size(); ++i) {
    const bool waits = all_s.back() - all_s[i - 1] - period_s <= max_late_s;
    if (waits && all_s[i] - all_s[i - 1] > kGap * period_s) return stamps_ns[i - 1];
  }
  return stamps_ns.back();
}

Recording on_laser_clock(Recording recording, double offset_s) {
  return without_offset(std::move(recording), ClockShift(offset_s));
}

}  // namespace

std::int64_t LiveCloud::stamp_ns() const {
  return epoch_ns + ns_of(begin_s);
}

/// The streams as far as they came, without ranges, the motor on the laser's clock.
struct LiveClouds::View {
  Recording recording;
  std::vector<char> covered;  // by the motor's samples, per scan
  double newest_s = 0;        // of scans
  double scans_until_s = 0;   // the middles of scans before which none is missing
  double samples_until_s = 0;
  double period_s = 0;   // of the laser's messages
  double longest_s = 0;  // of a scan, and of a cloud
  MotorSoFar motor;

  std::int64_t ns(double time_s) const { return recording.epoch_ns + ns_of(time_s); }
  /// Far in the past for kNever.
  double time_s(std::int64_t ns) const {
    return ns == kNever ? -1e9 : double(ns - recording.epoch_ns) * kSecond_per_ns;
  }
};

/// Scans that make a cloud, by their middles and their beams.
struct LiveClouds::Piece {
  std::int64_t first_middle_ns = 0, last_middle_ns = 0, begin_ns = 0, end_ns = 0;
  std::int64_t placed_ns = 0;  // up to where all is placed then
};

LiveClouds::LiveClouds(LiveCloudOptions options) : options_(std::move(options)) {}

const std::string& LiveClouds::laser_frame() const {
  return window_.raw().lasers.front().frame;
}

double LiveClouds::kept_s() const {
  return heard_so_far(window_.raw()).seconds;
}

std::optional<std::int64_t> LiveClouds::newest_scan_ns() const {
  const std::vector<std::int64_t> stamps_ns = window_.scan_stamps_ns();
  return stamps_ns.empty() ? std::nullopt : std::optional(stamps_ns.back());
}

Result<LiveNews> LiveClouds::take(RawRecording heard) {
  LiveNews news;
  news.warnings = std::exchange(heard.warnings, {});
  if (window_.add(std::move(heard)) == StreamWindow::Change::kBeganAnew) {
    begin_anew();
    news.warnings.push_back("The stamps jumped by more than 5 s: the clouds begin anew.");
  }
  if (!chosen_)
    if (auto chosen = choose(false, news); !chosen) return tl::unexpected(chosen.error());
  if (!chosen_ || !is_worth_a_look()) return news;
  LiveNews placed = place_ready(false);
  placed.warnings.insert(placed.warnings.begin(), news.warnings.begin(), news.warnings.end());
  return placed;
}

Result<LiveNews> LiveClouds::finish() {
  LiveNews news;
  if (!chosen_)
    if (auto chosen = choose(true, news); !chosen) return tl::unexpected(chosen.error());
  LiveNews placed = place_ready(true);
  placed.warnings.insert(placed.warnings.begin(), news.warnings.begin(), news.warnings.end());
  return placed;
}

Result<void> LiveClouds::choose(bool ended, LiveNews& news) {
  constexpr std::size_t kMaxBytes = 512'000'000, kMaxNames = 10'000;
  const RawRecording& raw = window_.raw();
  const HeardSoFar heard = heard_so_far(raw);
  if (window_.bytes() > kMaxBytes || raw.topics.size() + raw.joints.size() > kMaxNames)
    return unreadable(fmt::format(
        "{}: too much arrived before laser and motor could be chosen; name them in a rig file (--rig)",
        raw.file));
  if (!ended && heard.seconds < options_.choose_s) return {};
  if (heard.scans == 0)
    return unreadable(fmt::format("{}: {}", raw.file, none_received("scans", options_.rig.laser.topic)));
  if (heard.motor_samples == 0 && ended)
    return unreadable(
        fmt::format("{}: {}", raw.file,
                    none_received("motor angles", options_.rig.motor.topic, options_.rig.motor.joint)));
  const auto recording = assemble(window_.without_ranges(), options_.rig, options_.stamps);
  if (!recording && !ended && heard.seconds < kSoon_s) return {};
  if (!recording) return tl::unexpected(recording.error());
  const Rig& rig = recording->rig;
  const auto laser = choose_laser(raw, rig);
  const auto joint = choose_joint(raw, rig);
  if (!laser || !joint) return tl::unexpected(!laser ? laser.error() : joint.error());
  const auto& warnings = recording->report.warnings;
  news.warnings.insert(news.warnings.end(), warnings.begin(), warnings.end());
  window_.keep_only(*laser, *joint, *rig.laser.stamp, *rig.motor.stamp);
  chosen_ = rig;
  return {};
}

void LiveClouds::begin_anew() {
  placed_ns_ = posed_ns_ = looked_ns_ = kNever;
}

/// Looks cost as much as there are samples: not at each of them.
bool LiveClouds::is_worth_a_look() const {
  const auto& scans = window_.raw().lasers.front().scans;
  const auto& samples = window_.raw().joints.front().stamps;
  if (scans.empty() || samples.size() < 2) return false;
  if (looked_ns_ == kNever) return true;
  constexpr std::int64_t kMinStep_ns = 5'000'000;
  const StampSource stamp = *chosen_->motor.stamp;
  const std::int64_t span_ns = stamp_ns(samples.back(), stamp) - stamp_ns(samples.front(), stamp);
  const std::int64_t newest_ns = std::max(stamp_ns(scans.back().stamps, *chosen_->laser.stamp),
                                          stamp_ns(samples.back(), stamp) - ns_of(offset_s_.value_or(0)));
  return std::abs(newest_ns - looked_ns_) >= std::max(kMinStep_ns, span_ns / 1000);
}

std::optional<LiveClouds::View> LiveClouds::view() const {
  const std::vector<std::int64_t> scans_ns = window_.scan_stamps_ns(),
                                  samples_ns = window_.sample_stamps_ns();
  if (scans_ns.empty() || samples_ns.size() < 2) return std::nullopt;
  auto assembled = assemble(window_.without_ranges(), *chosen_, options_.stamps);
  if (!assembled) return std::nullopt;
  View view;
  const double offset_s = offset_s_.value_or(0);
  view.recording = on_laser_clock(std::move(*assembled), offset_s);
  const Recording& recording = view.recording;
  view.covered = scans_covered(recording, 0, 0);
  view.motor = motor_so_far(recording.motor);
  view.newest_s = view.time_s(scans_ns.back());
  view.period_s = scans_ns.size() > 1 ? double(scans_ns.back() - scans_ns.front()) * kSecond_per_ns /
                                            double(scans_ns.size() - 1)
                                      : 0;
  for (const LaserScan& scan : recording.scans)
    view.longest_s = std::max(view.longest_s, scan.last_beam_s() - scan.first_beam_s);
  view.samples_until_s = view.time_s(complete_until_ns(samples_ns, options_.max_late_s)) - offset_s;
  const double until_s = view.time_s(complete_until_ns(scans_ns, options_.max_late_s));
  view.scans_until_s = until_s;
  const bool of_clouds = window_.raw().lasers.front().of_clouds;
  if (of_clouds) view.longest_s = std::max(view.longest_s, 2 * view.period_s);
  // The newest line of a cloud may not be its last one; the newest scan of a plane is whole.
  const bool first = chosen_->laser.stamp_at == StampAt::kFirstBeam;
  for (const LaserScan& scan : recording.scans)
    if (!of_clouds && (first ? scan.first_beam_s : scan.last_beam_s()) <= until_s + 1e-7)
      view.scans_until_s = middle_s(scan);
  return view;
}

std::vector<LiveClouds::Piece> LiveClouds::ready_scans(const View& view, bool ended) const {
  const auto& scans = view.recording.scans;
  const bool of_clouds = window_.raw().lasers.front().of_clouds;
  const std::vector<std::int64_t> stamps_ns =
      of_clouds ? window_.scan_stamps_ns() : std::vector<std::int64_t>();
  const auto cloud_of = [&](std::size_t i) {
    return std::ranges::upper_bound(stamps_ns, view.ns(scans[i].first_beam_s)) - stamps_ns.begin();
  };
  std::vector<Piece> pieces;
  std::optional<std::ptrdiff_t> cloud;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::int64_t middle_ns = view.ns(middle_s(scans[i]));
    if (placed_ns_ != kNever && middle_ns < placed_ns_) continue;
    const bool here =
        middle_s(scans[i]) <= view.scans_until_s && scans[i].last_beam_s() <= view.samples_until_s;
    if (!ended && !here) break;
    if (view.covered[i] == 0) continue;
    if (!of_clouds || cloud != cloud_of(i))
      pieces.push_back({middle_ns, middle_ns, view.ns(scans[i].first_beam_s), 0, 0});
    cloud = cloud_of(i);
    pieces.back().last_middle_ns = middle_ns;
    pieces.back().placed_ns = middle_ns + 1;
    pieces.back().end_ns = view.ns(scans[i].last_beam_s());
  }
  // Of the last cloud more lines may follow.
  if (of_clouds && !ended && !pieces.empty()) pieces.pop_back();
  return pieces;
}

std::vector<LiveClouds::Piece> LiveClouds::ready_sweeps(const View& view, bool ended) const {
  constexpr double kSame_s = 0.005;  // one reversal, found anew
  constexpr double kEarly = 0.2;     // of a period: the next scan is not that much before its time
  const auto& scans = view.recording.scans;
  const bool of_clouds = window_.raw().lasers.front().of_clouds;
  const double next_scan_s = view.scans_until_s + (of_clouds ? 0 : (1 - kEarly) * view.period_s);
  double placed_s = view.time_s(placed_ns_);
  std::vector<Piece> pieces;
  for (const Sweep& sweep : view.motor.ended(ended)) {
    if (sweep.end_s <= placed_s) continue;
    if (!ended && (next_scan_s <= sweep.end_s || view.samples_until_s < sweep.end_s)) break;
    const bool goes_on = std::abs(sweep.begin_s - placed_s) < kSame_s;
    const double from_s = goes_on ? placed_s : std::max(sweep.begin_s, placed_s);
    std::optional<Piece> piece;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      const double at_s = middle_s(scans[i]);
      if (at_s < from_s || at_s >= sweep.end_s || view.covered[i] == 0) continue;
      if (!ended && scans[i].last_beam_s() > view.samples_until_s) return pieces;
      if (!piece) piece = Piece{view.ns(at_s), 0, view.ns(scans[i].first_beam_s), 0, view.ns(sweep.end_s)};
      piece->last_middle_ns = view.ns(at_s);
      piece->end_ns = view.ns(scans[i].last_beam_s());
    }
    if (piece) pieces.push_back(*piece);
    placed_s = sweep.end_s;
  }
  return pieces;
}

std::optional<LiveCloud> LiveClouds::place(const View& view, const Piece& piece) const {
  constexpr std::int64_t kSame_ns = 100;  // times are rounded in between
  constexpr double kForEver_s = 1e9;
  const RawLaser& laser = window_.raw().lasers.front();
  // What the beams' times are judged by, beside the scans themselves.
  const double before_s = laser.of_clouds ? 0 : 12 * view.period_s;
  const std::int64_t scan_ns = ns_of(view.longest_s) + kSame_ns;
  RawRecording part = window_.with_scans(piece.begin_ns - ns_of(before_s) - scan_ns, piece.end_ns + scan_ns);
  const bool parts_of_turns =
      !laser.of_clouds && turns_of_messages(part.lasers.front().scans).per_message != 1;
  auto assembled = assemble(std::move(part), *chosen_, options_.stamps);
  if (!assembled) return std::nullopt;
  const Recording recording = on_laser_clock(std::move(*assembled), *offset_s_);
  const auto ns = [&](double time_s) { return recording.epoch_ns + ns_of(time_s); };
  MapPath path;
  path.used = scans_covered(recording, 0, 0);
  path.sweeps.push_back({-kForEver_s, kForEver_s});
  std::optional<LiveCloud> cloud;
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    const LaserScan& scan = recording.scans[i];
    const std::int64_t middle_ns = ns(middle_s(scan));
    const bool within =
        parts_of_turns
            ? ns(scan.last_beam_s()) >= piece.begin_ns && ns(scan.first_beam_s) <= piece.end_ns
            : middle_ns >= piece.first_middle_ns - kSame_ns && middle_ns <= piece.last_middle_ns + kSame_ns;
    path.used[i] = path.used[i] != 0 && within ? 1 : 0;
    if (path.used[i] == 0) continue;
    if (!cloud) cloud = LiveCloud{recording.epoch_ns, scan.first_beam_s, scan.last_beam_s(), {}};
    cloud->end_s = std::max(cloud->end_s, scan.last_beam_s());
  }
  if (!cloud) return cloud;
  cloud->points = place_scans(recording, ScanPoses(recording, path, 0), {0, recording.scans.size()});
  if (!parts_of_turns) return cloud;
  // Turns that were put together hold beams of the scans before, too.
  std::erase_if(cloud->points.points, [&](const MapPoint& point) {
    return ns(point.time_s) < piece.begin_ns - kSame_ns || ns(point.time_s) > piece.end_ns + kSame_ns;
  });
  cloud->points.width = static_cast<std::uint32_t>(cloud->points.points.size());
  cloud->begin_s = double(piece.begin_ns - recording.epoch_ns) * kSecond_per_ns;
  cloud->end_s = double(piece.end_ns - recording.epoch_ns) * kSecond_per_ns;
  return cloud;
}

void LiveClouds::add_poses(const View& view, bool ended, LiveNews& news) {
  const MotorTrack& motor = view.recording.motor;
  for (std::size_t i = 0; i < motor.time_s.size(); ++i) {
    const std::int64_t ns = view.ns(motor.time_s[i]);
    if (ns <= posed_ns_ || (!ended && motor.time_s[i] > view.samples_until_s + 1e-7)) continue;
    news.poses.push_back({ns, base_from_laser(view.recording.rig.mount, motor.angle_rad[i])});
    posed_ns_ = ns;
  }
}

LiveNews LiveClouds::place_ready(bool ended) {
  LiveNews news;
  const auto seen = view();
  if (!seen) return news;
  const View& view = *seen;
  looked_ns_ = std::max(view.ns(view.newest_s), view.ns(view.samples_until_s));
  if (offset_s_) {
    for (const Piece& piece : options_.each_scan ? ready_scans(view, ended) : ready_sweeps(view, ended)) {
      if (auto cloud = place(view, piece)) news.clouds.push_back(std::move(*cloud));
      placed_ns_ = piece.placed_ns;
    }
    add_poses(view, ended, news);
  }
  const bool behind = view.newest_s - view.samples_until_s > kSoon_s;
  if (behind && !behind_)
    news.warnings.push_back(
        fmt::format("The motor's angles are {:.0f} s behind the scans: the clouds wait for them.",
                    view.newest_s - view.samples_until_s));
  const bool rests = !options_.each_scan && !behind && view.motor.rested_s(view.newest_s) > kSoon_s;
  if (rests && !rests_)
    news.warnings.push_back("The motor has not turned for 10 s: no sweep ends, and there are no clouds.");
  behind_ = behind;
  rests_ = rests;
  forget(view);
  return news;
}

/// What no later cloud needs.
void LiveClouds::forget(const View& view) {
  constexpr std::size_t kMaxBytes = 256'000'000;
  const double context_s = std::max(1.0, 20 * view.period_s);
  const double placed_s = view.time_s(placed_ns_);
  const double oldest_s = view.newest_s - (offset_s_ ? kWaits_s : std::max(kSoon_s, options_.keep_s + 1));
  double scans_s = options_.each_scan ? placed_s : view.motor.begin_s_after(placed_s, view.newest_s - 5);
  const double kept_s = view.newest_s - options_.keep_s - 1;
  scans_s = std::max(oldest_s, std::min(scans_s - context_s, kept_s));
  if (window_.bytes() > kMaxBytes) scans_s = std::max(scans_s, (view.newest_s + scans_s) / 2);
  window_.drop_scans_before(view.ns(scans_s));
  const double needed_s = view.motor.needed_from_s(placed_s, view.newest_s) - context_s;
  const double samples_s = std::max(oldest_s, std::min(needed_s, kept_s));
  window_.drop_samples_before(view.ns(samples_s + offset_s_.value_or(0)));
}

}  // namespace sweepscope
