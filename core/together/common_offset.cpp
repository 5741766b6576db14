#include "core/together/common_offset.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope {
namespace {

// Weights of the offsets that were found; 0 for the others and for `without`.
std::vector<double> weights_of(const std::vector<const Estimate*>& found, std::size_t without = SIZE_MAX) {
  std::vector<double> weights(found.size(), 0);
  double sum = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (i == without || !found[i]->identifiable || !found[i]->sigma_s || !(*found[i]->sigma_s > 0)) continue;
    weights[i] = 1 / (*found[i]->sigma_s * *found[i]->sigma_s);
    sum += weights[i];
  }
  for (double& weight : weights) weight = sum > 0 ? weight / sum : 0;
  return weights;
}

double mean_s(const std::vector<const Estimate*>& found, const std::vector<double>& weights) {
  double mean = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (weights[i] > 0) mean += weights[i] * *found[i]->offset_s;
  return mean;
}

double chi_square_of(const std::vector<const Estimate*>& found, const std::vector<double>& weights) {
  const double mean = mean_s(found, weights);
  double chi_square = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (weights[i] > 0) chi_square += std::pow((*found[i]->offset_s - mean) / *found[i]->sigma_s, 2);
  return chi_square;
}

OffsetAgreement agreement_of(const std::vector<const Estimate*>& found, const std::vector<double>& weights) {
  OffsetAgreement agreement;
  const auto counted = std::ranges::count_if(weights, [](double weight) { return weight > 0; });
  if (counted < 2) return agreement;
  agreement.chi_square = chi_square_of(found, weights);
  agreement.degrees_of_freedom = int(counted - 1);
  double min_without = agreement.chi_square;
  for (std::size_t i = 0; counted >= 3 && i < found.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    const std::vector<double> others = weights_of(found, i);
    const double without = chi_square_of(found, others);
    if (without >= min_without) continue;
    min_without = without;
    agreement.odd_one = i;
    agreement.odd_apart_s = *found[i]->offset_s - mean_s(found, others);
  }
  return agreement;
}

// The parts of all, in the order in which they appear.
std::vector<SigmaPart> parts_of(const std::vector<const Estimate*>& found,
                                const std::vector<double>& weights) {
  std::vector<SigmaPart> parts;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    for (const SigmaPart& part : found[i]->sigma_parts) {
      auto at = std::ranges::find(parts, part.name, &SigmaPart::name);
      if (at == parts.end()) at = parts.insert(at, {part.name, 0});
      const double weighted_s = weights[i] * part.sigma_s;
      at->sigma_s =
          part.name == "statistical" ? std::hypot(at->sigma_s, weighted_s) : at->sigma_s + weighted_s;
    }
  }
  return parts;
}

}  // namespace

CommonOffset common_offset(const std::vector<const Estimate*>& found) {
  CommonOffset common;
  common.shares = weights_of(found);
  common.agreement = agreement_of(found, common.shares);
  if (std::ranges::none_of(common.shares, [](double share) { return share > 0; })) return common;
  common.offset_s = mean_s(found, common.shares);
  common.sigma_parts = parts_of(found, common.shares);
  if (common.agreement.degrees_of_freedom > 0) {
    const double excess = common.agreement.chi_square / common.agreement.degrees_of_freedom;
    for (SigmaPart& part : common.sigma_parts)
      if (part.name == "statistical") part.sigma_s *= std::sqrt(std::max(1.0, excess));
  }
  double variance_s2 = 0;
  for (const SigmaPart& part : common.sigma_parts) variance_s2 += part.sigma_s * part.sigma_s;
  common.sigma_s = std::sqrt(variance_s2);
  return common;
}

}  // namespace sweepscope
