#include "core/offset/scan_equations.hpp"

#include <algorithm>

namespace sweepscope {

using Eigen::Vector3d;

namespace {

// From the back: matches that follow each other mostly have their scans in common.
Matrix6d& sum_with(std::uint32_t other, std::vector<ScanEquations::Product>& products) {
  const auto found = std::find_if(products.rbegin(), products.rend(),
                                  [&](const ScanEquations::Product& p) { return p.other == other; });
  if (found != products.rend()) return found->sum;
  return products.emplace_back(ScanEquations::Product{other, Matrix6d::Zero()}).sum;
}

}  // namespace

double ScanRow::add_point(std::uint32_t scan, const ScanMotion& motion, const Vector3d& p_m,
                          const Vector3d& normal, double share) {
  const Vector6d row = share * distance_jacobian(p_m, normal, motion.base_in_map_m);
  const auto end = scans_.begin() + std::ptrdiff_t(count_);
  const auto i = std::size_t(std::find(scans_.begin(), end, scan) - scans_.begin());
  if (i == count_) {
    scans_[count_] = scan;
    rows_[count_++] = row;
  } else {
    rows_[i] += row;
  }
  return share * normal.dot(motion.turning_rad_s.cross(p_m - motion.base_in_map_m));
}

void ScanEquations::add(const ScanRow& row, double offset_slope, double residual, double weight) {
  for (std::size_t a = 0; a < row.size(); ++a) {
    Scan& scan = scans_[row.scan(a)];
    const Vector6d weighted = weight * row.row(a);
    for (std::size_t b = 0; b < row.size(); ++b)
      if (row.scan(b) <= row.scan(a))
        sum_with(row.scan(b), scan.products).noalias() += weighted * row.row(b).transpose();
    scan.with_offset += offset_slope * weighted;
    scan.gradient += residual * weighted;
  }
  offset_square_ += weight * offset_slope * offset_slope;
  offset_gradient_ += weight * offset_slope * residual;
}

}  // namespace sweepscope
