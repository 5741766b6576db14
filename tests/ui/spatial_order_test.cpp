#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "ui/model/spatial_order.hpp"

namespace sweepscope::ui {
namespace {

TEST(DrawOrder, HoldsEveryPointOnceAndChoosesEvenlyOverSpace) {
  std::mt19937 random(1);
  std::vector<std::array<float, 3>> points;
  for (int i = 0; i < 40000; ++i) {  // a wall of 10 x 2 m, most of its points in one corner
    const float u = static_cast<float>(random()) / 4294967296.0f,
                v = static_cast<float>(random()) / 4294967296.0f;
    points.push_back({10 * u * u * u, 2 * v, 0});
  }
  points[7][0] = std::nanf("");
  const DrawOrder order = order_for_drawing(points, 5000);
  EXPECT_EQ(order.all.size(), points.size() - 1);
  EXPECT_EQ(std::set(order.all.begin(), order.all.end()).size(), points.size() - 1);
  EXPECT_LE(order.chosen.size(), 5000u);
  EXPECT_GT(order.chosen.size(), 2000u);
  EXPECT_TRUE(std::is_sorted(order.chosen.begin(), order.chosen.end()));
  EXPECT_EQ(order.chosen_order.size(), order.chosen.size());
  std::size_t dense = 0;  // of all points, 58 % lie in the first fifth; of the chosen ones near a fifth
  for (const std::uint32_t i : order.chosen) dense += points[i][0] < 2 ? 1 : 0;
  EXPECT_LT(static_cast<double>(dense), 0.45 * static_cast<double>(order.chosen.size()));
}

}  // namespace
}  // namespace sweepscope::ui
