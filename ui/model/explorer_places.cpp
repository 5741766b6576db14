#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ui/model/explorer.hpp"

namespace sweepscope::ui {
namespace {

constexpr const char* kPlaces = "places";

tl::unexpected<Error> no_places() {
  return failure(ExitCode::kWrongUsage,
                 "There is no place to go to: the maps are not both solved yet, or they do not differ.");
}

}  // namespace

PlacePtr Explorer::place() const {
  if (places_.empty() || !settings_.close_up) return nullptr;
  const auto number = static_cast<std::size_t>(std::max(1.0, settings_.place));
  return places_[std::min(number, places_.size()) - 1];
}

/// Once both maps are there in full: half a second of work for 1.7 million points.
void Explorer::update_places() {
  const Pane &a = pane(Side::kA), &b = pane(Side::kB);
  const bool complete = a.full && b.full && a.state == PaneState::kSolved && b.state == PaneState::kSolved;
  if (settings_.close_up && complete && !handle_held_)
    start_places(a.request->placement, b.request->placement);
  for (const Side side : kBothSides) place_close_up(side);
  if (fitted_beside_ == (place() != nullptr)) return;
  fitted_beside_ = place() != nullptr;
  refit_view();
}

void Explorer::start_places(const Placement& a, const Placement& b) {
  if (places_of_ == std::pair(a, b)) return;
  background_.cancel(kPlaces);
  places_of_ = std::pair(a, b);
  if (a == b) return take(std::vector<PlacePtr>());
  background_.start(kPlaces, kPlaces, "Comparing the maps",
                    [this, a, b](const Job& job) -> Background::Finish {
                      auto places = std::make_shared<std::vector<PlacePtr>>(find_places(a, b, job));
                      return [this, places] { take(std::move(*places)); };
                    });
}

/// The best place is shown, or, where a person went to another one, the one nearest to it.
void Explorer::take(std::vector<PlacePtr> places) {
  const PlacePtr before = place();
  places_ = std::move(places);
  if (before && settings_.place > 1 && !places_.empty()) {
    const auto distance_m = [&](const PlacePtr& other) {
      return (other->found.region.centre_m - before->found.region.centre_m).norm();
    };
    const auto nearest = std::min_element(
        places_.begin(), places_.end(),
        [&](const PlacePtr& one, const PlacePtr& other) { return distance_m(one) < distance_m(other); });
    settings_.place = 1.0 + static_cast<double>(nearest - places_.begin());
  }
}

/// Few enough beams to be placed in every frame: a close-up follows a handle with all its points.
void Explorer::place_close_up(Side side) {
  Pane& target = pane_of(side);
  const PlacePtr at = place();
  const bool fits =
      target.slow_colouring == look_.colouring && target.slow_placement == target.request->placement;
  const BeamValuesPtr slow = fits ? target.slow : nullptr;
  if (target.close_up_place == at && target.close_up_request == target.request &&
      target.close_up_slow == slow)
    return;
  target.close_up_place = at;
  target.close_up_request = target.request;
  target.close_up_slow = slow;
  target.close_up = nullptr;
  if (!at) return;
  const CloudRequest& request = *target.request;
  target.close_up = std::make_shared<PlacedCloud>(ui::place_close_up(
      *at, request.placement, request.look, request.other ? &*request.other : nullptr, slow.get()));
}

Result<void> Explorer::next_place(bool back) {
  if (!settings_.close_up) return perform("close-up on");
  if (places_.empty()) return no_places();
  const auto count = static_cast<double>(places_.size());
  Settings next = settings_;
  next.place = std::clamp(next.place, 1.0, count) + (back ? -1 : 1);
  if (next.place < 1) next.place = count;
  if (next.place > count) next.place = 1;
  change_settings(std::move(next), {});
  return {};
}

Result<void> Explorer::look_at_place() {
  const PlacePtr at = place();
  if (!at) return no_places();
  constexpr double kRoom = 1.5;
  const Eigen::Vector2d& centre_m = at->found.region.centre_m;
  const auto rounded = [](double metres) { return std::round(metres * 100) / 100; };
  Settings next = settings_;
  for (ViewPoint* view : {&next.camera_a, &next.camera_b}) {
    view->centre_m = {rounded(centre_m.x()), rounded(centre_m.y()), rounded(at->z_m)};
    view->height_m = rounded(kRoom * at->height_m());
  }
  view_moved_ = true;
  change_settings(std::move(next), {});
  return {};
}

}  // namespace sweepscope::ui
