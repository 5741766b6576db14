#pragma once

#include "core/recording/formats/recording_file.hpp"

namespace sweepscope {

/// read_recording and RecordingFile::open, where the rig file does not state the times of beams: read as the
/// geometry shows (rank_readings), with the readings that were tried in ReadReport::readings. Where another
/// reading than the recorded one is used, the recording's rig has its time_increment_s, and a warning names
/// it. Where two readings fit alike, their difference is ReadReport::beam_time_doubt_s.
Result<Recording> read_fitting(const std::filesystem::path& path, const ReadOptions& options, const Job& job);
Result<RecordingFile> open_fitting(const std::filesystem::path& path, const ReadOptions& options,
                                   const Job& job);

/// What of a recording's reading is found by the geometry; absent where the recorded or stated one is used.
struct FoundReading {
  std::optional<double> time_increment_s;  // as Rig::Laser::time_increment_s
  std::optional<Eigen::Vector3d> axis;     // that the motor turns about
};
Result<FoundReading> find_reading(const std::filesystem::path& path, const ReadOptions& options,
                                  const Job& job);

/// The rig with what was found.
Rig with_found(Rig rig, const FoundReading& found);

}  // namespace sweepscope
