#pragma once

// The mathematics: docs/algorithms.md, section 13.

#include <optional>
#include <vector>

namespace sweepscope {

/// By how much a standard deviation estimated with few degrees of freedom must be widened so that 68 % of the
/// truths lie within: Student's t at one sigma, by Cornish and Fisher's expansion. 1.31 for 2, 1.08 for 7.
double student_factor(double degrees_of_freedom);

/// An estimate without one of the parts of its data, and that part's share of the information; shares count
/// relative to each other.
struct WithoutPart {
  double value = 0, share = 0;
};

/// The standard deviation of an estimate from what it becomes without each of its parts in turn: the
/// jackknife for parts of unequal size (Busing, Meijer, van der Leeden 1999), Student's factor included.
/// Absent for fewer than three parts.
std::optional<double> jackknife_sigma(double estimate, const std::vector<WithoutPart>& without);

/// The standard deviation of the mean of a series whose neighbours err together, from the means of blocks of
/// neighbours, Student's factor included. There are at most `max_blocks`, each of at least `min_length`
/// values; absent for fewer than three.
std::optional<double> block_sigma(const std::vector<double>& series, std::size_t min_length,
                                  std::size_t max_blocks);

/// The slope of a series of (time, value) by least squares and its standard deviation from the residuals.
struct Trend {
  double slope = 0, sigma = 0;
};
std::optional<Trend> trend_of(const std::vector<double>& times, const std::vector<double>& values);

/// The sigma of the same slope by the values' own standard deviations.
double sigma_of_trend(const std::vector<double>& times, const std::vector<double>& sigmas);

/// The same of values whose standard deviations are known, from two on; sigma is widened where the values
/// scatter more about the slope than theirs say.
std::optional<Trend> trend_of(const std::vector<double>& times, const std::vector<double>& values,
                              const std::vector<double>& sigmas);

}  // namespace sweepscope
