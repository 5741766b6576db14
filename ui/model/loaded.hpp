#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/job.hpp"
#include "core/map/replace_points.hpp"
#include "core/offset/estimator.hpp"
#include "core/recording/inspect.hpp"
#include "core/recording/read_recording.hpp"

namespace sweepscope::ui {

/// A recording that is open, and what is worked out once for it.
struct Loaded {
  std::string source;  // the command line that opens it again: `open FILE` or `sample SCENE`
  std::string shell;   // how a shell names it: REC of the command line
  Recording recording;
  RecordingSummary summary;
  MotorMotion motor;
  Beams beams;                    // of this->recording
  std::optional<bool> moving;     // what the motion test said; empty: too short to tell
  std::optional<double> truth_s;  // of a simulation

  double duration_s() const {
    return recording.scans.empty()
               ? 0
               : recording.scans.back().first_beam_s - recording.scans.front().first_beam_s;
  }
};
using LoadedPtr = std::shared_ptr<const Loaded>;

Result<LoadedPtr> load_file(const std::filesystem::path& path, const ReadOptions& options, const Job& job);
/// A simulated recording; seconds 0: all of the walk.
Result<LoadedPtr> load_sample(const std::string& scene, double seconds, const Job& job);

}  // namespace sweepscope::ui
