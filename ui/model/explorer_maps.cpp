#include <algorithm>
#include <cmath>

#include "ui/model/explorer.hpp"
#include "ui/model/task_plans.hpp"

namespace sweepscope::ui {
namespace {

constexpr double kRest_s = 0.15;      // after the last change, before all points are placed
constexpr std::size_t kMaxKept = 12;  // solved maps

std::int64_t to_ns(double offset_s) {
  return static_cast<std::int64_t>(std::llround(offset_s * 1e9));
}

std::string solve_key(std::int64_t offset_ns) {
  return "solve " + std::to_string(offset_ns);
}

PlacedAll place_fully(const CloudRequest& request, const FeatureSet* features, const Job& job) {
  const Placement* other = request.other ? &*request.other : nullptr;
  PlacedAll placed;
  if (other == nullptr && is_slow(request.look.colouring)) {
    placed.slow = slow_values(request.placement, request.look.colouring, features, job);
    placed.coarse = std::make_shared<PlacedCloud>(
        place_cloud(request.placement, request.look, true, nullptr, placed.slow.values.get()));
  }
  placed.full = std::make_shared<PlacedCloud>(
      place_cloud(request.placement, request.look, false, other, placed.slow.values.get()));
  return placed;
}

}  // namespace

bool Explorer::stands(const Loaded& loaded, const std::optional<RigKind>& assume) {
  if (assume) return *assume == RigKind::kStationary;
  return !loaded.moving.value_or(false);
}

bool Explorer::without_solving() const {
  return !loaded_->poses.empty() || stands(*loaded_, options_.assume);
}

double Explorer::offset_s(Side side) const {
  return (side == Side::kA ? settings_.offset_a_ms : settings_.offset_b_ms) * 1e-3;
}

SolvedMapPtr Explorer::solved_at(double offset_s) const {
  const auto found = solved_.find(to_ns(offset_s));
  return found != solved_.end() ? found->second : nullptr;
}

SolvedMapPtr Explorer::nearest_solved(double offset_s) const {
  SolvedMapPtr nearest;
  for (const auto& [ns, map] : solved_) {
    if (!nearest || std::abs(map->offset_s - offset_s) < std::abs(nearest->offset_s - offset_s))
      nearest = map;
  }
  return nearest;
}

Placement Explorer::placement_of(Side side) const {
  const double offset = offset_s(side);
  SolvedMapPtr map = solved_at(offset);
  if (!map) map = nearest_solved(offset);
  if (!map) map = provisional_;
  return {loaded_, std::move(map), offset};
}

CloudLook Explorer::wanted_look(const SolvedMap* a, const SolvedMap* b) {
  const Settings& s = settings_;
  if (span_maps_[0] != a || span_maps_[1] != b || span_colouring_ != s.colouring) {
    span_ = colour_span(s.colouring, *loaded_, a, b);
    span_maps_ = {a, b};
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

void Explorer::update(double seconds_since_last) {
  if (message_ && !message_held_) {
    message_->shown_s += seconds_since_last;
    if (message_->shown_s > message_->lasts_s()) message_.reset();
  }
  background_.take_finished();
  update_growing_curve();
  if (!loaded_) {
    panes_ = {};
    return;
  }
  update_panes(seconds_since_last);
  update_places();
  update_solving();
  update_playback(seconds_since_last);
}

void Explorer::update_playback(double seconds_since_last) {
  if (settings_.time_s < 0) playing_ = false;
  if (!playing_) return;
  settings_.time_s += seconds_since_last * settings_.play_speed;  // nothing that undo would take back
  if (settings_.time_s < loaded_->duration_s()) return;
  settings_.time_s = loaded_->duration_s();
  playing_ = false;
}

Result<void> Explorer::play(const Call& call) {
  if (!loaded_) return failure(ExitCode::kWrongUsage, "There is no recording to play.");
  playing_ = call.values.empty() ? !playing_ : std::get<bool>(call.values[0]);
  const bool from_start = settings_.time_s < 0 || settings_.time_s >= loaded_->duration_s();
  if (playing_ && from_start) settings_.time_s = 0;
  return {};
}

void Explorer::update_panes(double seconds_since_last) {
  const Placement a = placement_of(Side::kA), b = placement_of(Side::kB);
  look_ = wanted_look(a.map.get(), b.map.get());
  CloudRequest at_a{a, look_, {}}, at_b{b, look_, {}};
  if (settings_.layout == Layout::kDifference) {
    at_b.other = a;
    const auto& shown = pane(Side::kB).request;
    const auto& beside = pane(Side::kA).request;
    // A given range holds for both maps, a found one of distances for B alone.
    const bool was_given =
        shown && beside && shown->look.from == beside->look.from && shown->look.to == beside->look.to;
    const bool same = shown && shown->other && shown->placement == b && *shown->other == a && !was_given;
    if (settings_.colour_to <= settings_.colour_from) {
      at_b.look.from = 0;
      at_b.look.to = same ? shown->look.to : difference_span_mm(b, a);
    }
    look_ = at_b.look;
  }
  show(Side::kA, std::move(at_a));
  show(Side::kB, std::move(at_b));
  rest_s_ += seconds_since_last;
  if (rest_s_ >= kRest_s && !handle_held_) start_full();
}

void Explorer::show(Side side, CloudRequest request) {
  Pane& pane = pane_of(side);
  const SolvedMap& map = *request.placement.map;
  const bool exact =
      without_solving() || (!map.provisional && to_ns(map.offset_s) == to_ns(request.placement.offset_s));
  pane.state = map.provisional ? PaneState::kProvisional : exact ? PaneState::kSolved : PaneState::kPreview;
  pane.lost = map.lost;
  const auto why = unsolvable_.find(to_ns(request.placement.offset_s));
  pane.problem = why != unsolvable_.end() ? why->second : "";
  if (pane.state != PaneState::kSolved && cancelled_.contains(to_ns(request.placement.offset_s)))
    pane.problem = "Cancelled. Move the offset, or choose Solve the maps in the menu Offset.";
  if (pane.request == request) return;
  const Placement* other = request.other ? &*request.other : nullptr;
  // The thickness of a surface at another offset would be a false picture: those points stay grey.
  const bool known =
      pane.slow_colouring == request.look.colouring &&
      (request.look.colouring == ColourBy::kFeatures || pane.slow_placement == request.placement);
  const BeamValues* slow = known ? pane.slow.get() : nullptr;
  pane.coarse =
      std::make_shared<PlacedCloud>(place_cloud(request.placement, request.look, true, other, slow));
  pane.full = nullptr;
  pane.request = std::move(request);
  rest_s_ = 0;
  background_.cancel(placing_);
}

/// One job for both panes, so that they change together.
void Explorer::start_full() {
  if (!placing_.empty() && background_.has(placing_)) return;
  std::vector<Side> sides;
  std::vector<CloudRequest> requests;
  for (const Side side : kBothSides) {
    if (pane(side).full || !pane(side).request) continue;
    sides.push_back(side);
    requests.push_back(*pane(side).request);
  }
  if (sides.empty()) return;
  placing_ = "place " + std::to_string(++placings_);
  background_.start(
      "place", placing_, "Placing all points", [this, sides, requests](const Job& job) -> Background::Finish {
        std::vector<PlacedAll> placed;
        for (const CloudRequest& request : requests) {
          if (job.cancelled()) return {};
          const auto& features = request.placement.loaded->prepared.features;
          placed.push_back(place_fully(request, features.get(), job));
        }
        if (job.cancelled()) return {};
        return [this, sides, requests, placed = std::move(placed)] { take(sides, requests, placed); };
      });
}

void Explorer::take(std::span<const Side> sides, std::span<const CloudRequest> requests,
                    std::span<const PlacedAll> placed) {
  for (std::size_t i = 0; i < sides.size(); ++i) {
    Pane& target = pane_of(sides[i]);
    if (target.request != requests[i]) continue;
    target.full = placed[i].full;
    target.slow = placed[i].slow.values;
    target.thickness = placed[i].slow.thickness;
    target.slow_colouring = requests[i].look.colouring;
    target.slow_placement = placed[i].slow.values ? std::optional(requests[i].placement) : std::nullopt;
    if (placed[i].coarse) target.coarse = placed[i].coarse;
  }
}

void Explorer::update_solving() {
  std::vector<std::int64_t> wanted;
  for (const Side side : kBothSides) {
    const std::int64_t ns = to_ns(offset_s(side));
    if (!solved_.contains(ns) && !unsolvable_.contains(ns) && !cancelled_.contains(ns) &&
        std::find(wanted.begin(), wanted.end(), ns) == wanted.end())
      wanted.push_back(ns);
  }
  for (const std::string& key : background_.keys("solve ")) {
    const bool still =
        std::any_of(wanted.begin(), wanted.end(), [&](auto ns) { return solve_key(ns) == key; });
    if (!still) background_.cancel(key);
  }
  if (handle_held_) return;
  for (const std::int64_t ns : wanted) {
    if (background_.has(solve_key(ns))) continue;
    const double offset_s = static_cast<double>(ns) * 1e-9;
    background_.start(
        "solve", solve_key(ns), "Solving the map",
        [this, ns, offset_s, loaded = loaded_, assume = options_.assume](const Job& job) {
          auto solved = std::make_shared<Result<SolvedMapPtr>>(solve_map(*loaded, offset_s, assume, job));
          return [this, ns, solved] { keep_solved(ns, *solved); };
        },
        steps_of_solving());
  }
}

void Explorer::keep_solved(std::int64_t offset_ns, Result<SolvedMapPtr> solved) {
  if (!solved) {
    unsolvable_[offset_ns] = solved.error().message;
    return;
  }
  const bool first = solved_.empty();
  solved_[offset_ns] = *solved;
  solved_order_.push_back(offset_ns);
  if (solved_order_.size() > kMaxKept) {
    solved_.erase(solved_order_.front());
    solved_order_.erase(solved_order_.begin());
  }
  if (!first || view_moved_) return;
  update_panes(0);  // the first whole map: its extent is known now
  settings_ = with_fitted_view();
}

bool Explorer::waits_to_place() const {
  if (!loaded_ || handle_held_ || (!placing_.empty() && background_.has(placing_))) return false;
  return std::any_of(kBothSides.begin(), kBothSides.end(), [&](Side side) { return !pane(side).full; });
}

bool Explorer::at_rest() const {
  if (background_.busy()) return false;
  if (!loaded_) return true;
  for (const Side side : kBothSides) {
    const Pane& shown = pane(side);
    if (!shown.full) return false;
    if (shown.state != PaneState::kSolved && shown.problem.empty()) return false;
  }
  return true;
}

}  // namespace sweepscope::ui
