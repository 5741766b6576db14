#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

/// Whose stamps are moved onto the other's clock.
enum class ShiftedStream { kMotor, kLaser };

/// An offset that is to be applied, t_motor = t_laser + offset: constant, or the course of an estimate over
/// time. Times are seconds since the recording's first scan.
struct AppliedOffset {
  struct Jump {
    double time_s = 0, size_s = 0;
  };
  double offset_s = 0;
  std::optional<double> sigma_s;
  std::optional<double> middle_s;  // where the offset holds, if it drifts; else in the middle of the scans
  double rate = 0;                 // by how much the motor's clock runs faster than the laser's
  std::vector<Jump> jumps;

  bool changes() const { return rate != 0 || !jumps.empty(); }
};

/// The offset in an estimate's JSON (schema "sweepscope.estimate/1"): offset_ms and sigma_ms; of an estimate
/// over time middle_s, rate_ppm and jumps, where a jump lies in the middle of its interval. drift_ppm is not
/// applied: an estimate in which it is more than noise has no offset. An estimate without an offset is
/// ExitCode::kNotIdentifiable, with its reason. `name` stands for the file in messages.
Result<AppliedOffset> parse_applied_offset(std::string_view json, std::string_view name);

/// What was done to a recording: written into it, so that nobody does it twice.
struct Provenance {
  std::string recording;  // the name of the one that was read
  std::string estimate;   // the name of the estimate's file; empty where the offset was given
  ShiftedStream shifted = ShiftedStream::kMotor;
  std::string topic, joint;
  StampSource stamp = StampSource::kHeader;
  AppliedOffset offset;
  std::uint64_t messages = 0;  // of the topic
};

/// The record: a JSON object in one line, schema "sweepscope.apply/1".
std::string to_json(const Provenance& provenance);

/// Where the record is kept: a topic of std_msgs/String in a ROS 1 bag, a metadata record in an MCAP file, a
/// table in a database.
inline constexpr const char* kAppliedTopic = "/sweepscope/applied";
inline constexpr const char* kAppliedMetadata = "sweepscope.apply";
inline constexpr const char* kAppliedTable = "sweepscope_apply";

}  // namespace sweepscope
