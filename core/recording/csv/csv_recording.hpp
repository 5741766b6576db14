#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// A recording as a folder of two tables, for rigs without ROS. The first line of each that is no comment
/// names its columns, in any order; columns with other names are ignored with a warning. Cells are separated
/// by commas, semicolons or tabs (CsvTable); with the latter two, numbers may have a decimal comma. Cells may
/// be in double quotes. Stamps are decimal seconds, exact to the nanosecond; empty or 0 if there is none.
/// Numbers are written with enough digits to read back the same number; NaN and inf are "nan" and "inf".
///
/// scans.csv, a line per scan:
///   stamp_s, receive_s      when it was taken (its own clock), when it was received: at least one of the two
///   angle_min_rad, angle_increment_rad     the direction of beam 0, and from beam to beam
///   ranges_m                the beams' ranges, with spaces between them
///   intensities             as many as ranges, or none  (this and what follows may be left out)
///   time_increment_s        from beam to beam            (the rig file's or scan_time_s / beams where 0)
///   scan_time_s             from scan to scan
///   range_min_m, range_max_m    ranges outside are not used
///   topic                   the laser's name (default /scan)
/// Stamps may also be in other units (stamp_ms, receive_us, ...) or called time_s, ranges be in mm
/// (ranges_mm, range_mm), angles in degrees (angle_min_deg, angle_increment_deg). A table with a beam per
/// line has a stamp, angle_rad or angle_deg, and range_m or range_mm (csv_beams.hpp). Both tables may be as
/// `rostopic echo -p` writes them. motor.csv, a line per sample:
///   stamp_s, receive_s      as above
///   angle_rad, angle_deg or position       the joint's angle, or a raw number that the rig file's scale and
///                           zero make an angle of; they apply to angles too
///   topic, joint            names (default /joint_states and motor)
inline constexpr const char* kScansCsv = "scans.csv";
inline constexpr const char* kMotorCsv = "motor.csv";

/// The first invalid line or cell is an error that names the file, the line and the column; a truncated last
/// line is ignored with a warning.
Result<RawRecording> read_csv_recording(const std::filesystem::path& folder, const Rig& rig, const Job& job);

/// Writes both tables, each completely or not at all. The folder is created if it does not exist.
Result<void> write_csv_recording(const RawLaser& laser, const RawJoint& joint,
                                 const std::filesystem::path& folder, const Job& job);

}  // namespace sweepscope
