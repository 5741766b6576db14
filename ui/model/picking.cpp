#include "ui/model/picking.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/kinematics.hpp"
#include "core/numbers.hpp"

namespace sweepscope::ui {
namespace {

std::array<float, 3> place_of(const Placement& placement, std::uint32_t beam) {
  return place_beams(placement.loaded->beams, placement.map->path, placement.offset_s, std::array{beam})[0];
}

std::string in_words(const std::array<float, 3>& p) {
  if (!std::isfinite(p[0])) return "not on this map";
  return fmt::format("{:.3f}, {:.3f}, {:.3f} m", p[0], p[1], p[2]);
}

}  // namespace

std::optional<std::size_t> pick_point(const PlacedCloud& cloud, const Projection& projection,
                                      PixelPoint pixel, double reach_px) {
  std::optional<std::size_t> best;
  double best_px = reach_px;
  const auto& points = cloud.points->xyz_m;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto at = projection({points[i][0], points[i][1], points[i][2]});
    if (!at) continue;
    const double distance_px = std::hypot(at->x - pixel.x, at->y - pixel.y);
    if (distance_px >= best_px) continue;
    best_px = distance_px;
    best = i;
  }
  return best;
}

std::optional<std::uint32_t> beam_asked(const Settings& settings, const Beams& beams) {
  if (settings.asked_scan < 0 || settings.asked_beam < 0) return std::nullopt;
  const auto scan = static_cast<std::size_t>(settings.asked_scan);
  if (scan + 1 >= beams.first_point.size()) return std::nullopt;
  const auto from = beams.beam.begin() + static_cast<std::ptrdiff_t>(beams.first_point[scan]);
  const auto to = beams.beam.begin() + static_cast<std::ptrdiff_t>(beams.first_point[scan + 1]);
  const auto wanted = static_cast<std::uint32_t>(settings.asked_beam);
  const auto found = std::lower_bound(from, to, wanted);
  if (found == to || *found != wanted) return std::nullopt;
  return static_cast<std::uint32_t>(found - beams.beam.begin());
}

std::vector<std::pair<std::string, std::string>> describe_beam(const Placement& a, const Placement& b,
                                                               std::uint32_t beam) {
  const Loaded& loaded = *a.loaded;
  const Recording& recording = loaded.recording;
  const double time_s = loaded.beams.time_s(beam);
  const auto angle_deg = [&](double offset_s) {
    MotorReader motor(recording.motor);
    return motor.angle_at(time_s + offset_s) * kDegPerRad;
  };
  const auto at_a = place_of(a, beam), at_b = place_of(b, beam);
  std::vector<std::pair<std::string, std::string>> rows{
      {"scan", fmt::format("{}, beam {}", loaded.beams.scan[beam], loaded.beams.beam[beam])},
      {"time", fmt::format("{:.4f} s", time_s - recording.scans.front().first_beam_s)},
      {"range", fmt::format("{:.3f} m", loaded.beams.range_m(beam))},
      {"motor A, B", fmt::format("{:.2f}°, {:.2f}°", angle_deg(a.offset_s), angle_deg(b.offset_s))},
      {"place in A", in_words(at_a)},
      {"place in B", in_words(at_b)}};
  if (std::isfinite(at_a[0]) && std::isfinite(at_b[0])) {
    const double apart_m =
        static_cast<double>(std::hypot(at_a[0] - at_b[0], at_a[1] - at_b[1], at_a[2] - at_b[2]));
    rows.emplace_back("apart", fmt::format("{:.0f} mm", apart_m * 1e3));
  }
  return rows;
}

}  // namespace sweepscope::ui
