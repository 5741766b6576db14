#include "core/rig_solve/surfaces.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace sweepscope {
namespace {

// Four points represent a cell: its mean plus and minus the deviations along its plane.
std::array<Eigen::Vector3d, 4> places_of(const PlaneCell& cell) {
  return {cell.centre_m + cell.along_m.col(0), cell.centre_m - cell.along_m.col(0),
          cell.centre_m + cell.along_m.col(1), cell.centre_m - cell.along_m.col(1)};
}

void fit(Surface& surface, std::span<const PlaneCell> cells) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double count = 0;
  const Eigen::Vector3d origin = cells[surface.cells.front()].centre_m;
  for (const std::uint32_t c : surface.cells) {
    const double weight = double(cells[c].points.size()) / 4;
    for (const Eigen::Vector3d& p : places_of(cells[c])) {
      mean += weight * (p - origin);
      squares += weight * (p - origin) * (p - origin).transpose();
      count += weight;
    }
  }
  mean /= count;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares / count - mean * mean.transpose());
  surface.centre_m = origin + mean;
  surface.normal = solver.eigenvectors().col(0);
}

double farthest_m(const Surface& surface, const PlaneCell& cell) {
  double max_m = 0;
  for (const Eigen::Vector3d& p : places_of(cell))
    max_m = std::max(max_m, std::abs(surface.normal.dot(p - surface.centre_m)));
  return max_m;
}

}  // namespace

std::vector<Surface> surfaces_of(std::span<const PlaneCell> cells, double reach_m) {
  constexpr int kRounds =
      3;  // each begins with the plane of the cells found so far: that of a small seed is tilted
  std::vector<std::uint32_t> by_size(cells.size());
  std::iota(by_size.begin(), by_size.end(), 0u);
  std::ranges::stable_sort(by_size,
                           [&](auto a, auto b) { return cells[a].points.size() > cells[b].points.size(); });
  std::vector<char> taken(cells.size(), 0);
  std::vector<Surface> surfaces;
  for (const std::uint32_t seed : by_size) {
    if (taken[seed]) continue;
    Surface surface{{seed}, cells[seed].centre_m, cells[seed].normal};
    for (int round = 0; round < kRounds; ++round) {
      std::vector<std::uint32_t> near{seed};
      for (const std::uint32_t other : by_size)
        if (other != seed && !taken[other] && farthest_m(surface, cells[other]) < reach_m)
          near.push_back(other);
      const bool same = near == surface.cells;
      surface.cells = std::move(near);
      fit(surface, cells);
      if (same) break;
    }
    for (const std::uint32_t c : surface.cells) taken[c] = 1;
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

}  // namespace sweepscope
