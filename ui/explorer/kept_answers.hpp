#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/offset/estimate.hpp"
#include "ui/model/loaded.hpp"

namespace sweepscope::ui {

/// The last estimates of this run, each of a recording and how it was read: what is opened again is not
/// estimated again.
class KeptAnswers {
 public:
  void keep(const Loaded& loaded, const Estimate& estimate);
  /// Absent if it was not estimated, or if a file of it was changed since.
  std::optional<Estimate> of(const Loaded& loaded) const;

 private:
  std::vector<std::pair<std::string, Estimate>> all_;  // oldest first
};

}  // namespace sweepscope::ui
