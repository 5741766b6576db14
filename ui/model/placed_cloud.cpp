#include "ui/model/placed_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/numbers.hpp"
#include "core/parallel.hpp"

namespace sweepscope::ui {
namespace {

using Places = std::vector<std::array<float, 3>>;

/// Where the beams are whose numbers are `chosen`, or all.
Places places_of(const Placement& placement, const std::vector<std::uint32_t>* chosen, const Job& job = {}) {
  const Beams& beams = placement.loaded->beams;
  return chosen != nullptr ? place_beams(beams, placement.map->path, placement.offset_s, *chosen, job)
                           : place_beams(beams, placement.map->path, placement.offset_s, job);
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
    if (!in_box(place_m)) return false;
    if (look_.heights == Heights::kAll) return true;
    const double above_m = static_cast<double>(place_m[2] - placement_.map->path_height_m[beams.scan[beam]]);
    if (look_.heights == Heights::kSlab) return above_m >= look_.slab_from_m && above_m <= look_.slab_to_m;
    const auto& slabs = placement_.map->sharp_heights;
    if (look_.heights == Heights::kBelowCeiling) return slabs.empty() || above_m <= slabs.back().to_m;
    return std::any_of(slabs.begin(), slabs.end(), [&](const HeightRange& slab) {
      return above_m >= slab.from_m && above_m <= slab.to_m;
    });
  }

 private:
  bool in_box(const std::array<float, 3>& place_m) const {
    if (look_.box_from_m == look_.box_to_m) return true;
    const Eigen::Vector3d p_m(place_m[0], place_m[1], place_m[2]);
    return (p_m.array() >= look_.box_from_m.array()).all() && (p_m.array() <= look_.box_to_m.array()).all();
  }

  const Placement& placement_;
  const CloudLook& look_;
  double begin_s_ = 0;
};

/// Those of the slots that are shown, found and used in parallel; the same for any number of threads.
class Shown {
 public:
  template <typename Shows>
  Shown(const std::vector<std::uint32_t>& slots, const Shows& shows)
      : slots_(slots), shown_(slots.size()), first_((slots.size() + kBlock - 1) / kBlock + 1, 0) {
    for_each_index(first_.size() - 1, [&](std::size_t block) {
      std::size_t count = 0;
      for (std::size_t k = block * kBlock; k < end_of(block); ++k) {
        shown_[k] = shows(slots_[k]) ? 1 : 0;
        count += shown_[k];
      }
      first_[block + 1] = count;
    });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
  }

  std::size_t count() const { return first_.back(); }
  /// Calls `use` with the number among those shown, and with the slot.
  template <typename Use>
  void for_each(const Use& use) const {
    for_each_index(first_.size() - 1, [&](std::size_t block) {
      std::size_t at = first_[block];
      for (std::size_t k = block * kBlock; k < end_of(block); ++k) {
        if (shown_[k] != 0) use(at++, slots_[k]);
      }
    });
  }

 private:
  static constexpr std::size_t kBlock = 1 << 14;
  std::size_t end_of(std::size_t block) const { return std::min(slots_.size(), (block + 1) * kBlock); }

  const std::vector<std::uint32_t>& slots_;
  std::vector<std::uint8_t> shown_;
  std::vector<std::size_t> first_;  // of each block, among those shown
};

double distance_mm(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return 1e3 * static_cast<double>(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
}

/// +1 or -1 for each scan, by the sweep that it lies in; 0 outside.
std::vector<int> directions(const Placement& placement) {
  const auto& sweeps = placement.loaded->prepared.motor.sweeps;
  const auto& scans = placement.loaded->recording.scans;
  const auto sweep_of = assign_sweeps(scans, sweeps, placement.offset_s);
  std::vector<int> all(scans.size(), 0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (sweep_of[i] != kNoSweep) all[i] = sweeps[sweep_of[i]].direction;
  }
  return all;
}

/// The map's points in the form that measures of maps take, and the beam of each.
struct WholeMap {
  MapCloud cloud;
  std::vector<std::uint32_t> beams;
};

WholeMap whole_map(const Placement& placement, const Job& job) {
  const Places places = places_of(placement, nullptr, job);
  const Beams& beams = placement.loaded->beams;
  const auto sweep_of =
      assign_sweeps(beams.recording->scans, placement.loaded->prepared.motor.sweeps, placement.offset_s);
  WholeMap map;
  for (std::uint32_t i = 0; i < places.size(); ++i) {
    if (!std::isfinite(places[i][0])) continue;
    MapPoint point{};
    point.x = places[i][0];
    point.y = places[i][1];
    point.z = places[i][2];
    point.sweep = static_cast<std::uint32_t>(sweep_of[beams.scan[i]]);
    point.time_s = beams.time_s(i);
    map.cloud.push_back(point);
    map.beams.push_back(i);
  }
  return map;
}

/// The number of a scan's beam among all that returned something.
void mark(const Beams& beams, const FeatureList& list, FeatureKind kind, BeamValues& values) {
  for (const Feature& feature : list.features) {
    const auto first = beams.beam.begin() + static_cast<std::ptrdiff_t>(beams.first_point[feature.scan]);
    const auto last = beams.beam.begin() + static_cast<std::ptrdiff_t>(beams.first_point[feature.scan + 1]);
    const auto found = std::lower_bound(first, last, std::uint32_t{feature.beam});
    if (found != last && *found == feature.beam)
      values[static_cast<std::size_t>(found - beams.beam.begin())] = static_cast<float>(kind);
  }
}

Colour colour_of_value(const CloudLook& look, const ColourScale& scale, double value, bool distances) {
  if (std::isnan(value)) return {96, 104, 116};
  if (look.colouring == ColourBy::kFeatures && !distances)
    return colour_of_feature(static_cast<FeatureKind>(static_cast<int>(value)));
  return scale.at(value);
}

}  // namespace

ColourTable shown_table(const std::string& name, bool on_light) {
  const ColourTable whole = colour_table(name).value_or(ColourTable());
  if (!on_light || name == "turbo") return whole;
  const double last = name == "grey" ? 0.75 : 0.88;  // darker than the ground by eye, for all three
  ColourTable part = whole;
  for (std::size_t i = 0; i < part.size(); ++i)
    part[i] = whole[static_cast<std::size_t>(std::lround(last * static_cast<double>(i)))];
  return part;
}

bool is_slow(ColourBy by) {
  return by == ColourBy::kFeatures || by == ColourBy::kBlur;
}

SlowValues slow_values(const Placement& placement, ColourBy by, const FeatureSet* features, const Job& job) {
  SlowValues found;
  const Beams& beams = placement.loaded->beams;
  auto values = std::make_shared<BeamValues>(beams.size(), std::numeric_limits<float>::quiet_NaN());
  if (by == ColourBy::kFeatures && features != nullptr) {
    std::fill(values->begin(), values->end(), 0.0f);
    mark(beams, features->planes, FeatureKind::kPlane, *values);
    mark(beams, features->edges, FeatureKind::kEdge, *values);
  }
  if (by == ColourBy::kBlur) {
    const WholeMap map = whole_map(placement, job);
    const SurfaceThickness thickness = surface_thickness(map.cloud, {}, job);
    for (std::size_t i = 0; i < map.beams.size(); ++i)
      (*values)[map.beams[i]] = thickness.surfaces[i].thickness_m * 1000;
    found.thickness = thickness.map;
  }
  found.values = std::move(values);
  return found;
}

double intensity_of(const Placement& placement, std::uint32_t beam) {
  const Recording& recording = placement.loaded->recording;
  const Beams& beams = placement.loaded->beams;
  if (recording.intensities.empty()) return 0;
  return static_cast<double>(
      recording.intensities[recording.scans[beams.scan[beam]].first_range + beams.beam[beam]]);
}

Colour colour_of_feature(FeatureKind kind) {
  if (kind == FeatureKind::kEdge) return {255, 176, 59};
  if (kind == FeatureKind::kPlane) return {86, 180, 233};
  return {64, 72, 84};
}

ColourSpan colour_span(ColourBy by, const Loaded& loaded, const SolvedMap* a, const SolvedMap* b) {
  switch (by) {
    case ColourBy::kElevation: {
      if (a == nullptr && b == nullptr) return {};
      const SolvedMap &first = a != nullptr ? *a : *b, &second = b != nullptr ? *b : *a;
      return {std::min(first.main_box.from_m.z(), second.main_box.from_m.z()),
              std::max(first.main_box.to_m.z(), second.main_box.to_m.z())};
    }
    case ColourBy::kIntensity:
      return {loaded.min_intensity, loaded.max_intensity};
    case ColourBy::kTime:
      return {0, std::max(loaded.duration_s(), 1e-3)};
    case ColourBy::kDirection:
      return {-1.5, 1.5};  // the two directions stand well inside the table's ends
    case ColourBy::kBlur:
      return {0, 150};  // mm, until both maps are measured
    case ColourBy::kFeatures:
    case ColourBy::kDistance:
      break;
  }
  return {};
}

ColourSpan blur_span(const MapThickness& a, const MapThickness& b) {
  constexpr double kMaxRatio = 4;  // beyond, the thinner map would have one colour
  const auto [thin_m, thick_m] = std::minmax(a.median_m, b.median_m);
  const double end_mm = 1e3 * std::min(thick_m, kMaxRatio * thin_m);
  for (const double mm : {10, 20, 30, 50, 75, 100, 150, 200, 300})
    if (end_mm <= mm) return {0, mm};
  return {0, 400};
}

double difference_span_mm(const Placement& placement, const Placement& other) {
  const auto& chosen = placement.map->order.chosen;
  const Places a = places_of(placement, &chosen), b = places_of(other, &chosen);
  std::vector<double> distances_mm;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isfinite(a[i][0]) && std::isfinite(b[i][0])) distances_mm.push_back(distance_mm(a[i], b[i]));
  }
  if (distances_mm.empty()) return 1;
  return std::max(quantile(distances_mm, 0.95), 1.0);
}

namespace {

/// `slots`: numbers of beams, or of those chosen, in the order of drawing. `spacing_m`: of each slot, or
/// null.
PlacedCloud place_in_order(const Placement& placement, const CloudLook& look,
                           const std::vector<std::uint32_t>* chosen, const std::vector<std::uint32_t>& slots,
                           const Placement* other, const BeamValues* slow,
                           const std::vector<float>* spacing_m, const Job& job = {}) {
  const Places places = places_of(placement, chosen, job);
  const Places other_places = other != nullptr ? places_of(*other, chosen, job) : Places();
  const std::vector<int> direction =
      look.colouring == ColourBy::kDirection ? directions(placement) : std::vector<int>();
  const double begin_s = placement.loaded->recording.scans.front().first_beam_s;
  const auto value_of = [&](std::uint32_t beam, std::uint32_t slot) -> double {
    if (other != nullptr) return distance_mm(places[slot], other_places[slot]);
    switch (look.colouring) {
      case ColourBy::kIntensity:
        return intensity_of(placement, beam);
      case ColourBy::kTime:
        return placement.loaded->beams.time_s(beam) - begin_s;
      case ColourBy::kDirection:
        return direction[placement.loaded->beams.scan[beam]];
      case ColourBy::kFeatures:
      case ColourBy::kBlur:
        return slow != nullptr ? static_cast<double>((*slow)[beam]) : std::nan("");
      default:
        return static_cast<double>(places[slot][2]);
    }
  };
  const ColourScale scale{shown_table(look.table, look.on_light), look.from, look.to};
  const Filter filter(placement, look);
  const auto beam_of = [&](std::uint32_t slot) { return chosen != nullptr ? (*chosen)[slot] : slot; };
  const Shown shown(slots, [&](std::uint32_t slot) { return filter.shows(beam_of(slot), places[slot]); });
  PlacedCloud cloud;
  auto points = std::make_shared<LivePoints>();
  points->xyz_m.resize(shown.count());
  points->rgb.resize(shown.count());
  if (spacing_m != nullptr) points->spacing_m.resize(shown.count());
  cloud.beams.resize(shown.count());
  shown.for_each([&](std::size_t at, std::uint32_t slot) {
    const std::uint32_t beam = beam_of(slot);
    const Colour colour = colour_of_value(look, scale, value_of(beam, slot), other != nullptr);
    points->xyz_m[at] = places[slot];
    points->rgb[at] = {colour.red, colour.green, colour.blue};
    if (spacing_m != nullptr) points->spacing_m[at] = (*spacing_m)[slot];
    cloud.beams[at] = beam;
  });
  cloud.points = std::move(points);
  return cloud;
}

}  // namespace

PlacedCloud place_cloud(const Placement& placement, const CloudLook& look, bool coarse,
                        const Placement* other, const BeamValues* slow, const Job& job) {
  const DrawOrder& order = placement.map->order;
  if (coarse)
    return place_in_order(placement, look, &order.chosen, order.chosen_order, other, slow,
                          &order.chosen_spacing_m, job);
  return place_in_order(placement, look, nullptr, order.all, other, slow, &order.spacing_m, job);
}

PlacedCloud place_chosen(const Placement& placement, const CloudLook& look,
                         const std::vector<std::uint32_t>& beams, const Placement* other,
                         const BeamValues* slow) {
  std::vector<std::uint32_t> slots(beams.size());
  std::iota(slots.begin(), slots.end(), 0);
  return place_in_order(placement, look, &beams, slots, other, slow, nullptr);
}

}  // namespace sweepscope::ui
