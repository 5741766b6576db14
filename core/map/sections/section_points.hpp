#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/map/sections/cross_section.hpp"

/// profile_across and face_fitted for many sections in one pass over a map.
namespace sweepscope {

/// A map's points (indices into it, ascending) in a cylinder around each section.
std::vector<std::vector<std::uint32_t>> points_near(const MapCloud& cloud,
                                                    std::span<const CrossSection> sections);

/// Those of these points that lie inside the section.
std::vector<std::uint32_t> points_inside(const MapCloud& cloud, std::span<const std::uint32_t> near,
                                         const CrossSection& section);

/// Signed distances of points across the section's face (m).
std::vector<double> distances_across_m(const MapCloud& cloud, std::span<const std::uint32_t> points,
                                       const CrossSection& section);

/// The profile of such distances.
Profile profile_of(const std::vector<double>& distances_m, double reach_m);

/// face_fitted for the points inside the section.
std::optional<CrossSection> face_of(const MapCloud& cloud, std::span<const std::uint32_t> inside,
                                    const CrossSection& section);

}  // namespace sweepscope
