#pragma once

#include <optional>
#include <vector>

#include "core/offset/estimator.hpp"

namespace sweepscope {

/// Where finished candidates are kept, so that none is computed twice. Called from any thread.
class CandidateStore {
 public:
  virtual ~CandidateStore() = default;
  virtual std::optional<CurvePoint> find(double offset_s) = 0;
  virtual void keep(const CurvePoint& point) = 0;
  /// Why the search cannot go on, where keeping failed.
  virtual std::optional<Error> failed() const = 0;
};

/// Part `number` of `count`, from 1: of the candidates of a search, ascending, each count-th from there on.
struct Shard {
  int number = 1, count = 1;

  template <typename T>
  std::vector<T> part_of(const std::vector<T>& all) const {
    std::vector<T> part;
    for (std::size_t i = std::size_t(number - 1); i < all.size(); i += std::size_t(count))
      part.push_back(all[i]);
    return part;
  }
};

/// As `estimate` without a store, with its bytes; candidates come from the store where they are there. With a
/// shard only its candidates are computed and nothing is concluded. ExitCode::kWrongUsage too for the direct
/// method, which keeps no candidates, and for a shard of the default search, which decides where to look as
/// it goes.
Result<Estimate> estimate(const Recording& recording, const EstimateOptions& options, CandidateStore& store,
                          std::optional<Shard> shard, const Job& job);

}  // namespace sweepscope
