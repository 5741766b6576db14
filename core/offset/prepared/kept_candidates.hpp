#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "core/offset/prepared/curve_point.hpp"

namespace sweepscope {

/// A store of finished candidates, so that none is computed twice. Called from any thread.
class CandidateStore {
 public:
  virtual ~CandidateStore() = default;
  /// What was computed at an offset before; absent: nothing.
  virtual std::optional<CurvePoint> find(double offset_s) = 0;
  /// Keeps what was computed.
  virtual void keep(const CurvePoint& point) = 0;
  /// The error if keeping a candidate failed, which ends the search.
  virtual std::optional<Error> failed() const = 0;
};

/// Part `number` of `count`, from 1: of the candidates of a search, ascending, each count-th from there on.
struct Shard {
  int number = 1, count = 1;  // 1 <= number <= count

  /// Those of a list that belong to it.
  template <typename T>
  std::vector<T> part_of(const std::vector<T>& all) const {
    std::vector<T> part;
    for (std::size_t i = std::size_t(number - 1); i < all.size(); i += std::size_t(count))
      part.push_back(all[i]);
    return part;
  }
};

/// Called from any thread while a search runs.
struct SearchWatch {
  /// A coarse search begins. Its costs do not compare with those of the search before: it may take other
  /// sweeps, or compare them with others.
  std::function<void()> began = {};
  /// A candidate is finished: first those of coarse searches, then those of the method. The candidates of a
  /// long recording are first those of a sample of its sweeps; if the rig moved they are computed again, of
  /// all of it.
  std::function<void(const CurvePoint&)> finished = {};
};

/// What is kept of a search, and who watches it.
struct KeptCandidates {
  CandidateStore* store = nullptr;  // null: every candidate is computed
  std::optional<Shard> shard;       // of the candidates, with a store; nothing is concluded
  SearchWatch watch = {};           // called while the search runs
};

}  // namespace sweepscope
