#pragma once

#include <utility>
#include <vector>

#include "ui/jobs/background.hpp"
#include "ui/model/placed_cloud.hpp"

namespace sweepscope::ui {

/// The blur of the last maps, by their placement: how thick their surfaces are.
class KnownBlur {
 public:
  explicit KnownBlur(Background& background) : background_(background) {}

  /// Null if it is not known.
  const SlowValues* at(const Placement& placement) const;
  void keep(const Placement& placement, SlowValues values);
  /// Measures both maps in the background, as far as they are not known: seconds of work for a walk.
  void measure(const Placement& a, const Placement& b);
  void close();

 private:
  Background& background_;
  std::vector<std::pair<Placement, SlowValues>> known_;  // oldest first
};

}  // namespace sweepscope::ui
