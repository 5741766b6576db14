#include "core/offset/scan_equations.hpp"

#include <algorithm>

namespace sweepscope {

using Eigen::Vector3d;

namespace {

// From the back: matches that follow each other mostly have their scans in common.
Matrix6d& product_with(std::uint32_t other, ScanEquations::Scan& scan) {
  const auto found = std::find(scan.others.rbegin(), scan.others.rend(), other);
  if (found != scan.others.rend()) return scan.products[std::size_t(scan.others.rend() - found) - 1];
  scan.others.push_back(other);
  return scan.products.emplace_back(Matrix6d::Zero());
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
        product_with(row.scan(b), scan).noalias() += weighted * row.row(b).transpose();
    scan.with_offset += offset_slope * weighted;
    scan.gradient += residual * weighted;
  }
  offset_square_ += weight * offset_slope * offset_slope;
  offset_gradient_ += weight * offset_slope * residual;
}

}  // namespace sweepscope
