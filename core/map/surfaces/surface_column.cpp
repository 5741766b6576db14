#include "core/map/surfaces/surface_column.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace sweepscope {
namespace {

constexpr std::size_t kMinColumnPoints = 20;  // for a normal
// Of the bins in a disc, 17 along its diameter and 227 in all, those that a surface fills: more than three
// parallel lines can.
constexpr int kSide = 17;
constexpr std::size_t kMinFilled = 60;
// Dense cubes are sampled evenly, so that the cost of a column is bounded.
constexpr std::uint32_t kMaxPerCube = 32, kMaxPerCubeOfBall = 12;
constexpr std::size_t kMaxSweeps = 128;
constexpr std::uint8_t kNoGroup = 255;

constexpr float kBin_m = 0.01F;  // of heights in a column
constexpr int kBins = 128;

}  // namespace

int ColumnLayers::bin_of(float height_m) {
  return std::clamp(static_cast<int>(std::floor(height_m / kBin_m)) + kBins / 2, 0, kBins - 1);
}

ColumnLayers::ColumnLayers(const std::vector<float>& heights_m, double gap_m) {
  std::bitset<kBins> filled;
  for (const float height_m : heights_m) filled.set(static_cast<std::size_t>(bin_of(height_m)));
  const int gap = static_cast<int>(std::ceil(gap_m / double(kBin_m)));
  for (int bin = 0; bin < kBins; ++bin) {
    if (!filled[static_cast<std::size_t>(bin)]) continue;
    const bool next = count_ == 0 || bin - last_bin_[count_ - 1] > gap;
    if (next && count_ < kMax) first_bin_[count_++] = bin;
    last_bin_[count_ - 1] = bin;
  }
  std::iota(surface_.begin(), surface_.end(), 0);
}

int ColumnLayers::at(float height_m) const {
  const int bin = bin_of(height_m);
  int layer = 0;
  while (layer + 1 < count_ && bin > last_bin_[layer]) ++layer;
  return layer;
}

void ColumnLayers::join(const std::vector<float>& heights_m, const std::vector<std::uint8_t>& group,
                        const std::vector<std::uint32_t>& sweeps) {
  constexpr std::uint32_t kMaxApart = 9;  // sweeps, in which the rig's motion errs less than a wrong offset
  std::vector<Shares> shares(sweeps.size(), Shares{});
  std::vector<float> points(sweeps.size(), 0);
  for (std::size_t i = 0; i < group.size(); ++i)
    shares[group[i]][at(heights_m[i])] += 1, points[group[i]] += 1;
  std::vector<std::pair<std::uint32_t, std::size_t>> order;
  for (std::size_t g = 0; g < sweeps.size(); ++g)
    if (points[g] > 0) order.emplace_back(sweeps[g], g);
  std::sort(order.begin(), order.end());
  Shares same{};
  std::array<Shares, kMax> across{};
  for (std::size_t k = 1; k < order.size(); ++k) {
    const auto [a_sweep, a] = order[k - 1];
    const auto [b_sweep, b] = order[k];
    if ((a_sweep ^ b_sweep) % 2 == 0 || b_sweep - a_sweep > kMaxApart) continue;
    Shares only_a{}, only_b{};
    float apart = 0;  // part of the points that the two sweeps put on different layers
    for (int l = 0; l < count_; ++l) {
      const float of_a = shares[a][l] / points[a], of_b = shares[b][l] / points[b];
      same[l] += std::min(of_a, of_b);
      only_a[l] = std::max(0.0F, of_a - of_b), only_b[l] = std::max(0.0F, of_b - of_a);
      apart += only_a[l];
    }
    if (apart < 0.5F) continue;
    for (int l = 0; l < count_; ++l)
      for (int m = 0; m < count_; ++m)
        across[std::min(l, m)][std::max(l, m)] += only_a[l] * only_b[m] / apart;
  }
  join(across, same);
}

// Layers are one surface if a sweep put its points on the one and the next sweep, which turned the other way,
// on the other. Two surfaces of the world are each seen by sweeps of both directions.
void ColumnLayers::join(const std::array<Shares, kMax>& across, const Shares& same) {
  constexpr float kMin = 0.25F;
  for (int l = 0; l < count_; ++l)
    for (int m = l + 1; m < count_; ++m) {
      if (across[l][m] < kMin || across[l][m] < 2 * (same[l] + same[m])) continue;
      const int kept = surface_[l], gone = surface_[m];
      std::replace(surface_.begin(), surface_.end(), gone, kept);
    }
}

std::array<int, 2> ColumnLayers::middle() const {
  std::array<int, 2> found{at(0), at(0)};
  for (int l = 0; l < count_; ++l) {
    int low = l, high = l;
    for (int m = 0; m < count_; ++m)
      if (surface_[m] == surface_[l]) low = std::min(low, m), high = std::max(high, m);
    if (low <= found[0] && high >= found[1]) found = {low, high};
  }
  return found;
}

SurfaceColumn::SurfaceColumn(const VoxelGrid& grid, const VoxelLevel& level, const ColumnOptions& options)
    : grid_(grid), level_(level), options_(options), radius_m_(static_cast<float>(level.cell_m())) {}

SurfacePatch SurfaceColumn::patch_at(std::uint32_t seed) {
  SurfacePatch patch;
  if (!gather(seed)) {
    // Of a smaller neighbourhood all points may be taken.
    if (sampled_) patch.kind = SurfaceKind::kEdge;
    return patch;
  }
  if (!seen_both_ways()) return patch;
  const double within_m = deviation_within_sweeps_m();
  if (std::isnan(within_m)) return patch;
  if (!is_filled() || !is_flat(within_m) || !has_straight_lines()) {
    patch.kind = SurfaceKind::kEdge;
    return patch;
  }
  const auto [lowest, highest] = std::minmax_element(z_m_.begin(), z_m_.end());
  patch.middle_m = middle_m_;
  patch.normal = normal_;
  patch.radius_m = radius_m_;
  patch.from_m = *lowest;
  patch.to_m = *highest;
  patch.thickness_m = static_cast<float>(thickness_m(within_m));
  patch.kind = SurfaceKind::kFlat;
  return patch;
}

double SurfaceColumn::range_noise_at_m(std::uint32_t seed) {
  return gather(seed) && is_filled() ? deviation_within_sweeps_m() : std::numeric_limits<double>::quiet_NaN();
}

bool SurfaceColumn::gather(std::uint32_t seed) {
  middle_m_ = {grid_.x_m[seed], grid_.y_m[seed], grid_.z_m[seed]};
  if (!gather_ball() || !find_normal()) return false;
  gather_column();
  constexpr double kMinGap_m = 0.02, kGapInNoise = 3;  // the tails of a layer have gaps of two deviations
  ColumnLayers layers(z_m_, std::max(kMinGap_m, kGapInNoise * options_.range_noise_m));
  if (layers.count() > 1) {
    if (options_.sweeps_known) layers.join(z_m_, group_, sweeps_);
    keep_heights(layers);
  }
  return x_m_.size() >= kMinFilled;
}

void SurfaceColumn::forget_points() {
  x_m_.clear(), y_m_.clear(), z_m_.clear();
  time_s_.clear(), group_.clear(), sweeps_.clear();
  slots_.fill(kNoGroup);
  sampled_ = false;
}

// Points of sweeps beyond kMaxSweeps are left out.
void SurfaceColumn::keep_point(const Eigen::Vector3f& p_m, std::uint32_t i) {
  const std::uint8_t group = group_of(grid_.sweep[i]);
  if (group == kNoGroup) return;
  time_s_.push_back(grid_.time_s[i]);
  x_m_.push_back(p_m.x()), y_m_.push_back(p_m.y()), z_m_.push_back(p_m.z());
  group_.push_back(group);
}

std::uint8_t SurfaceColumn::group_of(std::uint32_t sweep) {
  std::size_t slot = (sweep * 0x9e3779b1U) >> 24;
  while (slots_[slot] != kNoGroup && sweeps_[slots_[slot]] != sweep) slot = (slot + 1) % slots_.size();
  if (slots_[slot] == kNoGroup && sweeps_.size() < kMaxSweeps) {
    slots_[slot] = static_cast<std::uint8_t>(sweeps_.size());
    sweeps_.push_back(sweep);
  }
  return slots_[slot];
}

template <typename Keep>
void SurfaceColumn::take(std::uint64_t key, std::uint32_t max_points, const Keep& keep) {
  const std::uint32_t cell = level_.find(key);
  if (cell == VoxelLevel::kNone) return;
  const std::uint32_t begin = level_.begin(cell), count = level_.begin(cell + 1) - begin;
  const std::uint32_t taken = std::min(count, max_points);
  sampled_ = sampled_ || taken < count;
  const float *const x_m = grid_.x_m.data(), *const y_m = grid_.y_m.data(), *const z_m = grid_.z_m.data();
  const Eigen::Vector3f middle_m = middle_m_;
  for (std::uint32_t k = 0; k < taken; ++k) {
    const std::uint32_t i = begin + (count == taken ? k : k * count / taken);
    keep(Eigen::Vector3f(x_m[i], y_m[i], z_m[i]) - middle_m, i);
  }
}

bool SurfaceColumn::gather_ball() {
  forget_points();
  const VoxelLevel::Place place = level_.place_of(middle_m_.x(), middle_m_.y(), middle_m_.z());
  const float radius_m2 = radius_m_ * radius_m_;
  const auto keep = [this, radius_m2](const Eigen::Vector3f& p_m, std::uint32_t i) {
    if (p_m.squaredNorm() <= radius_m2) keep_point(p_m, i);
  };
  const auto x = level_.beside(0, place), y = level_.beside(1, place), z = level_.beside(2, place);
  for (const std::uint64_t of_z : z)
    for (const std::uint64_t of_y : y)
      for (const std::uint64_t of_x : x) take(of_x | of_y | of_z, kMaxPerCubeOfBall, keep);
  return x_m_.size() >= kMinColumnPoints;
}

// A sweep's points lie on their surface whatever the offset, so the spread within sweeps gives the normal;
// the spread between sweeps counts a little, for the direction that parallel scan lines leave open.
bool SurfaceColumn::find_normal() {
  constexpr double kBetween = 0.1, kMinAcross = 0.004;  // of the variance along: less is a line
  std::array<Eigen::Vector4d, kMaxSweeps> sums;
  std::fill_n(sums.begin(), sweeps_.size(), Eigen::Vector4d::Zero());
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (std::size_t i = 0; i < x_m_.size(); ++i) {
    const double x_m = x_m_[i], y_m = y_m_[i], z_m = z_m_[i];
    xx += x_m * x_m, xy += x_m * y_m, xz += x_m * z_m, yy += y_m * y_m, yz += y_m * z_m, zz += z_m * z_m;
    sums[group_[i]] += Eigen::Vector4d(x_m, y_m, z_m, 1);
  }
  Eigen::Matrix3d within, between = Eigen::Matrix3d::Zero();
  within << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (std::size_t g = 0; g < sweeps_.size(); ++g) {
    sum += sums[g];
    between += sums[g].head<3>() * sums[g].head<3>().transpose() / sums[g][3];
  }
  within -= between;
  between -= sum.head<3>() * sum.head<3>().transpose() / sum[3];
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;  // eigenvalues ascend
  axes.computeDirect(within + kBetween * between);
  normal_ = axes.eigenvectors().col(0).cast<float>();
  along_ = axes.eigenvectors().col(2).cast<float>();
  return axes.eigenvalues()[1] > kMinAcross * axes.eigenvalues()[2];
}

void SurfaceColumn::gather_column() {
  forget_points();
  const Eigen::Vector3f up = normal_.cross(along_);
  const auto reach_m = static_cast<float>(options_.reach_m);
  const float radius_m2 = radius_m_ * radius_m_;
  // Copies: members would be read again after each point that is kept.
  const auto keep = [this, reach_m, radius_m2, up, normal = normal_, along = along_](
                        const Eigen::Vector3f& p_m, std::uint32_t i) {
    const float height_m = normal.dot(p_m);
    const bool inside = std::abs(height_m) <= reach_m && p_m.squaredNorm() - height_m * height_m <= radius_m2;
    if (inside) keep_point({along.dot(p_m), up.dot(p_m), height_m}, i);
  };
  // Slice by slice of cubes along the axis that the column is nearest to.
  int axis = 0;
  normal_.cwiseAbs().maxCoeff(&axis);
  const int steps = static_cast<int>(std::ceil(options_.reach_m / level_.cell_m() - 1e-9));
  for (int k = -steps; k <= steps; ++k) {
    const Eigen::Vector3f at_m = middle_m_ + normal_ * (static_cast<float>(k) * radius_m_ / normal_[axis]);
    const VoxelLevel::Place place = level_.place_of(at_m.x(), at_m.y(), at_m.z());
    const std::uint64_t slice = level_.along(axis, place[axis]);
    const auto u = level_.beside((axis + 1) % 3, place), v = level_.beside((axis + 2) % 3, place);
    for (const std::uint64_t of_v : v)
      for (const std::uint64_t of_u : u) take(slice | of_u | of_v, kMaxPerCube, keep);
  }
}

// Keeps the points of the surface at the middle, and all between its layers.
void SurfaceColumn::keep_heights(const ColumnLayers& layers) {
  const auto [lowest, highest] = layers.middle();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < z_m_.size(); ++i) {
    const int layer = layers.at(z_m_[i]);
    if (layer < lowest || layer > highest) continue;
    x_m_[kept] = x_m_[i], y_m_[kept] = y_m_[i], z_m_[kept] = z_m_[i], group_[kept] = group_[i];
    time_s_[kept] = time_s_[i];
    ++kept;
  }
  x_m_.resize(kept), y_m_.resize(kept), z_m_.resize(kept), group_.resize(kept), time_s_.resize(kept);
}

bool SurfaceColumn::seen_both_ways() const {
  if (!options_.both_directions) return true;
  constexpr std::size_t kMinPart = 8;  // an eighth of the points
  std::size_t odd = 0;
  for (const std::uint8_t group : group_) odd += sweeps_[group] % 2;
  return std::min(odd, group_.size() - odd) * kMinPart >= group_.size();
}

// The scan lines of a few sweeps, all nearly in one plane, do not fill a disc in it.
bool SurfaceColumn::is_filled() const {
  const auto bin = [&](float value_m) {
    return static_cast<std::size_t>(
        std::clamp(static_cast<int>(std::floor((value_m / radius_m_ + 1) * kSide / 2)), 0, kSide - 1));
  };
  std::bitset<std::size_t{kSide} * kSide> filled;
  for (std::size_t i = 0; i < x_m_.size(); ++i) filled.set(bin(x_m_[i]) + kSide * bin(y_m_[i]));
  return filled.count() >= kMinFilled;
}

// A scan line is straight on a flat surface. In a plane that the scanner makes, and no surface, it bends.
bool SurfaceColumn::has_straight_lines() const {
  constexpr double kOneLine_s = 0.015;  // points within this time are of one scan line
  constexpr double kMinBend_m = 0.02, kBendInNoise = 2.5, kMinPointsOfLine = 5;
  struct Line {
    Eigen::Vector2d sum_m = Eigen::Vector2d::Zero();
    Eigen::Matrix2d square_m2 = Eigen::Matrix2d::Zero();
    double count = 0, from_s = 0, to_s = 0;
  };
  std::vector<Line> lines(sweeps_.size());
  for (std::size_t i = 0; i < x_m_.size(); ++i) {
    Line& line = lines[group_[i]];
    const Eigen::Vector2d p_m(x_m_[i], y_m_[i]);
    line.from_s = line.count == 0 ? time_s_[i] : std::min(line.from_s, time_s_[i]);
    line.to_s = line.count == 0 ? time_s_[i] : std::max(line.to_s, time_s_[i]);
    line.sum_m += p_m;
    line.square_m2 += p_m * p_m.transpose();
    line.count += 1;
  }
  const double bend_m = std::max(kMinBend_m, kBendInNoise * options_.range_noise_m);
  double straight = 0, bent = 0;
  for (const Line& line : lines) {
    if (line.count < kMinPointsOfLine || line.to_s - line.from_s > kOneLine_s) continue;
    const Eigen::Vector2d mean_m = line.sum_m / line.count;
    const Eigen::Matrix2d spread_m2 = line.square_m2 / line.count - mean_m * mean_m.transpose();
    const double half = spread_m2.trace() / 2;
    const double across_m2 = half - std::sqrt(std::max(0.0, half * half - spread_m2.determinant()));
    (across_m2 > bend_m * bend_m ? bent : straight) += line.count;
  }
  constexpr double kMaxBent = 0.3;
  return bent <= kMaxBent * (bent + straight);
}

double SurfaceColumn::deviation_within_sweeps_m() const {
  struct Sums {
    double count = 0, height_m = 0, square_m2 = 0;
  };
  std::vector<Sums> sums(sweeps_.size());
  for (std::size_t i = 0; i < z_m_.size(); ++i) {
    Sums& of_sweep = sums[group_[i]];
    const double height_m = z_m_[i];
    of_sweep.count += 1, of_sweep.height_m += height_m, of_sweep.square_m2 += height_m * height_m;
  }
  double square_m2 = 0, freedom = 0;
  for (const Sums& s : sums) {
    if (s.count < 2) continue;
    square_m2 += s.square_m2 - s.height_m * s.height_m / s.count;
    freedom += s.count - 1;
  }
  constexpr double kMinFreedom = 10;
  if (freedom < kMinFreedom) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(std::max(0.0, square_m2) / freedom);
}

bool SurfaceColumn::is_flat(double within_m) const {
  // Noise grows with the range and with a slant view; a wrong offset tilts a sweep's layer by a few degrees.
  constexpr double kMaxNoise = 1.6, kMaxTilt_rad = 0.03, kMaxFlatness = 0.2;
  const double radius_m = double(radius_m_);
  if (within_m > kMaxFlatness * radius_m) return false;
  return !options_.sweeps_known ||
         within_m <= std::hypot(kMaxNoise * options_.range_noise_m, kMaxTilt_rad * radius_m);
}

// The width at half height. The deviation within sweeps beyond the noise is a slight bend, or the tilt of
// their layers, and is subtracted. Around the outermost layers, of a surface thicker than its noise, half the
// height is farther out than the quantile.
double SurfaceColumn::thickness_m(double within_m) {
  constexpr double kWidthPerDeviation = 2.355, kBeyondQuantiles = 0.943;  // of two layers, in deviations
  const double width = width_m(), noise_m = options_.range_noise_m;
  if (!options_.sweeps_known) return width;
  const double noise_width_m = kWidthPerDeviation * noise_m;
  const double bent_m =
      kWidthPerDeviation * std::sqrt(std::max(0.0, within_m * within_m - noise_m * noise_m));
  const double straight_m = std::sqrt(std::max(0.0, width * width - bent_m * bent_m));
  if (straight_m <= noise_width_m) return std::min(width, noise_width_m);
  return straight_m + kBeyondQuantiles * noise_m * std::sqrt(1 - std::pow(noise_width_m / straight_m, 2));
}

// Between the quantiles that are at half height for normal noise. Quantiles, as they know every layer: the
// width at half height loses layers that are less than half as dense as another.
double SurfaceColumn::width_m() {
  constexpr double kTail = 0.1195;
  const auto at = [&](double fraction) {
    const auto place = z_m_.begin() + std::lround(fraction * static_cast<double>(z_m_.size() - 1));
    std::nth_element(z_m_.begin(), place, z_m_.end());
    return static_cast<double>(*place);
  };
  const double low_m = at(kTail);
  return at(1 - kTail) - low_m;
}

}  // namespace sweepscope
