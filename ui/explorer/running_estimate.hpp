#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "core/offset/estimate_options.hpp"
#include "ui/explorer/messages.hpp"
#include "ui/jobs/background.hpp"
#include "ui/model/growing_curve.hpp"
#include "ui/model/loaded.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// The options of the estimate that the settings ask for.
EstimateOptions estimate_asked_for(const Settings& settings, std::optional<RigKind> assume);

/// The estimate of the recording, and the one that runs.
class RunningEstimate {
 public:
  /// `found` is called with each new estimate; whether it was computed, or else read from a file or kept.
  RunningEstimate(Background& background, Messages& messages, std::function<void(bool computed)> found)
      : background_(background), messages_(messages), found_(std::move(found)) {}

  /// In place of one that runs. A failure gives a message.
  void start(LoadedPtr loaded, const EstimateOptions& options);
  bool is_running() const;
  /// In place of one that runs as well: it was read from a file, or kept.
  void set(Estimate estimate);
  /// That of a session, or none. Nobody is told.
  void restore(std::optional<Estimate> estimate);

  /// Null without one.
  const Estimate* found() const { return estimate_ ? &*estimate_ : nullptr; }
  /// What the charts show: the candidates while it runs, or the estimate; null without either.
  const Estimate* charted() const { return so_far_ ? &*so_far_ : found(); }
  /// Once per frame: takes in candidates.
  void update();

 private:
  Background& background_;
  Messages& messages_;
  std::function<void(bool computed)> found_;
  std::optional<Estimate> estimate_;
  std::shared_ptr<GrowingCurve> growing_;
  std::optional<Estimate> so_far_;  // of what grows; empty before its second candidate
};

}  // namespace sweepscope::ui
