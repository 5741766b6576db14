#pragma once

// What the parts of a stationary recording say of its offset. The mathematics: docs/algorithms.md, sections 8
// and 13.

#include "core/offset/stationary/direct_stationary.hpp"
#include "core/offset/stationary/line_residuals.hpp"

namespace sweepscope {

/// Fills in the sectors' residuals and the scan time's error. `lines` are those of the last step.
void fill_scan_time(const StationaryPoints& points, const std::vector<LineResiduals>& lines,
                    double loss_width_m, StationaryDirect& result);

/// Fills in what the parts of the sweeps, the combs, sectors and blocks say, as far as `resampling` asks for.
void resample(const StationaryGrid& grid, const StationaryLinearisation& at,
              const std::vector<LineResiduals>& lines, double loss_width_m, Resampling resampling,
              StationaryDirect& result);

}  // namespace sweepscope
