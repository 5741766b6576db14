#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/live/live_clouds.hpp"
#include "core/live/running_estimate.hpp"

namespace sweepscope {

/// An offset with its standard deviation, which is 0 where it was given.
struct FollowedOffset {
  double offset_s = 0, sigma_s = 0;
};

/// Estimates the offset of live clouds anew, again and again, from their last seconds. An estimate counts if
/// the rig was stationary in them; it replaces the offset in use if it differs by more than the standard
/// deviation of the difference. It takes a tenth of a core at most.
class OffsetFollower {
 public:
  /// `options.seconds`: of scans that an estimate uses; LiveCloudOptions::keep_s must be as long.
  OffsetFollower(CalibrationOptions options, std::optional<double> given_s);

  /// Call after each LiveClouds::take(). Sets the clouds' offset where it changes; returns what to say then.
  std::vector<std::string> follow(LiveClouds& clouds);
  /// The input ended: waits for an estimate if there is no offset yet.
  std::vector<std::string> finish(LiveClouds& clouds);

  const std::optional<FollowedOffset>& offset() const { return offset_; }

 private:
  void begin(LiveClouds& clouds);
  std::vector<std::string> judge(const Result<Estimate>& found, LiveClouds& clouds);

  CalibrationOptions options_;
  std::optional<FollowedOffset> offset_;
  std::int64_t begun_ns_ = 0;  // the newest scan then
  double pause_s_ = 0;         // before the next one
  bool refusal_said_ = false;
  std::chrono::steady_clock::time_point began_;
  RunningEstimate running_;
};

}  // namespace sweepscope
