#include "ui/model/placed_cloud.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope::ui {
namespace {

using Places = std::vector<std::array<float, 3>>;

/// Where the beams are whose numbers are `chosen`, or all.
Places place_beams(const Placement& placement, const std::vector<std::uint32_t>* chosen) {
  const Beams& beams = placement.loaded->beams;
  Places places(chosen != nullptr ? chosen->size() : beams.size());
  if (chosen != nullptr)
    replace_points(beams, placement.map->path, placement.offset_s, *chosen, places);
  else
    replace_points(beams, placement.map->path, placement.offset_s, places);
  return places;
}

/// Which beams the look shows.
class Filter {
 public:
  Filter(const Placement& placement, const CloudLook& look) : placement_(placement), look_(look) {
    const auto& scans = placement.loaded->recording.scans;
    begin_s_ = scans.empty() ? 0 : scans.front().first_beam_s;
  }

  bool shows(std::uint32_t beam, const std::array<float, 3>& place_m) const {
    if (!std::isfinite(place_m[0])) return false;
    const Beams& beams = placement_.loaded->beams;
    if (look_.time_to_s > look_.time_from_s) {
      const double time_s = beams.time_s(beam) - begin_s_;
      if (time_s < look_.time_from_s || time_s > look_.time_to_s) return false;
    }
    if (look_.heights == Heights::kAll) return true;
    const double above_m = static_cast<double>(place_m[2] - placement_.map->path_height_m[beams.scan[beam]]);
    if (look_.heights == Heights::kSlab) return above_m >= look_.slab_from_m && above_m <= look_.slab_to_m;
    const auto& slabs = placement_.map->sharp_heights;
    return std::any_of(slabs.begin(), slabs.end(), [&](const HeightRange& slab) {
      return above_m >= slab.from_m && above_m <= slab.to_m;
    });
  }

 private:
  const Placement& placement_;
  const CloudLook& look_;
  double begin_s_ = 0;
};

double distance_mm(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return 1e3 * static_cast<double>(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
}

/// +1 or -1 for each scan, by the sweep that it lies in; 0 outside.
std::vector<int> directions(const Placement& placement) {
  const auto& sweeps = placement.loaded->motor.sweeps;
  const auto& scans = placement.loaded->recording.scans;
  const auto sweep_of = assign_sweeps(scans, sweeps, placement.offset_s);
  std::vector<int> all(scans.size(), 0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (sweep_of[i] != kNoSweep) all[i] = sweeps[sweep_of[i]].direction;
  }
  return all;
}

}  // namespace

double colour_value(const Placement& placement, Colouring colouring, std::uint32_t beam,
                    const std::array<float, 3>& place_m) {
  const Recording& recording = placement.loaded->recording;
  const Beams& beams = placement.loaded->beams;
  const LaserScan& scan = recording.scans[beams.scan[beam]];
  switch (colouring) {
    case Colouring::kElevation:
      return static_cast<double>(place_m[2]);
    case Colouring::kIntensity:
      return recording.intensities.empty()
                 ? 0
                 : static_cast<double>(recording.intensities[scan.first_range + beams.beam[beam]]);
    case Colouring::kTime:
      return beams.time_s(beam) - recording.scans.front().first_beam_s;
    case Colouring::kDirection:
      return 0;  // of the whole scan: see place_cloud
  }
  return 0;
}

std::string colour_unit(Colouring colouring) {
  switch (colouring) {
    case Colouring::kElevation:
      return "m";
    case Colouring::kTime:
      return "s";
    case Colouring::kIntensity:
    case Colouring::kDirection:
      break;
  }
  return "";
}

ColourSpan colour_span(Colouring colouring, const Loaded& loaded, const SolvedMap* a, const SolvedMap* b) {
  switch (colouring) {
    case Colouring::kElevation: {
      if (a == nullptr && b == nullptr) return {};
      const SolvedMap &first = a != nullptr ? *a : *b, &second = b != nullptr ? *b : *a;
      return {std::min(first.z_m.from, second.z_m.from), std::max(first.z_m.to, second.z_m.to)};
    }
    case Colouring::kIntensity: {
      std::vector<float> all = loaded.recording.intensities;
      if (all.empty()) return {};
      const auto at = [&](double part) {
        const auto place =
            all.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(all.size() - 1));
        std::nth_element(all.begin(), place, all.end());
        return static_cast<double>(*place);
      };
      const double from = at(0.01);
      return {from, at(0.99)};
    }
    case Colouring::kTime:
      return {0, std::max(loaded.duration_s(), 1e-3)};
    case Colouring::kDirection:
      return {-1.5, 1.5};  // the two directions stand well inside the table's ends
  }
  return {};
}

double difference_span_mm(const Placement& placement, const Placement& other) {
  const auto& chosen = placement.map->order.chosen;
  const Places a = place_beams(placement, &chosen), b = place_beams(other, &chosen);
  std::vector<double> distances_mm;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isfinite(a[i][0]) && std::isfinite(b[i][0])) distances_mm.push_back(distance_mm(a[i], b[i]));
  }
  if (distances_mm.empty()) return 1;
  const auto place =
      distances_mm.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(distances_mm.size() - 1));
  std::nth_element(distances_mm.begin(), place, distances_mm.end());
  return std::max(*place, 1.0);
}

PlacedCloud place_cloud(const Placement& placement, const CloudLook& look, bool coarse,
                        const Placement* other) {
  const DrawOrder& order = placement.map->order;
  const auto* chosen = coarse ? &order.chosen : nullptr;
  const Places places = place_beams(placement, chosen);
  const Places other_places = other != nullptr ? place_beams(*other, chosen) : Places();
  const std::vector<int> direction =
      look.colouring == Colouring::kDirection ? directions(placement) : std::vector<int>();
  const ColourScale scale{colour_table(look.table).value_or(ColourTable()), look.from, look.to};
  const Filter filter(placement, look);
  PlacedCloud cloud;
  auto points = std::make_shared<LivePoints>();
  for (const std::uint32_t slot : coarse ? order.chosen_order : order.all) {
    const std::uint32_t beam = coarse ? order.chosen[slot] : slot;
    if (!filter.shows(beam, places[slot])) continue;
    double value = 0;
    if (other != nullptr)
      value = distance_mm(places[slot], other_places[slot]);
    else if (!direction.empty())
      value = direction[placement.loaded->beams.scan[beam]];
    else
      value = colour_value(placement, look.colouring, beam, places[slot]);
    const Colour colour = scale.at(value);
    points->xyz_m.push_back(places[slot]);
    points->rgb.push_back({colour.red, colour.green, colour.blue});
    cloud.beams.push_back(beam);
  }
  cloud.points = std::move(points);
  return cloud;
}

}  // namespace sweepscope::ui
