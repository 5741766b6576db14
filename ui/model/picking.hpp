#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ui/model/placed_cloud.hpp"
#include "ui/model/view_camera.hpp"

namespace sweepscope::ui {

/// The index of the cloud's point that lies nearest to a pixel, within `reach_px` of it.
std::optional<std::size_t> pick_point(const PlacedCloud& cloud, const Projection& projection,
                                      PixelPoint pixel, double reach_px);

/// The beam of the inspected point of the settings, as an index into Beams; absent if there is none, or if
/// that beam has no return.
std::optional<std::uint32_t> beam_asked(const Settings& settings, const Beams& beams);

/// The positions of a beam on both maps, and its origin: names and values, for a person.
std::vector<std::pair<std::string, std::string>> describe_beam(const Placement& a, const Placement& b,
                                                               std::uint32_t beam);

}  // namespace sweepscope::ui
