#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// Tells a stream's clock from single wrong stamps: a stamp that is more than 5 s from the latest one is
/// refused, until ten in a row are.
class SteadyClock {
 public:
  enum class Answer { kGoesOn, kRefused, kBeganAnew };
  Answer take(std::int64_t ns);

 private:
  std::optional<std::int64_t> latest_ns_;
  int refused_ = 0;
};

/// The part of a running system's messages that is still needed: at first of everything, then of one laser
/// and one joint. Messages may arrive in any order.
class StreamWindow {
 public:
  /// A stream's stamps jumped, so that what was there is gone.
  enum class Change { kNone, kBeganAnew };

  /// Adds what LiveSource::take() returned.
  Change add(RawRecording heard);
  /// From now on, of these alone, by these stamps; frames are forgotten.
  void keep_only(std::size_t laser, std::size_t joint, StampSource laser_stamp, StampSource motor_stamp);
  void drop_scans_before(std::int64_t ns);
  void drop_samples_before(std::int64_t ns);

  const RawRecording& raw() const { return raw_; }
  /// A copy without the beams' ranges.
  RawRecording without_ranges() const;
  /// A copy with the scans of these stamps and all samples.
  RawRecording with_scans(std::int64_t from_ns, std::int64_t to_ns) const;
  /// After keep_only: each stamp once, ascending.
  std::vector<std::int64_t> scan_stamps_ns() const;
  std::vector<std::int64_t> sample_stamps_ns() const;
  /// Of scans and samples.
  std::size_t bytes() const;

 private:
  bool chosen() const { return laser_.has_value(); }
  Change add_scans(RawLaser heard);
  Change add_samples(RawJoint heard);

  RawRecording raw_;
  std::optional<std::size_t> laser_;  // in what LiveSource::take() returns
  std::size_t joint_ = 0;
  StampSource laser_stamp_ = StampSource::kHeader, motor_stamp_ = StampSource::kHeader;
  SteadyClock scan_clock_, sample_clock_;
};

}  // namespace sweepscope
