#include "core/offset/walk/scan_equations.hpp"

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
  matches_.push_back({residual, weight, offset_slope, rows_.size()});
  for (std::size_t i = 0; i < row.size(); ++i) {
    rows_.push_back(row.row(i));
    scan_of_row_.push_back(row.scan(i));
  }
}

std::size_t ScanEquations::end_row(std::size_t match) const {
  return match + 1 < matches_.size() ? matches_[match + 1].first_row : rows_.size();
}

double ScanEquations::change(std::size_t match, const ByScan& steps) const {
  double sum = matches_[match].offset_slope * steps.offset;
  for (std::size_t i = matches_[match].first_row; i < end_row(match); ++i)
    sum += rows_[i].dot(steps.scans[scan_of_row_[i]]);
  return sum;
}

void ScanEquations::add_row(std::size_t match, double factor, ByScan& sum) const {
  for (std::size_t i = matches_[match].first_row; i < end_row(match); ++i)
    sum.scans[scan_of_row_[i]] += factor * rows_[i];
  sum.offset += factor * matches_[match].offset_slope;
}

std::vector<double> ScanEquations::changes(const ByScan& steps) const {
  std::vector<double> changes(matches_.size());
  for (std::size_t i = 0; i < matches_.size(); ++i) changes[i] = change(i, steps);
  return changes;
}

ByScan ScanEquations::gradient() const {
  ByScan sum{std::vector<Vector6d>(scans_, Vector6d::Zero())};
  for (std::size_t i = 0; i < matches_.size(); ++i)
    add_row(i, matches_[i].weight * matches_[i].residual, sum);
  return sum;
}

ByScan ScanEquations::product(const ByScan& steps) const {
  ByScan sum{std::vector<Vector6d>(scans_, Vector6d::Zero())};
  for (std::size_t i = 0; i < matches_.size(); ++i) add_row(i, matches_[i].weight * change(i, steps), sum);
  return sum;
}

ScanEquations::Matrix ScanEquations::matrix() const {
  Matrix matrix{std::vector<Scan>(scans_)};
  for (std::size_t i = 0; i < matches_.size(); ++i) {
    const Match& match = matches_[i];
    for (std::size_t a = match.first_row; a < end_row(i); ++a) {
      Scan& scan = matrix.scans[scan_of_row_[a]];
      const Vector6d weighted = match.weight * rows_[a];
      for (std::size_t b = match.first_row; b < end_row(i); ++b)
        if (scan_of_row_[b] <= scan_of_row_[a])
          sum_with(scan_of_row_[b], scan).noalias() += weighted * rows_[b].transpose();
      scan.with_offset += match.offset_slope * weighted;
    }
    matrix.offset_square += match.weight * match.offset_slope * match.offset_slope;
  }
  return matrix;
}

ScanEquations::Diagonal ScanEquations::diagonal() const {
  Diagonal diagonal{std::vector<Matrix6d>(scans_, Matrix6d::Zero())};
  for (std::size_t i = 0; i < matches_.size(); ++i) {
    const Match& match = matches_[i];
    for (std::size_t row = match.first_row; row < end_row(i); ++row)
      diagonal.scans[scan_of_row_[row]].noalias() += match.weight * rows_[row] * rows_[row].transpose();
    diagonal.offset_square += match.weight * match.offset_slope * match.offset_slope;
  }
  return diagonal;
}

}  // namespace sweepscope
