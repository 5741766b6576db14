#include "core/offset/scan_equations.hpp"

#include <algorithm>

namespace sweepscope {

using Eigen::Vector3d;

namespace {

constexpr std::uint32_t kFree = 0xffffffff;

// Where the product with a scan is noted, or is to be.
std::uint32_t& place_of(std::uint32_t other, ScanEquations::Scan& scan) {
  const std::size_t mask = scan.places.size() - 1;
  std::size_t i = other & mask;
  while (scan.places[i] != kFree && scan.products[scan.places[i]].other != other) i = (i + 1) & mask;
  return scan.places[i];
}

void make_room(ScanEquations::Scan& scan) {
  scan.places.assign(std::max<std::size_t>(32, 2 * scan.places.size()), kFree);
  for (std::uint32_t k = 0; k < scan.products.size(); ++k) place_of(scan.products[k].other, scan) = k;
}

Matrix6d& sum_with(std::uint32_t other, ScanEquations::Scan& scan) {
  if (2 * (scan.products.size() + 1) > scan.places.size()) make_room(scan);
  std::uint32_t& place = place_of(other, scan);
  if (place == kFree) {
    place = static_cast<std::uint32_t>(scan.products.size());
    scan.products.push_back({other, Matrix6d::Zero()});
  }
  return scan.products[place].sum;
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
        sum_with(row.scan(b), scan).noalias() += weighted * row.row(b).transpose();
    scan.with_offset += offset_slope * weighted;
    scan.gradient += residual * weighted;
  }
  offset_square_ += weight * offset_slope * offset_slope;
  offset_gradient_ += weight * offset_slope * residual;
}

}  // namespace sweepscope
