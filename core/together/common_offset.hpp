#pragma once

// The mathematics: docs/rig.md, "Several recordings".

#include <optional>
#include <vector>

#include "core/offset/estimate.hpp"

namespace sweepscope {

/// How the offsets of several recordings scatter about their weighted mean.
struct OffsetAgreement {
  double chi_square = 0;
  int degrees_of_freedom = 0;
  std::optional<std::size_t> odd_one;  // without which chi_square is least; absent for fewer than three
  double odd_apart_s = 0;              // its distance from the mean of the others
};

/// The weighted mean of the offsets that were found.
struct CommonOffset {
  std::optional<double> offset_s, sigma_s;  // absent if none was found
  std::vector<SigmaPart> sigma_parts;
  std::vector<double> shares;  // of each estimate: its part of the weight
  OffsetAgreement agreement;
};

/// Weighted by 1 / sigma^2. Of the parts of sigma the statistical one averages out; the others, such as the
/// encoder's, are taken to be the same error in all recordings. Sigma is widened where the offsets scatter
/// more than theirs say.
CommonOffset common_offset(const std::vector<const Estimate*>& found);

}  // namespace sweepscope
