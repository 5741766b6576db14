#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/offset/estimate.hpp"
#include "ui/jobs/background.hpp"
#include "ui/model/solved_map.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// What a session holds beside its recording, applied once that is open.
struct Restored {
  Settings settings;
  std::optional<Estimate> estimate;
  bool of_part = false;  // of a recording whose answer is that of a part, which is opened in its place
};

/// How opening a recording ended.
struct Opened {
  ReadingChoices choices;  // of its file; without a file: a sample
  std::optional<Restored> restored;
  Result<LoadedPtr> loaded;
  SolvedMapPtr first_map;
  std::optional<ReadingSurvey> survey;  // where it could not be opened and there is something to choose from
};

/// The recording that is open, and the one that is being opened in its place.
class OpenRecording {
 public:
  /// `ended` is called by Background::take_finished, unless the work was cancelled.
  OpenRecording(Background& background, std::optional<RigKind> assume, std::function<void(Opened)> ended)
      : background_(background), assume_(assume), ended_(std::move(ended)) {}

  const LoadedPtr& loaded() const { return loaded_; }
  void keep(LoadedPtr loaded) { loaded_ = std::move(loaded); }
  void close() { loaded_ = nullptr; }

  void read(const ReadingChoices& choices, std::optional<Restored> restored);
  /// See load_sample.
  void simulate(const std::string& scene, double seconds, std::optional<Restored> restored);
  bool is_opening() const;
  /// Why the last recording could not be opened; empty if it was opened or is still being opened.
  const std::optional<Error>& failure() const { return failure_; }
  void fail(const Error& why) { failure_ = why; }

 private:
  void start(const std::string& title, std::vector<TaskStep> steps,
             std::function<Result<LoadedPtr>(const Job&)> load, Opened result);

  Background& background_;
  std::optional<RigKind> assume_;
  std::function<void(Opened)> ended_;
  LoadedPtr loaded_;
  std::optional<Error> failure_;
};

}  // namespace sweepscope::ui
