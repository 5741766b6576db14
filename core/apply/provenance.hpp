#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

/// The stream whose stamps are moved onto the other clock.
enum class ShiftedStream { kMotor, kLaser };

/// The offset to apply, t_motor = t_laser + offset: constant, or the course of an estimate over
/// time. Times are seconds since the recording's first scan.
struct AppliedOffset {
  struct Jump {
    double time_s = 0, size_s = 0;
  };
  double offset_s = 0;
  std::optional<double> sigma_s;
  std::optional<double> middle_s;  // time of offset_s if it drifts; absent: the middle of the scans
  double rate = 0;                 // of the motor's clock relative to the laser's, minus 1
  std::vector<Jump> jumps;

  bool changes() const { return rate != 0 || !jumps.empty(); }
};

/// The offset in an estimate's JSON (schema "sweepscope.estimate/1"): offset_ms and sigma_ms; of an estimate
/// over time middle_s, rate_ppm and jumps, where a jump lies in the middle of its interval. drift_ppm is not
/// applied: an estimate with a significant drift has no offset. An estimate without an offset is
/// ExitCode::kNotIdentifiable, with its reason. `name` is the file's name in messages.
Result<AppliedOffset> parse_applied_offset(std::string_view json, std::string_view name);

/// The record of an applied offset. It is written into the recording, so that it is not applied twice.
struct Provenance {
  std::string recording;  // name of the input
  std::string estimate;   // name of the estimate's file; empty if the offset was given
  ShiftedStream shifted = ShiftedStream::kMotor;
  std::string topic, joint;
  StampSource stamp = StampSource::kHeader;
  AppliedOffset offset;
  std::uint64_t messages = 0;      // of the topic
  std::vector<std::string> added;  // topics
};

/// The record as a JSON object in one line, schema "sweepscope.apply/1".
std::string to_json(const Provenance& provenance);

}  // namespace sweepscope
