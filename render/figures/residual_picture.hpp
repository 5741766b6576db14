#pragma once

#include "core/rig_solve/rig_residuals.hpp"
#include "render/comparison/comparison.hpp"
#include "render/pictures/picture.hpp"

namespace sweepscope {

/// How far the points of a stationary rig lie from flat surfaces over the motor's angle and the beam, with
/// the rig before and after it was solved for, in the same colours: in millimetres, violet before a surface
/// and orange beyond it. Side by side or, in a picture that is higher than wide, one below the other. The
/// grids must not be empty.
Picture residual_picture(const RigResiduals& residuals, const ComparisonOptions& look);

/// The value at the ends of the colours, in millimetres: 98 % of the bins of both grids are within it.
double residual_range_mm(const RigResiduals& residuals);

}  // namespace sweepscope
