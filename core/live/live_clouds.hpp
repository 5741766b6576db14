#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/geometry/map_cloud.hpp"
#include "core/geometry/pose.hpp"
#include "core/live/stream_window.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

struct LiveCloudOptions {
  Rig rig;
  std::optional<StampSource> stamps;  // of both streams, overrides the rig
  bool each_scan = false;             // a cloud for each scan; otherwise for each sweep
  double choose_s = 2;                // of scans, before laser and motor are chosen
  /// How long missing messages are waited for, by the stamps of later ones.
  double max_late_s = 0.25;
  double keep_s = 0;  // of scans, for kept()
};

/// A sweep or a scan in the base frame, as of a stationary rig. The points' times count from `epoch_ns`.
struct LiveCloud {
  std::int64_t epoch_ns = 0;
  double begin_s = 0, end_s = 0;  // first and last beam, laser clock
  MapCloud points;
  std::int64_t stamp_ns() const;  // of the first beam
};

/// The laser's pose in the base frame at an instant of the laser's clock.
struct LivePose {
  std::int64_t stamp_ns = 0;
  Pose base_from_laser;
};

/// What became ready, in the order of time.
struct LiveNews {
  std::vector<LiveCloud> clouds;
  std::vector<LivePose> poses;        // at each of the motor's samples
  std::vector<std::string> warnings;  // whole sentences for a person
};

/// Corrected clouds of a running rig. Scans and motor samples are added in any order; a cloud is placed once
/// the motor's samples cover it and no earlier message is missing. Beams are placed as `apply --clouds`
/// places those of a recording of a stationary rig. A sweep is complete once the motor has turned back by a
/// twentieth of its range, or has rested for longer than the sweep took; of a motor that turns one way, after
/// each half turn. Memory does not grow with time.
///
/// At the beginning the streams are heard for LiveCloudOptions::choose_s to choose laser, motor, stamps and
/// mount, as for a recording. The clouds of that time follow then.
class LiveClouds {
 public:
  explicit LiveClouds(LiveCloudOptions options);

  /// The offset of the clouds that follow. Without one nothing is placed, and the last seconds are kept.
  void set_offset(double offset_s) { offset_s_ = offset_s; }
  /// Adds what LiveSource::take() returned. Fails where laser or motor cannot be chosen.
  Result<LiveNews> take(RawRecording heard);
  /// The input ended: places the rest. Fails where there was too little to choose laser and motor.
  Result<LiveNews> finish();

  /// The rig, completed by what was detected; nothing before laser and motor are chosen.
  const std::optional<Rig>& rig() const { return chosen_; }
  /// The last LiveCloudOptions::keep_s of the laser's scans and the motor's samples, or longer.
  const RawRecording& kept() const { return window_.raw(); }
  double kept_s() const;
  std::optional<std::int64_t> newest_scan_ns() const;
  /// Of the laser's messages.
  const std::string& laser_frame() const;

 private:
  struct View;
  struct Piece;

  Result<void> choose(bool ended, LiveNews& news);
  LiveNews place_ready(bool ended);
  bool is_worth_a_look() const;
  std::optional<View> view() const;
  std::vector<Piece> ready_scans(const View& view, bool ended) const;
  std::vector<Piece> ready_sweeps(const View& view, bool ended) const;
  std::optional<LiveCloud> place(const View& view, const Piece& piece) const;
  void add_poses(const View& view, bool ended, LiveNews& news);
  void forget(const View& view);
  void begin_anew();

  LiveCloudOptions options_;
  StreamWindow window_;
  std::optional<Rig> chosen_;
  std::optional<double> offset_s_;
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();
  std::int64_t placed_ns_ = kNever;      // the middle of the last scan that is placed or left out
  std::int64_t posed_ns_ = kNever;       // the last of LiveNews::poses
  std::int64_t looked_ns_ = kNever;      // the newest stamp at the last look
  bool behind_ = false, rests_ = false;  // warned of
};

}  // namespace sweepscope
