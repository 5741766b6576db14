#include "core/uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sweepscope {
namespace {

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / double(values.size());
}

double squares_about(const std::vector<double>& values, double mean) {
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return sum;
}

}  // namespace

double student_factor(double degrees_of_freedom) {
  const double nu = std::max(1.0, degrees_of_freedom);
  return 1 + 0.5 / nu + 0.25 / (nu * nu);
}

std::optional<double> jackknife_sigma(double estimate, const std::vector<WithoutPart>& without) {
  constexpr double kMinShare = 1e-3;  // of less, pseudo-values are differences of rounding errors
  double shares = 0;
  for (const WithoutPart& part : without) shares += std::max(0.0, part.share);
  // Pseudo-values less the estimate, so that parts that are skipped take no part of it along.
  std::vector<double> pseudo_values, ratios;  // h = 1 / share
  for (const WithoutPart& part : without) {
    const double share = part.share / shares;
    if (!(share > kMinShare) || !(share < 1 - kMinShare)) continue;
    ratios.push_back(1 / share);
    pseudo_values.push_back((1 / share - 1) * (estimate - part.value));
  }
  if (pseudo_values.size() < 3) return std::nullopt;
  const double n = double(pseudo_values.size());
  double mean = 0, variance = 0;
  for (std::size_t i = 0; i < ratios.size(); ++i) mean += pseudo_values[i] / ratios[i];
  for (std::size_t i = 0; i < ratios.size(); ++i)
    variance += (pseudo_values[i] - mean) * (pseudo_values[i] - mean) / (ratios[i] - 1) / n;
  return student_factor(n - 1) * std::sqrt(variance);
}

std::optional<double> block_sigma(const std::vector<double>& series, std::size_t min_length,
                                  std::size_t max_blocks) {
  const std::size_t blocks = std::min(max_blocks, series.size() / std::max<std::size_t>(1, min_length));
  if (blocks < 3) return std::nullopt;
  std::vector<double> means(blocks, 0.0);
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t from = series.size() * b / blocks, to = series.size() * (b + 1) / blocks;
    for (std::size_t i = from; i < to; ++i) means[b] += series[i] / double(to - from);
  }
  const double n = double(blocks);
  return student_factor(n - 1) * std::sqrt(squares_about(means, mean_of(means)) / (n - 1) / n);
}

std::optional<Trend> trend_of(const std::vector<double>& times, const std::vector<double>& values) {
  if (times.size() < 4 || times.size() != values.size()) return std::nullopt;
  const double n = double(times.size()), time = mean_of(times), value = mean_of(values);
  const double spread = squares_about(times, time);
  if (!(spread > 0)) return std::nullopt;
  Trend trend;
  for (std::size_t i = 0; i < times.size(); ++i)
    trend.slope += (times[i] - time) * (values[i] - value) / spread;
  double residuals = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double left = values[i] - value - trend.slope * (times[i] - time);
    residuals += left * left;
  }
  trend.sigma = student_factor(n - 2) * std::sqrt(residuals / (n - 2) / spread);
  return trend;
}

double sigma_of_trend(const std::vector<double>& times, const std::vector<double>& sigmas) {
  if (times.size() < 2 || times.size() != sigmas.size()) return 0;
  const double time = mean_of(times), spread = squares_about(times, time);
  double variance = 0;
  for (std::size_t i = 0; i < times.size(); ++i)
    variance += (times[i] - time) * (times[i] - time) * sigmas[i] * sigmas[i];
  return spread > 0 ? std::sqrt(variance) / spread : 0;
}

std::optional<Trend> trend_of(const std::vector<double>& times, const std::vector<double>& values,
                              const std::vector<double>& sigmas) {
  const std::size_t n = times.size();
  if (n < 2 || values.size() != n || sigmas.size() != n) return std::nullopt;
  double weights = 0, time = 0, value = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double weight = 1 / (sigmas[i] * sigmas[i]);
    weights += weight;
    time += weight * times[i];
    value += weight * values[i];
  }
  time /= weights;
  value /= weights;
  double spread = 0, slope = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double weight = 1 / (sigmas[i] * sigmas[i]);
    spread += weight * (times[i] - time) * (times[i] - time);
    slope += weight * (times[i] - time) * (values[i] - value);
  }
  if (!(spread > 0)) return std::nullopt;
  slope /= spread;
  double scatter2 = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double left = (values[i] - value - slope * (times[i] - time)) / sigmas[i];
    scatter2 += left * left;
  }
  const double widening = n > 2 ? std::sqrt(std::max(1.0, scatter2 / double(n - 2))) : 1.0;
  return Trend{slope, widening / std::sqrt(spread)};
}

}  // namespace sweepscope
