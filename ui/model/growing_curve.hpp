#pragma once

#include <limits>
#include <mutex>
#include <vector>

#include "core/offset/estimate.hpp"

namespace sweepscope::ui {

/// The candidates of an estimate while it is computed. Used by several threads.
class GrowingCurve {
 public:
  /// Without what coarse searches try beyond `reach_s`, for clocks that differ by seconds: it would squeeze
  /// the others.
  explicit GrowingCurve(double reach_s = std::numeric_limits<double>::infinity()) : reach_s_(reach_s) {}

  /// A coarse search begins: its costs do not compare with those of the search before.
  void begin();
  void add(const CurvePoint& point);
  /// An estimate without an answer, with the candidates that are finished, ascending: those of the method,
  /// or, before there is one, those of one coarse search: the last, once it has half as many as the one
  /// before.
  Estimate so_far() const;
  std::size_t size() const;

 private:
  std::vector<CurvePoint> candidates(bool of_method) const;

  double reach_s_;
  mutable std::mutex mutex_;
  std::vector<std::vector<CurvePoint>> searches_ = {{}};
};

}  // namespace sweepscope::ui
