#pragma once

#include <mutex>
#include <vector>

#include "core/offset/estimate.hpp"

namespace sweepscope::ui {

/// The candidates of an estimate while it is computed. Used by several threads.
class GrowingCurve {
 public:
  void add(const CurvePoint& point);
  /// An estimate without an answer, with the candidates that are finished, ascending: those of the method,
  /// or, before there is one, those of the coarse search.
  Estimate so_far() const;
  std::size_t size() const;

 private:
  mutable std::mutex mutex_;
  std::vector<CurvePoint> points_;
};

}  // namespace sweepscope::ui
