#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// The usable samples of a joint, in the order of the file. `publisher`: empty if unknown.
struct JointSamples {
  std::vector<double>& times_s;
  std::vector<double>& angles_rad;
  std::vector<std::uint16_t>& publisher;
};

/// Keeps the samples of one publisher where several publish the joint at the same time, and warns: of those
/// that move the one that sends most new angles. The others stand still or send its angles again; where one
/// moves otherwise, report.motor_faults.sources names both.
void keep_one_publisher(const RawJoint& raw, JointSamples samples, ReadReport& report);

/// Leaves out one constant angle that is interleaved with a motion, as a node sends it that knows no other,
/// and warns. For recordings that do not name publishers.
void leave_out_constant(const RawJoint& raw, MotorTrack& motor, ReadReport& report);

/// Names two interleaved motions of one joint; empty where there is one.
std::string interleaved_sources(const RawJoint& raw, const MotorTrack& motor);

}  // namespace sweepscope
