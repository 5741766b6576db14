#include "core/uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sweepscope {
namespace {

TEST(StudentFactor, IsTheQuantileAtOneSigma) {
  // t with nu degrees of freedom at probability 0.8413, from tables.
  EXPECT_NEAR(student_factor(2), 1.321, 0.02);
  EXPECT_NEAR(student_factor(5), 1.111, 0.005);
  EXPECT_NEAR(student_factor(30), 1.017, 0.001);
}

// Without value i the mean of n values is (sum - x_i) / (n - 1), and the jackknife must give s / sqrt(n).
TEST(Jackknife, OfAMeanIsItsStandardError) {
  const std::vector<double> values{1.0, 4.0, 2.5, 3.0, 7.0};
  const double sum = 17.5, mean = 3.5;
  std::vector<WithoutPart> without;
  double squares = 0;
  for (const double value : values) {
    without.push_back({(sum - value) / 4, 1});
    squares += (value - mean) * (value - mean);
  }
  EXPECT_NEAR(*jackknife_sigma(mean, without), student_factor(4) * std::sqrt(squares / 4 / 5), 1e-12);
  EXPECT_FALSE(jackknife_sigma(1.5, {{1, 1}, {2, 1}}));
}

// Means of 1, 2 and 6 values of one scatter: what the largest part takes away counts less than as one of
// three.
TEST(Jackknife, KnowsThatPartsAreOfUnequalSize) {
  const double variance = 4;  // of one value; the parts' means lie as far off as that makes likely
  const double means[3] = {1 + 2.0, 1 - 2.0 / std::sqrt(2.0), 1 + 2.0 / std::sqrt(6.0)};
  const double sizes[3] = {1, 2, 6};
  double mean = 0;
  for (int i = 0; i < 3; ++i) mean += sizes[i] * means[i] / 9;
  std::vector<WithoutPart> without;
  for (int i = 0; i < 3; ++i)
    without.push_back({(9 * mean - sizes[i] * means[i]) / (9 - sizes[i]), sizes[i]});
  EXPECT_NEAR(*jackknife_sigma(mean, without), student_factor(2) * std::sqrt(variance / 9), 0.25);
}

// Parts with next to no share are skipped, and must take no part of the estimate along.
TEST(Jackknife, IsTheSameWhereASecondIsAddedToEveryValue) {
  const auto sigma = [](double added) {
    std::vector<WithoutPart> without;
    for (int i = 0; i < 7; ++i) without.push_back({added + 0.01 * (i * 3 % 7 - 3), 1});
    for (int i = 0; i < 3; ++i) without.push_back({added + 0.01, 0.005});
    return *jackknife_sigma(added, without);
  };
  EXPECT_NEAR(sigma(1), sigma(0), 1e-9);
  EXPECT_NEAR(sigma(200), sigma(0), 1e-9);
}

TEST(BlockSigma, SeesThatNeighboursErrTogether) {
  std::vector<double> alone, together;
  for (int i = 0; i < 200; ++i) {
    alone.push_back(i * 7 % 11 - 5.0);
    together.push_back((i / 10) * 7 % 11 - 5.0);  // ten at a time
  }
  EXPECT_GT(*block_sigma(together, 10, 20), 2 * *block_sigma(alone, 10, 20));
  EXPECT_FALSE(block_sigma(alone, 100, 20));
}

TEST(TrendOf, IsTheSlopeAndItsDoubt) {
  std::vector<double> times, straight, bent;
  for (int i = 0; i < 10; ++i) {
    times.push_back(i);
    straight.push_back(3 + 0.5 * i);
    bent.push_back(3 + 0.5 * i + (i % 2 == 0 ? 1 : -1));
  }
  EXPECT_NEAR(trend_of(times, straight)->slope, 0.5, 1e-12);
  EXPECT_NEAR(trend_of(times, straight)->sigma, 0, 1e-12);
  EXPECT_NEAR(trend_of(times, bent)->slope, 0.5, 2 * trend_of(times, bent)->sigma);
  EXPECT_FALSE(trend_of({1, 2, 3}, {1, 2, 3}));
}

TEST(TrendOf, OfEqualWeightsHasASigmaByTheValuesOwn) {
  EXPECT_NEAR(sigma_of_trend({0, 10}, {0.3, 0.4}), 0.05, 1e-12);
  EXPECT_NEAR(sigma_of_trend({0, 1, 2}, {2, 100, 2}), std::sqrt(2.0), 1e-12);  // the middle has no lever
  EXPECT_EQ(sigma_of_trend({3}, {1}), 0);
}

TEST(TrendOf, KnownSigmasWeighAndDoubt) {
  const auto two = trend_of({0, 10}, {1, 2}, {0.3, 0.4});
  EXPECT_NEAR(two->slope, 0.1, 1e-12);
  EXPECT_NEAR(two->sigma, 0.05, 1e-12);  // 0.5 over 10
  // A value that is known badly hardly counts.
  EXPECT_NEAR(trend_of({0, 10, 20}, {1, 2, 30}, {0.1, 0.1, 1e4})->slope, 0.1, 1e-6);
  // Scatter beyond the sigmas widens.
  const double told = trend_of({0, 1, 2, 3}, {0, 0, 0, 0}, {1, 1, 1, 1})->sigma;
  EXPECT_NEAR(trend_of({0, 1, 2, 3}, {9, -9, -9, 9}, {1, 1, 1, 1})->sigma, told * std::sqrt(324 / 2.0), 1e-9);
  EXPECT_FALSE(trend_of({1}, {1}, {1}));
}

}  // namespace
}  // namespace sweepscope
