#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/job.hpp"
#include "core/map/place_beams.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "core/offset/walk/walk.hpp"
#include "core/recording/formats/read_recording.hpp"
#include "core/recording/inspect.hpp"
#include "ui/state/reading_choices.hpp"

namespace sweepscope::ui {

/// A moving rig's trajectory, once it was solved for: every map is placed along it.
class KnownWalk {
 public:
  std::shared_ptr<const SolvedWalk> get() const {
    const std::lock_guard lock(mutex_);
    return walk_;
  }
  /// The first one, or the one that it was replaced by since its map did not agree with itself.
  void keep(std::shared_ptr<const SolvedWalk> walk) {
    const std::lock_guard lock(mutex_);
    if (!walk_ || (walk && walk->tracked_again && !walk_->tracked_again)) walk_ = std::move(walk);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const SolvedWalk> walk_;
};

/// An open recording, and everything that is computed once for it.
struct Loaded {
  std::string source;      // the command line that opens it again: `open FILE` or `sample SCENE`
  ReadingChoices choices;  // how its file was read; without a file: a sample
  Recording recording;
  RecordingSummary summary;
  PreparedRecording prepared;  // of this->recording
  std::shared_ptr<KnownWalk> walk = std::make_shared<KnownWalk>();
  Beams beams;                                  // of this->recording
  std::optional<bool> moving;                   // result of the motion test; empty: too short to decide
  std::optional<double> truth_s;                // of a simulation
  std::vector<StampedPose> poses;               // the given trajectory of the rig; empty: solved for
  double min_intensity = 0, max_intensity = 1;  // of nearly all beams

  double duration_s() const {
    return recording.scans.empty()
               ? 0
               : recording.scans.back().first_beam_s - recording.scans.front().first_beam_s;
  }
};
using LoadedPtr = std::shared_ptr<const Loaded>;

Result<LoadedPtr> load_file(const ReadingChoices& choices, const Job& job);
/// A simulated recording; seconds 0: all of the walk.
Result<LoadedPtr> load_sample(const std::string& scene, double seconds, const Job& job);

}  // namespace sweepscope::ui
