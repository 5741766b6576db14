#include "ui/explorer/map_pair.hpp"

#include <algorithm>
#include <memory>

namespace sweepscope::ui {
namespace {

constexpr double kRest_s = 0.15;  // after the last change, before all points are placed

std::array<double, 2> offsets_s(const Settings& settings) {
  return {settings.offset_a_ms * 1e-3, settings.offset_b_ms * 1e-3};
}

}  // namespace

std::vector<Side> sides_of(Layout layout) {
  if (layout == Layout::kOnlyA) return {Side::kA};
  if (layout == Layout::kOnlyB || layout == Layout::kDifference) return {Side::kB};
  return {Side::kA, Side::kB};
}

void MapPair::open(LoadedPtr loaded, SolvedMapPtr first, std::optional<RigKind> assume) {
  close();
  solved.open(std::move(loaded), std::move(first), assume);
}

void MapPair::close() {
  background_.cancel(placing_);
  solved.close();
  blur.close();
  panes_ = {};
}

std::optional<Box> MapPair::extent_in_view(Heights heights) const {
  std::optional<Box> all;
  for (const Pane& pane : panes_) {
    const SolvedMapPtr map =
        pane.request ? solved.nearest(pane.request->placement.offset_s) : solved.nearest(0);
    if (!map) continue;
    const Box& box = map->extent(heights);
    if (!all) all = box;
    all = Box{all->from_m.cwiseMin(box.from_m), all->to_m.cwiseMax(box.to_m)};
  }
  return all;
}

/// While a handle is held, the path is the one that the pane was placed along when the drag began.
SolvedMapPtr MapPair::map_for(Side side, double offset_s) const {
  const auto& shown = pane(side).request;
  return held_ && shown && !shown->placement.map->provisional ? shown->placement.map
                                                              : solved.nearest(offset_s);
}

ColourSpan MapPair::wanted_span(const Settings& s, const Placement& a, const Placement& b) const {
  const ColourBy by = s.colouring;
  const SlowValues *at_a = blur.at(a), *at_b = blur.at(b);
  if (by == ColourBy::kBlur && at_a && at_b && at_a->thickness && at_b->thickness)
    return blur_span(*at_a->thickness, *at_b->thickness);
  if (by == ColourBy::kElevation && s.heights == Heights::kBelowCeiling) {
    const Box &box_a = a.map->low_box, &box_b = b.map->low_box;
    return {std::min(box_a.from_m.z(), box_b.from_m.z()), std::max(box_a.to_m.z(), box_b.to_m.z())};
  }
  return colour_span(by, *a.loaded, a.map.get(), b.map.get());
}

CloudLook MapPair::wanted_look(const Settings& s, const Placement& a, const Placement& b) {
  // Under the mouse colours hold still: a drag goes from map to map.
  if (!held_ || span_colouring_ != s.colouring) {
    span_ = wanted_span(s, a, b);
    span_colouring_ = s.colouring;
  }
  const bool given = s.colour_to > s.colour_from;
  const bool on_light =
      s.backdrop == Backdrop::kWhite || (s.backdrop == Backdrop::kTheme && s.theme == Theme::kLight);
  return {.colouring = s.colouring,
          .table = s.table,
          .from = given ? s.colour_from : span_.from,
          .to = given ? s.colour_to : span_.to,
          .heights = s.heights,
          .slab_from_m = s.slab_from_m,
          .slab_to_m = s.slab_to_m,
          .time_from_s = s.time_from_s,
          .time_to_s = s.time_to_s,
          .box_from_m = s.box_from_m,
          .box_to_m = s.box_to_m,
          .on_light = on_light};
}

void MapPair::update(const Settings& settings, double seconds_since_last, bool estimating) {
  show_both(settings);
  rest_s_ += seconds_since_last;
  if (rest_s_ >= kRest_s && !held_) start_full();
  auto wanted_s = offsets_s(settings);
  // Along a trajectory that is known B, the answer, comes first: A is previewed along the same, B would not
  // be.
  if (solved.loaded()->walk->get()) std::swap(wanted_s[0], wanted_s[1]);
  solved.solve(wanted_s, held_ || (estimating && solved.is_first_to_come()));
}

void MapPair::show_both(const Settings& settings) {
  const auto [a_s, b_s] = offsets_s(settings);
  const Placement a{solved.loaded(), map_for(Side::kA, a_s), a_s},
      b{solved.loaded(), map_for(Side::kB, b_s), b_s};
  look_ = wanted_look(settings, a, b);
  CloudRequest at_a{a, look_, {}}, at_b{b, look_, {}};
  if (settings.layout == Layout::kDifference) {
    at_b.other = a;
    const auto& shown = pane(Side::kB).request;
    const auto& beside = pane(Side::kA).request;
    // A given range holds for both maps, a found one of distances for B alone.
    const bool was_given =
        shown && beside && shown->look.from == beside->look.from && shown->look.to == beside->look.to;
    const bool same = shown && shown->other && shown->placement == b && *shown->other == a && !was_given;
    if (settings.colour_to <= settings.colour_from) {
      at_b.look.from = 0;
      at_b.look.to = same ? shown->look.to : difference_span_mm(b, a);
    }
    look_ = at_b.look;
  }
  show(Side::kA, std::move(at_a));
  show(Side::kB, std::move(at_b));
}

void MapPair::show(Side side, CloudRequest request) {
  Pane& pane = pane_of(side);
  const SolvedMap& map = *request.placement.map;
  const double offset_s = request.placement.offset_s;
  pane.state = map.provisional                  ? PaneState::kProvisional
               : solved.is_exact(map, offset_s) ? PaneState::kSolved
                                                : PaneState::kPreview;
  pane.lost = map.lost;
  pane.consistency = map.path.consistency;
  pane.warning = map.path.warning;
  pane.problem = solved.problem_at(offset_s);
  if (pane.state != PaneState::kSolved && solved.is_cancelled(offset_s))
    pane.problem = "Cancelled. Move the offset, or choose Solve the maps in the menu Offset.";
  if (pane.request == request) return;
  if (request.look.colouring == ColourBy::kBlur) use_known_blur(pane, request.placement);
  // The thickness of a surface at another offset would be a false picture: those points stay grey.
  const bool known =
      pane.slow_colouring == request.look.colouring &&
      (request.look.colouring == ColourBy::kFeatures || pane.slow_placement == request.placement);
  const BeamValues* slow = known ? pane.slow.get() : nullptr;
  pane.coarse = std::make_shared<PlacedCloud>(
      place_cloud(request.placement, request.look, true, request.other_or_null(), slow));
  pane.full = nullptr;
  pane.request = std::move(request);
  rest_s_ = 0;
  background_.cancel(placing_);
}

void MapPair::use_known_blur(Pane& pane, const Placement& placement) const {
  const SlowValues* known = blur.at(placement);
  if (known == nullptr) return;
  pane.slow = known->values;
  pane.thickness = known->thickness;
  pane.slow_colouring = ColourBy::kBlur;
  pane.slow_placement = placement;
}

MapPair::PlacedAll MapPair::place_fully(const CloudRequest& request, const SlowValues& known,
                                        const Job& job) {
  const auto& [placement, look, other] = request;
  PlacedAll placed;
  placed.slow = known;
  if (!other && !known.values && is_slow(look.colouring)) {
    const FeatureSet* features = placement.loaded->prepared.features.get();
    placed.slow = slow_values(placement, look.colouring, features, job);
    placed.coarse = std::make_shared<PlacedCloud>(
        place_cloud(placement, look, true, nullptr, placed.slow.values.get(), job));
  }
  placed.full = std::make_shared<PlacedCloud>(
      place_cloud(placement, look, false, request.other_or_null(), placed.slow.values.get(), job));
  return placed;
}

/// One job for both panes, so that they change together.
void MapPair::start_full() {
  if (!placing_.empty() && background_.has(placing_)) return;
  std::vector<Side> sides;
  std::vector<CloudRequest> requests;
  std::vector<SlowValues> known;  // empty where it is not known
  for (const Side side : kBothSides) {
    if (pane(side).full || !pane(side).request) continue;
    sides.push_back(side);
    requests.push_back(*pane(side).request);
    const auto& [placement, look, other] = requests.back();
    const SlowValues* blurred = look.colouring == ColourBy::kBlur && !other ? blur.at(placement) : nullptr;
    known.push_back(blurred != nullptr ? *blurred : SlowValues());
  }
  if (sides.empty()) return;
  placing_ = "place " + std::to_string(++placings_);
  background_.start("place", placing_, "Placing all points",
                    [this, sides, requests, known](const Job& job) -> Background::Finish {
                      std::vector<PlacedAll> placed;
                      for (std::size_t i = 0; i < requests.size(); ++i) {
                        if (job.cancelled()) return {};
                        placed.push_back(place_fully(requests[i], known[i], job));
                      }
                      if (job.cancelled()) return {};
                      return [this, sides, requests, placed = std::move(placed)] {
                        take(sides, requests, placed);
                      };
                    });
}

void MapPair::take(std::span<const Side> sides, std::span<const CloudRequest> requests,
                   std::span<const PlacedAll> placed) {
  for (std::size_t i = 0; i < sides.size(); ++i) {
    Pane& target = pane_of(sides[i]);
    if (requests[i].look.colouring == ColourBy::kBlur && placed[i].slow.values)
      blur.keep(requests[i].placement, placed[i].slow);
    if (target.request != requests[i]) continue;
    target.full = placed[i].full;
    target.slow = placed[i].slow.values;
    target.thickness = placed[i].slow.thickness;
    target.slow_colouring = requests[i].look.colouring;
    target.slow_placement = placed[i].slow.values ? std::optional(requests[i].placement) : std::nullopt;
    if (placed[i].coarse) target.coarse = placed[i].coarse;
  }
}

void MapPair::show_close_ups(const PlacePtr& place) {
  for (const Side side : kBothSides) place_close_up(side, place);
}

/// Few enough beams to be placed in every frame: a close-up follows a handle with all its points.
void MapPair::place_close_up(Side side, const PlacePtr& place) {
  Pane& target = pane_of(side);
  const bool fits =
      target.slow_colouring == look_.colouring && target.slow_placement == target.request->placement;
  const BeamValuesPtr slow = fits ? target.slow : nullptr;
  if (target.close_up_place == place && target.close_up_request == target.request &&
      target.close_up_slow == slow)
    return;
  target.close_up_place = place;
  target.close_up_request = target.request;
  target.close_up_slow = slow;
  target.close_up = nullptr;
  if (!place) return;
  const CloudRequest& request = *target.request;
  target.close_up = std::make_shared<PlacedCloud>(
      ui::place_close_up(*place, request.placement, request.look, request.other_or_null(), slow.get()));
}

void MapPair::cancel(const Settings& settings) {
  if (solved.loaded()) solved.cancel(offsets_s(settings));
}

bool MapPair::waits_to_place() const {
  return solved.loaded() && !held_ && !has_all_points() && (placing_.empty() || !background_.has(placing_));
}

bool MapPair::is_complete() const {
  return std::ranges::all_of(panes_, [&](const Pane& pane) {
    return pane.full && pane.state == PaneState::kSolved &&
           !solved.is_to_come(pane.request->placement.offset_s);
  });
}

bool MapPair::at_rest() const {
  return std::ranges::all_of(panes_, [](const Pane& pane) {
    return pane.full && (pane.state == PaneState::kSolved || !pane.problem.empty());
  });
}

}  // namespace sweepscope::ui
