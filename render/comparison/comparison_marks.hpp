#pragma once

#include <span>
#include <string>

#include "render/comparison/comparison.hpp"
#include "render/comparison/comparison_layout.hpp"
#include "render/drawing/drawing.hpp"
#include "render/drawing/style.hpp"

namespace sweepscope {

/// Draws the texts, frames and scales of a comparison.
void add_heading(Drawing& drawing, const ComparisonLayout& layout, const std::string& title,
                 const std::string& how_it_is_seen, double width_px, const Style& style);
void add_label(Drawing& drawing, PixelPoint baseline, double width_px, const std::string& label,
               Colour colour, const Style& style, double scale);
/// A scale bar if the scale is the same everywhere, the directions of the axes, a frame.
void add_overview_marks(Drawing& drawing, const Projection& projection, const Camera& camera,
                        const Style& style, double scale);
/// Which way x, y and z go, in a square. An axis that points at the camera is left out.
void add_axes(Drawing& drawing, const PixelRect& ground, const Camera& camera, Colour colour, double scale);
double axes_side_px(double scale);
void add_close_up_marks(Drawing& drawing, const Projection& projection, const Style& style, double scale);
/// The bar of colours with its numbers, or the list of classes.
void add_legend(Drawing& drawing, const ComparisonLayout& layout, const Colouring& colouring,
                const Style& style);
void add_footer(Drawing& drawing, const ComparisonLayout& layout, double width_px, const Style& style);

/// The text of a picture that has nothing to show.
void add_no_points(Drawing& drawing, const ComparedMap& map, const PixelRect& place,
                   std::span<const HeightRange> slabs, const Style& style, double scale);
void add_no_curve(Drawing& drawing, const PixelRect& place, const Estimate& estimate, const Style& style,
                  double scale);

/// "0.8 to 3.2 m above the sensor's path, 0.8 m and more below it"
std::string describe_slabs(std::span<const HeightRange> slabs);

}  // namespace sweepscope
