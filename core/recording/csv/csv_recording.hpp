#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// A recording as a folder of two tables, for rigs without ROS. The first line of each names its columns, in
/// any order; columns with other names are left aside with a warning. Cells may stand in double quotes.
/// Stamps are decimal seconds, exact to the nanosecond; empty or 0 where there is none. Numbers are written
/// with as many digits as give the same number back; NaN and inf are "nan" and "inf".
///
/// scans.csv, a line per scan:
///   stamp_s, receive_s      when it was made (its own clock), when it was received: one of the two at least
///   angle_min_rad, angle_increment_rad     the direction of beam 0, and from beam to beam
///   ranges_m                the beams' ranges, with spaces between them
///   intensities             likewise, as many or none   (this and what follows may be left out)
///   time_increment_s        from beam to beam            (the rig file's or scan_time_s / beams where 0)
///   scan_time_s             from scan to scan
///   range_min_m, range_max_m    what lies outside is no range
///   topic                   the laser's name (default /scan)
/// motor.csv, a line per sample:
///   stamp_s, receive_s      as above
///   angle_rad, angle_deg or position       the joint's angle, or a raw number that the rig file's scale and
///                           zero make an angle of; they apply to angles too
///   topic, joint            names (default /joint_states and motor)
inline constexpr const char* kScansCsv = "scans.csv";
inline constexpr const char* kMotorCsv = "motor.csv";

/// The first line or cell that is not as it should be fails, with the file, the line and the column; a last
/// line that was cut short is left aside with a warning.
Result<RawRecording> read_csv_recording(const std::filesystem::path& folder, const Rig& rig, const Job& job);

/// Writes both tables, each whole or not at all. The folder is made where there is none.
Result<void> write_csv_recording(const RawLaser& laser, const RawJoint& joint,
                                 const std::filesystem::path& folder, const Job& job);

}  // namespace sweepscope
