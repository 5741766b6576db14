#pragma once

#include <string>
#include <vector>

#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// Undo and redo of settings. Changes in one gesture (a drag of a handle) count as one.
class History {
 public:
  /// Before a change. Changes in a row with the same non-empty gesture are one step.
  void record(const Settings& before, const std::string& gesture);
  /// The previous and the next settings; the given ones are restored by the opposite call. Unchanged if there
  /// are none.
  Settings undo(const Settings& now);
  Settings redo(const Settings& now);

  bool can_undo() const { return !past_.empty(); }
  bool can_redo() const { return !future_.empty(); }

 private:
  std::vector<Settings> past_, future_;
  std::string gesture_;
};

}  // namespace sweepscope::ui
