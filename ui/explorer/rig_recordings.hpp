#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/offset/estimate.hpp"
#include "ui/explorer/messages.hpp"
#include "ui/jobs/background.hpp"
#include "ui/model/loaded.hpp"

namespace sweepscope::ui {

/// Recordings of one rig, for one answer from all of them (see estimate_together): the one that is open, and
/// those that were added to it. They are all read like the one that is open.
class RigRecordings {
 public:
  /// `found` is called with each answer, on the thread that takes finished work.
  RigRecordings(Background& background, Messages& messages, std::function<void(Estimate)> found)
      : background_(background), messages_(messages), found_(std::move(found)) {}

  /// In the order in which they were added, the open one before the first; empty if none was.
  const std::vector<std::string>& files() const { return files_; }
  /// ExitCode::kWrongUsage for one that is in the list, or if a sample or nothing is open.
  Result<void> add(const Loaded* open, const std::string& file);
  /// Counted from 1; not the one that is open. With the last of the others the list ends.
  Result<void> leave_out(const Loaded* open, std::size_t number);
  /// A recording that is not in the list, or null, ends it.
  void opened(const Loaded* loaded);
  /// With an offset for each, or one for all.
  Result<void> estimate(LoadedPtr open, const EstimateOptions& options, bool own_offsets);
  bool is_running() const;

 private:
  Background& background_;
  Messages& messages_;
  std::function<void(Estimate)> found_;
  std::vector<std::string> files_;
};

}  // namespace sweepscope::ui
