#include "core/offset/stationary/line_residuals.hpp"

#include "core/loam/path/least_squares.hpp"
#include "core/parallel.hpp"

namespace sweepscope {

PatchDistance distance_to_patch(const StationaryPatch& patch, const Eigen::Vector3d& p_m, double speed_rad_s,
                                const Eigen::Vector3d& motor_axis) {
  const Eigen::Vector3d turned_m = motor_axis.cross(p_m);
  const double lever_m = patch.normal.dot(turned_m);
  return {(speed_rad_s - patch.speed_rad_s) * lever_m, patch.normal.dot(p_m - patch.centre_m), float(lever_m),
          float(turned_m.norm())};
}

void OffsetEquation::add(const LineResiduals& line, double loss_width_m, double ahead_s) {
  features += line.features;
  matches += line.residuals.size();
  for (const PatchDistance& residual : line.residuals) {
    const double distance_m = residual.distance_m + residual.jacobian_m_s * ahead_s,
                 weight = cauchy_weight(distance_m, loss_width_m);
    jj += weight * residual.jacobian_m_s * residual.jacobian_m_s;
    jr += weight * residual.jacobian_m_s * distance_m;
  }
}

OffsetEquation offset_equation(const std::vector<LineResiduals>& lines, double loss_width_m) {
  OffsetEquation sums;
  for (const LineResiduals& line : lines) sums.add(line, loss_width_m);
  return sums;
}

StationaryLinearisation::StationaryLinearisation(const StationaryGrid& grid,
                                                 const StationaryPatchOptions& patches, double offset_s)
    : grid_(grid),
      patches_(patches),
      axis_(grid.problem->recording->rig.mount.axis.normalized()),
      points_(place_stationary(grid, offset_s, StationaryDetail::kPoints)) {}

std::vector<LineResiduals> StationaryLinearisation::residuals() const {
  std::vector<LineResiduals> found(points_.lines());
  for_each_index(points_.lines(), [&](std::size_t line) {
    if (points_.sweep[line] != kNoSweep)
      found[line] = of_line(line, points_.against(points_.direction[line]));
  });
  return found;
}

std::vector<LineResiduals> StationaryLinearisation::residuals_within(
    const std::vector<std::size_t>& block_of_line, std::size_t blocks) const {
  std::vector<std::array<LinePool, 2>> pools(blocks);
  for (std::size_t side = 0; side < 2; ++side)
    for (const std::uint32_t line : points_.pool[side])
      if (block_of_line[line] < blocks) pools[block_of_line[line]][side].push_back(line);
  std::vector<LineResiduals> found(points_.lines());
  for_each_index(points_.lines(), [&](std::size_t line) {
    if (block_of_line[line] < blocks)
      found[line] = of_line(line, pools[block_of_line[line]][points_.direction[line] > 0 ? 0 : 1]);
  });
  return found;
}

PartsOfPatches StationaryLinearisation::parts_of_patches(const CellParts& parts) const {
  PartsOfPatches found(points_.placed.size(), 0);
  for_each_index(points_.lines(), [&](std::size_t line) {
    if (points_.sweep[line] == kNoSweep) return;
    StationaryNeighbours neighbours(points_, points_.against(points_.direction[line]), line, patches_);
    for (std::size_t bin = 0; bin < points_.bins; ++bin) {
      const std::size_t cell = line * points_.bins + bin;
      if (!points_.placed[cell]) continue;
      for (const std::size_t near : neighbours.around(points_.angle_rad[cell], bin))
        if (parts.of_cell[near] < parts.count) found[cell] |= std::uint32_t{1} << parts.of_cell[near];
    }
  });
  return found;
}

void StationaryLinearisation::leave_out(const CellParts& parts, std::size_t part,
                                        const StationaryLinearisation& whole) {
  for (std::size_t cell = 0; cell < points_.placed.size(); ++cell)
    points_.placed[cell] = char(whole.points_.placed[cell] && parts.of_cell[cell] != part);
}

std::vector<LineResiduals> StationaryLinearisation::residuals_without(
    std::size_t part, const PartsOfPatches& of_patches, const std::vector<LineResiduals>& lines) const {
  std::vector<LineResiduals> found(points_.lines());
  for_each_index(points_.lines(), [&](std::size_t line) {
    if (points_.sweep[line] != kNoSweep) found[line] = of_line_without(part, of_patches, line, lines[line]);
  });
  return found;
}

LineResiduals StationaryLinearisation::of_line(std::size_t line, const LinePool& pool) const {
  LineResiduals found;
  StationaryNeighbours neighbours(points_, pool, line, patches_);
  for (std::size_t cell = line * points_.bins; cell < (line + 1) * points_.bins; ++cell) {
    if (!points_.placed[cell]) continue;
    ++found.features;
    if (const auto residual = of_cell(cell, neighbours)) found.add(cell, *residual);
  }
  return found;
}

LineResiduals StationaryLinearisation::of_line_without(std::size_t part, const PartsOfPatches& of_patches,
                                                       std::size_t line, const LineResiduals& whole) const {
  LineResiduals found;
  StationaryNeighbours neighbours(points_, points_.against(points_.direction[line]), line, patches_);
  std::size_t next = 0;  // of the whole line's residuals
  for (std::size_t cell = line * points_.bins; cell < (line + 1) * points_.bins; ++cell) {
    while (next < whole.cells.size() && whole.cells[next] < cell) ++next;
    if (!points_.placed[cell]) continue;
    ++found.features;
    if ((of_patches[cell] >> part & 1u) == 0) {
      if (next < whole.cells.size() && whole.cells[next] == cell) found.add(cell, whole.residuals[next]);
    } else if (const auto residual = of_cell(cell, neighbours)) {
      found.add(cell, *residual);
    }
  }
  return found;
}

std::optional<PatchDistance> StationaryLinearisation::of_cell(std::size_t cell,
                                                              StationaryNeighbours& neighbours) const {
  const StationaryPatch patch =
      neighbours.patch(points_.angle_rad[cell], cell % points_.bins, grid_.range_m[cell]);
  if (!patch.found) return std::nullopt;
  return distance_to_patch(patch, points_.p_m[cell], points_.speed_rad_s[cell], axis_);
}

}  // namespace sweepscope
