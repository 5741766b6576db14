#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/job.hpp"
#include "core/offset/kind/rig_motion.hpp"
#include "core/offset/readings/beam_readings.hpp"
#include "core/recording/formats/read_recording.hpp"
#include "core/recording/rig/named_streams.hpp"
#include "core/recording/survey/survey.hpp"
#include "core/recording/time_window.hpp"

namespace sweepscope::ui {

/// Everything that decides how a recording's file is read. What is empty is detected.
struct ReadingChoices {
  std::string file;
  std::string poses;     // TUM; empty: the trajectory is solved for
  std::string rig_file;  // empty: none
  StreamNames streams;
  std::optional<StampSource> stamps;  // of both streams
  std::optional<TimeWindow> window;   // the part that is used

  bool operator==(const ReadingChoices&) const = default;
};

/// Reads the rig file, and names the streams.
Result<ReadOptions> read_options(const ReadingChoices& choices);

/// The choices for `view` and the other subcommands, each with a space before it: " --rig F --laser /scan".
/// `whole`: files with their folders; otherwise by their names alone, as reports quote them.
std::string shell_options(const ReadingChoices& choices, bool whole);

/// Those of `given`, and where it has none those of `base`. The file is `base`'s.
ReadingChoices merged(ReadingChoices base, const ReadingChoices& given);

/// As the object "reading" of a session, without the file and the poses, which its source has. Null where
/// everything is detected.
nlohmann::ordered_json to_json(const ReadingChoices& choices);
/// Reads it back. ExitCode::kUnreadableInput with a sentence that names `name` and the key.
Result<ReadingChoices> reading_from_json(const nlohmann::ordered_json& json, const std::string& name);

/// What can be chosen for a file, what is detected with the choices at hand, and the parts in which the rig
/// stood and moved.
struct ReadingSurvey {
  RecordingSurvey streams;
  std::string problem;       // why it cannot be read like this; empty: it can, or a stream is missing
  std::string stamps_note;   // which stamps are used, and how far apart the two kinds are
  std::string motor_note;    // the unit of the motor's angles, and their range
  std::string mount_note;    // where the mount is known from
  std::string reading_note;  // how the beams are timed, with the residuals of all that was tried
  std::vector<BeamReading> readings;  // see ReadReport
  double duration_s = 0;              // 0: not known
  std::vector<MotionPart> motion;     // empty: not known
};

/// With "y" in place of "[0, 1, 0]".
std::string with_named_axes(std::string text);

/// Reads the whole file. An error only where nothing in it can be read.
Result<ReadingSurvey> survey_file(const ReadingChoices& choices, const Job& job);

}  // namespace sweepscope::ui
