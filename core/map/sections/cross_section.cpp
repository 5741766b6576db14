#include "core/map/sections/cross_section.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/map/sections/section_points.hpp"
#include "core/numbers.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

constexpr double kStep_mm = 1, kSmoothing_mm = 3;
constexpr std::size_t kMinSectionPoints = 300;
const double kWidthPerDeviation = 2 * std::sqrt(2 * std::numbers::ln2);

// Counts per step from -reach to reach about the median, and a Gaussian's width beyond it on either side.
std::vector<double> smoothed(const std::vector<double>& distances_m, double median_m, double reach_m) {
  const int half = static_cast<int>(std::ceil((reach_m * 1e3 + 4 * kSmoothing_mm) / kStep_mm));
  std::vector<double> counts(2 * half + 1), density(counts.size());
  for (const double distance_m : distances_m) {
    const auto bin = static_cast<int>(std::lround((distance_m - median_m) * 1e3 / kStep_mm)) + half;
    if (bin >= 0 && bin <= 2 * half) ++counts[bin];
  }
  const int width = static_cast<int>(std::ceil(4 * kSmoothing_mm / kStep_mm));
  std::vector<double> kernel(2 * width + 1);
  double sum = 0;
  for (int k = -width; k <= width; ++k) {
    const double at = k * kStep_mm / kSmoothing_mm;
    sum += kernel[k + width] = std::exp(-at * at / 2);
  }
  const double scale = 1 / (sum * kStep_mm * static_cast<double>(distances_m.size()));
  for (int i = 0; i < static_cast<int>(counts.size()); ++i)
    for (int k = std::max(-width, -i); k <= std::min(width, 2 * half - i); ++k)
      density[i] += scale * counts[i + k] * kernel[k + width];
  return density;
}

// The outermost steps where the density is at half of its peak at least.
std::pair<std::size_t, std::size_t> outermost(const std::vector<double>& density, double half) {
  std::size_t first = 0, last = density.size() - 1;
  while (density[first] < half) ++first;
  while (density[last] < half) --last;
  return {first, last};
}

double width_at_half_mm(const std::vector<double>& density, double half) {
  const auto [first, last] = outermost(density, half);
  // Between two steps, linearly; beyond the ends there is nothing.
  const auto beyond = [&](std::size_t inside, std::ptrdiff_t step) {
    const std::ptrdiff_t outside = static_cast<std::ptrdiff_t>(inside) + step;
    if (outside < 0 || outside >= std::ssize(density)) return 0.0;
    return (density[inside] - half) / (density[inside] - density[outside]);
  };
  const double width_mm =
      (static_cast<double>(last - first) + beyond(first, -1) + beyond(last, 1)) * kStep_mm;
  const double smoothing_mm = kWidthPerDeviation * kSmoothing_mm;
  return std::sqrt(std::max(0.0, width_mm * width_mm - smoothing_mm * smoothing_mm));
}

// A point of a section: along the face, above its middle, across it.
struct FacePoint {
  double along_m, up_m, across_m;
};

FacePoint face_point(const MapPoint& p, const CrossSection& section) {
  const Eigen::Vector3d d = p.getVector3fMap().cast<double>() - section.middle_m();
  return {d.dot(section.along()), d.z(), d.dot(section.across())};
}

// across = offset + turn * along + lean * up, in the section's own axes.
struct Plane {
  double offset_m = 0, turn = 0, lean = 0;
  double distance_m(const FacePoint& p) const {
    return p.across_m - offset_m - turn * p.along_m - lean * p.up_m;
  }
};

// The direction in which the face is densest somewhere across it: a start near enough for the fit.
Plane densest(const std::vector<FacePoint>& points, double length_m, double reach_m) {
  constexpr double kMaxTurn_rad = 6 * std::numbers::pi / 180, kBin_m = 0.005;
  const std::size_t stride = 1 + points.size() / 20000;
  const int turns = static_cast<int>(std::ceil(kMaxTurn_rad * std::max(length_m, 0.3) / 0.01));
  const int bins = static_cast<int>(2 * reach_m / kBin_m) + 1;
  std::vector<int> counts(bins);
  Plane best;
  int most = -1;
  for (int k = -turns; k <= turns; ++k) {
    const double turn = std::tan(kMaxTurn_rad * k / turns);
    std::fill(counts.begin(), counts.end(), 0);
    for (std::size_t i = 0; i < points.size(); i += stride) {
      const auto bin =
          static_cast<int>(std::floor((points[i].across_m - turn * points[i].along_m + reach_m) / kBin_m));
      if (bin >= 0 && bin < bins) ++counts[bin];
    }
    for (int b = 2; b + 2 < bins; ++b) {
      const int sum = counts[b - 2] + counts[b - 1] + counts[b] + counts[b + 1] + counts[b + 2];
      if (sum <= most) continue;
      most = sum;
      best = {(b + 0.5) * kBin_m - reach_m, turn, 0};
    }
  }
  return best;
}

// Reweighted least squares (Welsch): from half the reach, which holds both layers of a doubled face, down to
// the spread that the points have.
Plane robust_plane(const std::vector<FacePoint>& points, Plane plane, double reach_m) {
  constexpr double kMinScale_m = 0.015;
  constexpr int kRounds = 25;
  double scale_m = reach_m / 2;
  std::vector<double> residuals_m(points.size());
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const FacePoint& p : points) {
      const double r = plane.distance_m(p) / scale_m, weight = std::exp(-r * r / 2);
      const Eigen::Vector3d terms(1, p.along_m, p.up_m);
      normal += weight * terms * terms.transpose();
      right += weight * p.across_m * terms;
    }
    const Eigen::Vector3d solved = normal.ldlt().solve(right);
    if (!solved.allFinite()) break;
    plane = {solved[0], solved[1], solved[2]};
    for (std::size_t i = 0; i < points.size(); ++i) residuals_m[i] = std::abs(plane.distance_m(points[i]));
    scale_m =
        std::max(kMinScale_m, std::min(0.8 * scale_m, 2 * kSigmaPerMedianDeviation * median(residuals_m)));
  }
  return plane;
}

}  // namespace

Eigen::Vector3d CrossSection::across() const {
  const double level = std::cos(lean_rad);
  return {level * std::cos(normal_rad), level * std::sin(normal_rad), std::sin(lean_rad)};
}

Eigen::Vector3d CrossSection::along() const {
  return {-std::sin(normal_rad), std::cos(normal_rad), 0};
}

namespace {

// A cylinder around a section.
struct NearSection {
  explicit NearSection(const CrossSection& of)
      : x_m(of.at_m.x()), y_m(of.at_m.y()), from_m(of.from_m), to_m(of.to_m) {
    // A face that leans lies to the side of the section's middle at its ends.
    const double lean_m = std::abs(std::tan(of.lean_rad)) * (of.to_m - of.from_m) / 2;
    const double half_m = of.length_m / 2, deep_m = of.reach_m + lean_m;
    radius_m2 = half_m * half_m + 1.1 * deep_m * deep_m;
  }
  bool holds(const MapPoint& p) const {
    const double dx_m = p.x - x_m, dy_m = p.y - y_m;
    return dx_m * dx_m + dy_m * dy_m <= radius_m2 && p.z >= from_m && p.z <= to_m;
  }
  double x_m, y_m, from_m, to_m, radius_m2;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> points_near(const MapCloud& cloud,
                                                    std::span<const CrossSection> sections) {
  constexpr std::size_t kBlock = 1 << 16;
  using PerSection = std::vector<std::vector<std::uint32_t>>;
  const std::vector<NearSection> near(sections.begin(), sections.end());
  std::vector<PerSection> blocks((cloud.size() + kBlock - 1) / kBlock, PerSection(sections.size()));
  for_each_index(blocks.size(), [&](std::size_t block) {
    const std::size_t end = std::min(cloud.size(), (block + 1) * kBlock);
    for (std::size_t i = block * kBlock; i < end; ++i)
      for (std::size_t s = 0; s < near.size(); ++s)
        if (near[s].holds(cloud.points[i])) blocks[block][s].push_back(static_cast<std::uint32_t>(i));
  });
  PerSection found(sections.size());
  for (const PerSection& block : blocks)
    for (std::size_t s = 0; s < sections.size(); ++s)
      found[s].insert(found[s].end(), block[s].begin(), block[s].end());
  return found;
}

std::vector<std::uint32_t> points_inside(const MapCloud& cloud, std::span<const std::uint32_t> near,
                                         const CrossSection& section) {
  std::vector<std::uint32_t> inside;
  for (const std::uint32_t i : near) {
    const MapPoint& p = cloud.points[i];
    const FacePoint at = face_point(p, section);
    if (p.z >= section.from_m && p.z <= section.to_m && std::abs(at.along_m) <= section.length_m / 2 &&
        std::abs(at.across_m) <= section.reach_m)
      inside.push_back(i);
  }
  return inside;
}

std::vector<double> distances_across_m(const MapCloud& cloud, std::span<const std::uint32_t> points,
                                       const CrossSection& section) {
  std::vector<double> distances_m;
  for (const std::uint32_t i : points) distances_m.push_back(face_point(cloud.points[i], section).across_m);
  return distances_m;
}

Profile profile_of(const std::vector<double>& distances_m, double reach_m) {
  Profile profile;
  profile.points = distances_m.size();
  if (distances_m.empty()) return profile;
  const double median_m = median(distances_m);
  profile.median_mm = median_m * 1e3;
  profile.density_per_mm = smoothed(distances_m, median_m, reach_m);
  const double half_mm = kStep_mm * static_cast<double>(profile.density_per_mm.size() - 1) / 2;
  for (std::size_t i = 0; i < profile.density_per_mm.size(); ++i)
    profile.distances_mm.push_back(kStep_mm * static_cast<double>(i) - half_mm);
  profile.peak_per_mm = *std::max_element(profile.density_per_mm.begin(), profile.density_per_mm.end());
  if (profile.points >= kMinSectionPoints) {
    const double half = profile.peak_per_mm / 2;
    profile.width_at_half_height_mm = width_at_half_mm(profile.density_per_mm, half);
    const auto [first, last] = outermost(profile.density_per_mm, half);
    profile.half_height_mm = {profile.distances_mm[first], profile.distances_mm[last]};
    profile.integral_width_mm = 1 / profile.peak_per_mm;
  }
  return profile;
}

std::optional<CrossSection> face_of(const MapCloud& cloud, std::span<const std::uint32_t> inside,
                                    const CrossSection& section) {
  if (inside.size() < kMinSectionPoints) return std::nullopt;
  std::vector<FacePoint> face;
  for (const std::uint32_t i : inside) face.push_back(face_point(cloud.points[i], section));
  const Plane plane = robust_plane(face, densest(face, section.length_m, section.reach_m), section.reach_m);
  const Eigen::Vector3d gradient =
      section.across() - plane.turn * section.along() - Eigen::Vector3d(0, 0, plane.lean);
  CrossSection fitted = section;
  fitted.at_m += plane.offset_m / std::cos(section.lean_rad) *
                 Eigen::Vector2d(std::cos(section.normal_rad), std::sin(section.normal_rad));
  fitted.normal_rad = std::atan2(gradient.y(), gradient.x());
  fitted.lean_rad = std::atan2(gradient.z(), std::hypot(gradient.x(), gradient.y()));
  return fitted;
}

Profile profile_across(const MapCloud& cloud, const CrossSection& section) {
  const auto inside = points_inside(cloud, points_near(cloud, {&section, 1}).front(), section);
  return profile_of(distances_across_m(cloud, inside, section), section.reach_m);
}

std::optional<CrossSection> face_fitted(const MapCloud& cloud, const CrossSection& section) {
  return face_of(cloud, points_inside(cloud, points_near(cloud, {&section, 1}).front(), section), section);
}

}  // namespace sweepscope
