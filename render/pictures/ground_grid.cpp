#include "render/pictures/ground_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "render/charts/ticks.hpp"

namespace sweepscope {
namespace {

constexpr int kMaxLines = 200;  // along an axis

double rounded_up(double value, double step) {
  return std::ceil(value / step - 1e-9) * step;
}

/// Cut into pieces: what lies behind a perspective camera has no place in the picture.
void add_line(Drawing& drawing, const GroundGrid& grid, const Projection& projection,
              const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  constexpr int kPieces = 16;
  std::optional<PixelPoint> last = projection(from);
  for (int i = 1; i <= kPieces; ++i) {
    const auto at = projection(from + (to - from) * i / kPieces);
    const auto seen = last && at ? clip(*last, *at, projection.place()) : std::nullopt;
    if (seen) drawing.line(seen->first, seen->second, grid.line_px, grid.lines);
    last = at;
  }
}

std::string metres(double value, double step) {
  return fmt::format("{:.{}f} m", std::abs(value) < 1e-9 ? 0.0 : value,
                     step < 0.995 ? step < 0.0995 ? 2 : 1 : 0);
}

PixelRect place_of(const TextMark& label) {
  const double width_px = text_width_px(label.text, label.size_px), height_px = label.size_px;
  return {label.at.x - width_px / 2, label.at.y - height_px / 2, width_px, height_px};
}

bool overlap(const PixelRect& a, const PixelRect& b) {
  return a.left < b.right() && b.left < a.right() && a.top < b.bottom() && b.top < a.bottom();
}

/// Adds the label unless it would lie on one that is there.
void add_label(Drawing& drawing, TextMark label) {
  const PixelRect place = place_of(label);
  for (const Drawing::Mark& mark : drawing.marks()) {
    const auto* other = std::get_if<TextMark>(&mark);
    if (other != nullptr && overlap(place_of(*other), place)) return;
  }
  drawing.add(std::move(label));
}

/// Along one axis: lines across it, and the coordinates at one of their ends.
void add_axis(Drawing& drawing, const GroundGrid& grid, const Projection& projection, Eigen::Index axis,
              bool labels_at_end) {
  const Eigen::Index other = 1 - axis;
  const int count = static_cast<int>(std::lround((grid.to_m[axis] - grid.from_m[axis]) / grid.step_m));
  for (int i = 0; i <= std::min(count, kMaxLines); ++i) {
    Eigen::Vector3d from(0, 0, grid.z_m), to(0, 0, grid.z_m);
    from[axis] = to[axis] = grid.from_m[axis] + i * grid.step_m;
    from[other] = grid.from_m[other];
    to[other] = grid.to_m[other];
    add_line(drawing, grid, projection, from, to);
    Eigen::Vector3d label = labels_at_end ? to : from;
    label[other] += (labels_at_end ? 0.35 : -0.35) * grid.step_m;
    const auto at = projection(label);
    const bool fits = at && projection.place().inset(grid.text_px).contains(*at);
    if (fits)
      add_label(drawing, TextMark{*at, metres(from[axis], grid.step_m), grid.text_px, grid.text,
                                  AlignX::kCentre, AlignY::kMiddle});
  }
}

}  // namespace

GroundGrid ground_grid(const Box& box, const Projection& projection, double min_step_px) {
  GroundGrid grid;
  grid.z_m = box.from_m.z();
  grid.step_m = round_length(std::max(1e-3, min_step_px * projection.metres_per_px()));
  if (grid.step_m / projection.metres_per_px() < min_step_px) {
    for (const double factor : {2.0, 2.5, 5.0}) {  // the next round length
      const double next_m = round_length(grid.step_m * factor * (1 + 1e-9));
      if (next_m > grid.step_m * 1.5) {
        grid.step_m = next_m;
        break;
      }
    }
  }
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    grid.from_m[axis] = -rounded_up(-box.from_m[axis], grid.step_m);
    grid.to_m[axis] = std::max(rounded_up(box.to_m[axis], grid.step_m), grid.from_m[axis] + grid.step_m);
  }
  return grid;
}

Drawing grid_marks(const GroundGrid& grid, const Camera& camera, const Projection& projection) {
  constexpr double kMinSlope = 0.06;
  Drawing drawing;
  const Eigen::Vector3d forward = (camera.looks_at_m - camera.position_m).normalized();
  if (forward.z() > -kMinSlope) return drawing;
  add_axis(drawing, grid, projection, 0, forward.y() < 0);
  add_axis(drawing, grid, projection, 1, forward.x() < 0);
  return drawing;
}

}  // namespace sweepscope
