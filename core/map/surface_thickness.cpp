#include "core/map/surface_thickness.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "core/map/voxel_grid.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

constexpr std::uint32_t kMaxPerCell = 16;  // dense cells are sampled evenly: the cost of a cube is bounded
constexpr int kTerms = 6;                  // of a surface of second degree
constexpr std::size_t kMaxPoints = 27 * kMaxPerCell;

// The points around a cell, relative to its middle.
struct Neighbourhood {
  std::array<float, kMaxPoints> x_m, y_m, z_m;
  std::size_t count = 0;
  std::uint32_t points = 0;  // before sampling
  bool forward = false, backward = false;
};

// What a cell's cube gave.
struct CellSurface {
  LocalSurface surface;
  std::uint32_t points = 0;
};

class SurfaceFitter {
 public:
  SurfaceFitter(const MapCloud& cloud, const VoxelGrid& grid, const VoxelLevel& level,
                const ThicknessOptions& options)
      : cloud_(cloud), grid_(grid), level_(level), options_(options) {}

  CellSurface fit(std::uint32_t cell) {
    gather(cell);
    CellSurface fitted;
    fitted.points = near_.points;
    const bool enough = near_.count >= static_cast<std::size_t>(std::max(options_.min_points, kTerms + 1));
    if (enough && !(options_.both_directions && !(near_.forward && near_.backward)))
      fitted.surface = surface();
    return fitted;
  }

 private:
  void gather(std::uint32_t cell) {
    near_.count = near_.points = 0;
    near_.forward = near_.backward = false;
    const VoxelLevel::Place middle = level_.place(cell);
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const std::uint32_t other = level_.find({middle[0] + dx, middle[1] + dy, middle[2] + dz});
          if (other != VoxelLevel::kNone) take(other, middle);
        }
  }

  void take(std::uint32_t cell, const VoxelLevel::Place& middle) {
    const std::uint32_t begin = level_.begin(cell), count = level_.begin(cell + 1) - begin;
    const std::uint32_t taken = std::min(count, kMaxPerCell);
    near_.points += count;
    const auto offset_m = [&](int axis) {
      return static_cast<float>((middle[axis] + 0.5) * level_.cell_m());
    };
    const float x_m = offset_m(0), y_m = offset_m(1), z_m = offset_m(2);
    for (std::uint32_t k = 0; k < taken; ++k) {
      const std::uint32_t i = begin + (count == taken ? k : k * count / taken);
      near_.x_m[near_.count] = grid_.x_m[i] - x_m;
      near_.y_m[near_.count] = grid_.y_m[i] - y_m;
      near_.z_m[near_.count] = grid_.z_m[i] - z_m;
      ++near_.count;
      if (options_.both_directions)
        (cloud_.points[grid_.index[i]].sweep % 2 == 0 ? near_.forward : near_.backward) = true;
    }
  }

  LocalSurface surface() {
    const auto count = static_cast<Eigen::Index>(near_.count);
    const auto as_array = [&](const auto& values) {
      return Eigen::Map<const Eigen::ArrayXf>(values.data(), count);
    };
    const auto x = as_array(near_.x_m), y = as_array(near_.y_m), z = as_array(near_.z_m);
    const Eigen::Vector3f mean(x.mean(), y.mean(), z.mean());
    x_ = x - mean.x(), y_ = y - mean.y(), z_ = z - mean.z();
    Eigen::Matrix3d spread_m2;
    const double n = static_cast<double>(count);
    spread_m2 << x_.square().sum() / n, 0, 0,           //
        (x_ * y_).sum() / n, y_.square().sum() / n, 0,  //
        (x_ * z_).sum() / n, (y_ * z_).sum() / n, z_.square().sum() / n;
    // Reads the lower triangle; eigenvalues ascend.
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
    axes.computeDirect(spread_m2);
    const double along_m = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
    const double filled_m = 3 * level_.cell_m() / std::sqrt(12.0);
    if (along_m < options_.min_extent * filled_m) return {};
    const Eigen::Matrix3f to_surface = axes.eigenvectors().transpose().cast<float>();
    const double thickness_m =
        distance_from_bent_m(to_surface, static_cast<float>(along_m),
                             static_cast<float>(std::sqrt(axes.eigenvalues()[2]) / along_m));
    if (!(thickness_m <= options_.max_flatness * along_m)) return {};
    return {to_surface.row(0).transpose(), static_cast<float>(thickness_m)};
  }

  // The standard deviation of the points' distances from the surface of second degree through them.
  double distance_from_bent_m(const Eigen::Matrix3f& to_surface, float unit_m, float v_spread) {
    h_ = to_surface(0, 0) * x_ + to_surface(0, 1) * y_ + to_surface(0, 2) * z_;
    u_ = (to_surface(1, 0) * x_ + to_surface(1, 1) * y_ + to_surface(1, 2) * z_) / unit_m;
    v_ = (to_surface(2, 0) * x_ + to_surface(2, 1) * y_ + to_surface(2, 2) * z_) / unit_m;
    if (!spread_over(v_spread)) return std::numeric_limits<double>::infinity();
    terms_.resize(Eigen::NoChange, h_.size());
    terms_.row(0).setOnes();
    terms_.row(1) = u_;
    terms_.row(2) = v_;
    terms_.row(3) = u_.square();
    terms_.row(4) = u_ * v_;
    terms_.row(5) = v_.square();
    Eigen::Matrix<float, 6, 6> normal_matrix;
    normal_matrix.noalias() = terms_ * terms_.transpose();
    const Eigen::Matrix<float, 6, 1> right = terms_ * h_.matrix().transpose();
    Eigen::Matrix<double, 6, 6> damped = normal_matrix.cast<double>();
    damped.diagonal() *= 1 + 1e-6;  // where points lie in two rows, say, a term is not determined
    const Eigen::Matrix<double, 6, 1> shape = damped.ldlt().solve(right.cast<double>());
    h_ -= (shape.cast<float>().transpose() * terms_).array();
    return std::sqrt(double(h_.square().sum()) / double(h_.size() - kTerms));
  }

  // True where the points fill the surface, in units of their spread. A standing rig's lie in scan lines some
  // 9 deg apart: a bent surface goes through any three of them, however far a wrong offset moved each.
  bool spread_over(float v_spread) const {
    constexpr int kSide = 6, kMin = 22;
    const auto bin = [](float value, float spread) {
      return std::clamp(static_cast<int>(std::floor((value / (1.8f * spread) + 1) * kSide / 2)), 0,
                        kSide - 1);
    };
    std::uint64_t filled = 0;
    for (Eigen::Index i = 0; i < u_.size(); ++i)
      filled |= std::uint64_t{1} << (bin(u_[i], 1) + kSide * bin(v_[i], v_spread));
    return std::popcount(filled) >= kMin;
  }

  using Row = Eigen::Array<float, 1, Eigen::Dynamic, Eigen::RowMajor, 1, kMaxPoints>;
  const MapCloud& cloud_;
  const VoxelGrid& grid_;
  const VoxelLevel& level_;
  const ThicknessOptions& options_;
  Neighbourhood near_;
  Row x_, y_, z_, u_, v_, h_;
  Eigen::Matrix<float, 6, Eigen::Dynamic, Eigen::RowMajor, 6, kMaxPoints> terms_;
};

// The sharpest of the surfaces through a cell's own cube and its six neighbours': beside a step or a corner
// a cube pushed aside holds the one face alone. Pushed across a thick surface it would cut off a part of it,
// and hold fewer points.
LocalSurface sharpest(const std::vector<CellSurface>& fitted, const VoxelLevel& level, std::uint32_t cell) {
  constexpr double kMinPart = 0.8;
  const VoxelLevel::Place place = level.place(cell);
  LocalSurface best = fitted[cell].surface;
  for (int axis = 0; axis < 3; ++axis)
    for (const int d : {-1, 1}) {
      VoxelLevel::Place beside = place;
      beside[axis] += d;
      const std::uint32_t other = level.find(beside);
      if (other == VoxelLevel::kNone || fitted[other].points < kMinPart * fitted[cell].points) continue;
      const LocalSurface& surface = fitted[other].surface;
      if (surface.thickness_m < best.thickness_m ||
          (std::isnan(best.thickness_m) && !std::isnan(surface.thickness_m)))
        best = surface;
    }
  return best;
}

}  // namespace

std::vector<LocalSurface> local_surfaces(const MapCloud& cloud, const ThicknessOptions& options) {
  std::vector<LocalSurface> surfaces(cloud.size());
  if (cloud.empty()) return surfaces;
  const VoxelGrid grid(cloud, options.cell_m);
  const auto open = [&](std::uint32_t i) { return std::isnan(surfaces[grid.index[i]].thickness_m); };
  // Coarse cubes last: they fill what finer ones left open.
  for (int doublings = 0; doublings <= options.doublings; ++doublings) {
    const VoxelLevel level = grid.level(doublings);
    std::vector<CellSurface> fitted(level.cells());
    for_each_block(level.cells(), 256, [&](const auto& block) {
      SurfaceFitter fitter(cloud, grid, level, options);
      for (std::uint32_t cell = block.begin(); cell < block.end(); ++cell) fitted[cell] = fitter.fit(cell);
    });
    for_each_block(level.cells(), 256, [&](const auto& block) {
      for (std::uint32_t cell = block.begin(); cell < block.end(); ++cell) {
        const LocalSurface surface = sharpest(fitted, level, cell);
        for (std::uint32_t i = level.begin(cell); i < level.begin(cell + 1); ++i)
          if (open(i)) surfaces[grid.index[i]] = surface;
      }
    });
  }
  return surfaces;
}

std::vector<float> surface_thickness_m(const MapCloud& cloud, const ThicknessOptions& options) {
  const std::vector<LocalSurface> surfaces = local_surfaces(cloud, options);
  std::vector<float> thickness_m(surfaces.size());
  std::transform(surfaces.begin(), surfaces.end(), thickness_m.begin(),
                 [](const LocalSurface& surface) { return surface.thickness_m; });
  return thickness_m;
}

}  // namespace sweepscope
