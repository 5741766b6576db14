#pragma once

#include <span>
#include <string>

#include "render/comparison.hpp"
#include "render/comparison_layout.hpp"
#include "render/drawing.hpp"
#include "render/style.hpp"
#include "render/top_view.hpp"

namespace sweepscope {

/// The words, frames and scales of a comparison, each into its place.
void add_heading(Drawing& drawing, const ComparisonLayout& layout, const std::string& title,
                 const std::string& how_it_is_seen, double width_px, const Style& style);
void add_label(Drawing& drawing, PixelPoint baseline, double width_px, const std::string& label,
               Colour colour, const Style& style, double scale);
/// Where the sensor went, a scale, a frame; only the frame where the map is empty.
void add_overview_marks(Drawing& drawing, const TopView& view, std::span<const StampedPose> path, bool empty,
                        const Style& style, double scale);
/// Also outlines in the overview what the close-up shows, unless there is nothing in it.
void add_close_up_marks(Drawing& drawing, const TopView& overview, const TopView& close_up, bool empty,
                        const Style& style, double scale);
void add_scalar_bar(Drawing& drawing, const ComparisonLayout& layout, const ColourScale& colours,
                    const Style& style);
void add_footer(Drawing& drawing, const ComparisonLayout& layout, double width_px, const Style& style);

/// What a picture says in words where it has nothing to show.
void add_no_points(Drawing& drawing, const ComparedMap& map, const TopView& view,
                   std::span<const HeightRange> slabs, const Style& style, double scale);
void add_no_curve(Drawing& drawing, const PixelRect& place, const Estimate& estimate, const Style& style,
                  double scale);

/// "0.8 to 3.2 m above the sensor's path, 0.8 m and more below it"
std::string describe_slabs(std::span<const HeightRange> slabs);

}  // namespace sweepscope
