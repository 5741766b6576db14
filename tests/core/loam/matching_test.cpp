#include "core/loam/matching.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <vector>

namespace sweepscope {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_m = 0.5;

// Rows of points, one row per scan line: place(row, i) for three points each.
template <typename Place>
Neighbours rows(int lines, const Place& place) {
  Neighbours found;
  for (int row = 0; row < lines; ++row)
    for (int i = -1; i <= 1; ++i) {
      found.p_m[found.count] = place(row, i).template cast<float>();
      found.line[found.count++] = std::uint32_t(row);
    }
  found.lines = lines;
  return found;
}

// A patch of the plane through (20, -30, 5) with this normal, and how far its points stand out to either
// side.
const Vector3d kPatchNormal = Vector3d(1, 2, -1).normalized();
const Vector3d kAlong = kPatchNormal.unitOrthogonal(), kAcross = kPatchNormal.cross(kAlong);
const Vector3d kCentre(20, -30, 5);

Neighbours patch(double out_m) {
  return rows(3, [&](int row, int i) -> Vector3d {
    const double side = (row + i) % 2 == 0 ? 1 : -1;
    return kCentre + 0.15 * i * kAlong + 0.15 * (row - 1) * kAcross + side * out_m * kPatchNormal;
  });
}

PatchOptions three_lines() {
  PatchOptions options;
  options.min_lines = 3;
  return options;
}

TEST(FitPlane, FindsThePlaneFarFromTheOrigin) {
  const auto plane = fit_plane(patch(0.005), three_lines(), kRadius_m);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(std::abs(plane->normal.dot(kPatchNormal)), 1, 1e-3);
  EXPECT_NEAR((plane->centre_m - kCentre).dot(kPatchNormal), 0, 1e-3);
}

TEST(FitPlane, RefusesAPatchThatIsThick) {
  EXPECT_FALSE(fit_plane(patch(0.12), three_lines(), kRadius_m));
}

TEST(FitPlane, RefusesPointsInARow) {
  const Neighbours row =
      rows(3, [](int line, int i) -> Vector3d { return kCentre + (0.1 * line + 0.03 * i) * kAlong; });
  EXPECT_FALSE(fit_plane(row, three_lines(), kRadius_m));
}

TEST(FitPlane, RefusesTheSamePointOverAndOver) {
  EXPECT_FALSE(fit_plane(rows(3, [](int, int) { return kCentre; }), three_lines(), kRadius_m));
}

TEST(FitPlane, RefusesPointsOfTooFewScanLines) {
  Neighbours neighbours = patch(0.005);
  EXPECT_FALSE(fit_plane(neighbours, PatchOptions(), kRadius_m));  // three where four are asked for
  neighbours.line.fill(0);
  neighbours.lines = 1;
  EXPECT_FALSE(fit_plane(neighbours, three_lines(), kRadius_m));
}

TEST(FitPlane, RefusesFewerThanFivePoints) {
  Neighbours neighbours = patch(0);
  neighbours.count = 4;
  EXPECT_FALSE(fit_plane(neighbours, three_lines(), kRadius_m));
}

// Corners of a door frame, say: one point per scan line, up along it.
Neighbours column(double out_m) {
  return rows(3, [&](int row, int i) -> Vector3d {
    return kCentre + (0.3 * row + 0.1 * i) * kAlong + out_m * (i * kAcross + (row - 1) * kPatchNormal);
  });
}

TEST(FitLine, FindsTheLineFarFromTheOrigin) {
  const auto line = fit_line(column(0.004), PatchOptions(), kRadius_m);
  ASSERT_TRUE(line);
  EXPECT_NEAR(std::abs(line->direction.dot(kAlong)), 1, 1e-3);
  EXPECT_NEAR(residual_of(*line, kCentre).distance_m, 0, 5e-3);
  const MatchResidual beside = residual_of(*line, kCentre + 0.4 * kAcross);
  EXPECT_NEAR((beside.distance_m * beside.normal - 0.4 * kAcross).norm(), 0, 0.02);
}

TEST(FitLine, RefusesAPatch) {
  EXPECT_FALSE(fit_line(patch(0), PatchOptions(), kRadius_m));
}

TEST(FitLine, RefusesALineThatIsThick) {
  EXPECT_FALSE(fit_line(column(0.12), PatchOptions(), kRadius_m));
}

TEST(FitLine, RefusesPointsOfASingleScanLine) {
  Neighbours neighbours = column(0.004);
  neighbours.lines = 1;
  EXPECT_FALSE(fit_line(neighbours, PatchOptions(), kRadius_m));
}

// By central differences of the distance.
Vector3d numeric_normal(const auto& patch, const Vector3d& p_m) {
  constexpr double kStep_m = 1e-5;
  Vector3d slope;
  for (int i = 0; i < 3; ++i)
    slope[i] = (residual_of(patch, p_m + kStep_m * Vector3d::Unit(i)).distance_m -
                residual_of(patch, p_m - kStep_m * Vector3d::Unit(i)).distance_m) /
               (2 * kStep_m);
  return slope;
}

TEST(MatchResidual, ChangesAlongItsNormal) {
  const PlanePatch plane{kCentre, kPatchNormal};
  const LinePatch line{kCentre, kAlong};
  for (const double side : {-0.3, 0.2}) {
    const Vector3d p_m = kCentre + side * kPatchNormal + 0.7 * kAcross + 0.1 * kAlong;
    EXPECT_NEAR(residual_of(plane, p_m).distance_m, side, 1e-12);
    EXPECT_NEAR(residual_of(line, p_m).distance_m, std::hypot(side, 0.7), 1e-12);
    EXPECT_LT((residual_of(plane, p_m).normal - numeric_normal(plane, p_m)).norm(), 1e-8);
    EXPECT_LT((residual_of(line, p_m).normal - numeric_normal(line, p_m)).norm(), 1e-8);
  }
}

TEST(MatchResidual, OnALineHasNoNormal) {
  const LinePatch line{kCentre, kAlong};
  EXPECT_FALSE(residual_of(line, kCentre).has_normal);
  EXPECT_EQ(residual_of(line, kCentre).distance_m, 0);
  EXPECT_FALSE(residual_of(std::optional<LinePatch>(), kCentre));
}

}  // namespace
}  // namespace sweepscope
