#pragma once

#include <optional>

#include "core/offset/readings/beam_readings.hpp"
#include "core/recording/formats/recording_file.hpp"
#include "core/recording/time_window.hpp"

namespace sweepscope {

/// read_recording and RecordingFile::open, where the rig file does not state the times of beams: read as the
/// geometry shows (rank_readings), with the readings that were tried in ReadReport::readings. Where another
/// reading than the recorded one is used, the recording's rig has its time_increment_s, and a warning names
/// it. Where two readings fit alike, their difference is ReadReport::beam_time_doubt_s. Of a recording that
/// is cut to a part, the sweeps of that part are ranked, and where they decide nothing those of the
/// beginning. Where the rig's profile leaves the motor's speed open, it is found before (find_profile_speed).
Result<Recording> read_fitting(const std::filesystem::path& path, const ReadOptions& options, const Job& job,
                               const std::optional<TimeWindow>& part = {});
Result<RecordingFile> open_fitting(const std::filesystem::path& path, const ReadOptions& options,
                                   const Job& job);

/// What of a recording's reading is found by the geometry; absent where the recorded or stated one is used.
struct FoundReading {
  std::optional<double> time_increment_s;  // as Rig::Laser::time_increment_s
  std::optional<Eigen::Vector3d> axis;     // that the motor turns about
  std::optional<double> turns_per_s;       // of a profile that leaves it open
};
Result<FoundReading> find_reading(const std::filesystem::path& path, const ReadOptions& options,
                                  const Job& job);

/// The rig with what was found.
Rig with_found(Rig rig, const FoundReading& found);

/// The readings of a recording that was read with these options, ranked as above; none where the rig states
/// all of them.
RankedReadings rank_unstated(const Recording& recording, const ReadOptions& options, const Job& job);

}  // namespace sweepscope
