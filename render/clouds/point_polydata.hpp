#pragma once

#include <vtkSmartPointer.h>

#include <array>
#include <cstdint>
#include <span>

class vtkPolyData;

namespace sweepscope {

inline constexpr const char* kSpacingArray = "spacing_m";

/// Points with a colour each as VTK draws them: both are copied, and one cell holds all points, which takes
/// far less memory than a cell for each. `spacing_m` is that of each point, for splats, or empty.
vtkSmartPointer<vtkPolyData> to_polydata(std::span<const std::array<float, 3>> xyz_m,
                                         std::span<const std::array<std::uint8_t, 3>> rgb,
                                         std::span<const float> spacing_m = {});

}  // namespace sweepscope
