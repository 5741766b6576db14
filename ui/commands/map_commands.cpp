#include <algorithm>
#include <cmath>

#include "ui/commands/commands.hpp"
#include "ui/explorer/explorer.hpp"

namespace sweepscope::ui {
namespace {

tl::unexpected<Error> no_places() {
  return not_now("There is no place to go to: the maps are not both solved yet, or they do not differ.");
}

Result<void> next_place(Explorer& explorer, const Call& call) {
  Settings next = explorer.settings();
  if (!next.close_up) return explorer.perform("close-up on");
  if (explorer.places.all().empty()) return no_places();
  const auto count = static_cast<double>(explorer.places.all().size());
  next.place = std::clamp(next.place, 1.0, count) + (call.text(0) == "back" ? -1 : 1);
  if (next.place < 1) next.place = count;
  if (next.place > count) next.place = 1;
  explorer.change(std::move(next));
  return {};
}

Result<void> look_at_place(Explorer& explorer, const Call&) {
  const PlacePtr at = explorer.place();
  if (!at) return no_places();
  constexpr double kRoom = 1.5;
  const Eigen::Vector2d& centre_m = at->found.region.centre_m;
  const auto rounded = [](double metres) { return std::round(metres * 100) / 100; };
  Settings next = explorer.settings();
  for (ViewPoint* view : {&next.camera_a, &next.camera_b}) {
    view->centre_m = {rounded(centre_m.x()), rounded(centre_m.y()), rounded(at->z_m)};
    view->height_m = rounded(kRoom * at->height_m());
  }
  explorer.view.moved_by_person = true;
  explorer.change(std::move(next));
  return {};
}

/// The search as a hint asks for it.
Settings searching(Settings settings, const std::string& how) {
  const Settings automatic;
  settings.search = how == "over-time" ? Search::kOverTime : automatic.search;
  settings.solve_for = how == "mount" || how == "encoder" ? "offset," + how : automatic.solve_for;
  const bool method = how == "direct" || how == "stationary" || how == "moving";
  settings.method = method ? how : automatic.method;
  settings.fit = automatic.fit;
  return settings;
}

Result<void> estimate(Explorer& explorer, const Call& call) {
  if (explorer.loaded() == nullptr) return not_now("There is no recording to estimate from.");
  if (!call.values.empty()) explorer.change(searching(explorer.settings(), call.text(0)));
  explorer.estimating.start(explorer.recording.loaded(),
                            estimate_asked_for(explorer.settings(), explorer.options().assume));
  return {};
}

Result<void> take_found(Explorer& explorer, const Call&) {
  const Estimate* found = explorer.estimating.found();
  if (found == nullptr || !found->offset_s) return not_now("No offset has been found yet.");
  explorer.use_found_offset();
  return {};
}

}  // namespace

std::vector<Command> map_commands() {
  return {
      action(
          {"fit-view", "Fit the view", "Shows the whole map."}, {},
          [](Explorer& explorer, const Call&) { return explorer.fit_view(); }, Need::kRecording),
      action({"next-place", "Next place",
              "Moves the close-up to the next place of the list; \"back\": to the previous one."},
             {optional_of(choice_of("WAY", {"back"}))}, next_place, Need::kMaps),
      action({"look-at-place", "Look at the place", "Moves both cameras to the close-up's place."}, {},
             look_at_place, Need::kMaps),
      action(
          {"play", "Play or pause",
           "Plays the recording: the current scan is drawn in the maps. At the end it starts again."},
          {optional_of(switch_of("STATE"))},
          [](Explorer& explorer, const Call& call) {
            return explorer.play(call.values.empty() ? !explorer.is_playing() : call.text(0) == "on");
          },
          Need::kRecording),
      action({"estimate", "Estimate the offset",
              "Searches for the offset in the background, as the search is set, or as is named here."},
             {optional_of(choice_of(
                 "HOW", {"automatic", "over-time", "mount", "encoder", "direct", "stationary", "moving"}))},
             estimate, Need::kRecording),
      action({"cancel", "Cancel", "Stops everything that runs in the background."}, {},
             [](Explorer& explorer, const Call&) { explorer.cancel(); }),
      action(
          {"solve", "Solve the maps", "Resumes what was cancelled."}, {},
          [](Explorer& explorer, const Call&) { explorer.maps.solved.retry(); }, Need::kRecording),
      action({"take-found", "Use the found offset", "Sets map B to the offset that was found."}, {},
             take_found, Need::kEstimate),
      action({"undo", "Undo", "Reverts the last change of a setting."}, {},
             [](Explorer& explorer, const Call&) { explorer.undo(); }),
      action({"redo", "Redo", "Repeats the change that was undone."}, {},
             [](Explorer& explorer, const Call&) { explorer.redo(); }),
  };
}

}  // namespace sweepscope::ui
