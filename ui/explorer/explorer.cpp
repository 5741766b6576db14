#include "ui/explorer/explorer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/map/consistency/map_consistency.hpp"
#include "core/offset/prepared/search_window.hpp"

namespace sweepscope::ui {
namespace {

/// The fields that mean something for one recording alone.
constexpr std::array kOfRecording{"offset-a", "offset-b", "time-window", "colour-range",
                                  "box",      "time",     "profile",     "measure",
                                  "pick",     "scan",     "place",       "chart-range"};

/// A range that ends before it begins, or is nothing, shows nothing.
Result<void> check_range(const Call& call) {
  struct Range {
    std::string_view name, what, none;  // none: what equal ends mean; empty: they show nothing
  };
  constexpr std::array kRanges{
      Range{"colour-range", "The colour range", "Equal values: found from the maps."},
      Range{"slab", "The slab", ""}, Range{"time-window", "The time range", "Both 0: all."},
      Range{"chart-range", "The range of offsets", "Both 0: all."}};
  const auto range = std::ranges::find(kRanges, call.command->name, &Range::name);
  if (range == kRanges.end()) return {};
  const double from = call.number(0), to = call.number(1);
  if (to > from || (to == from && !range->none.empty())) return {};
  return not_now(fmt::format("{} must end above its beginning, {}. {}", range->what, from, range->none));
}

}  // namespace

Explorer::Explorer(Options options)
    : options_(std::move(options)),
      files(options_.roots, options_.reading, options_.input_files),
      recording(background, options_.assume, [this](const Opened& opened) { take(opened); }),
      page(background, messages),
      estimating(background, messages,
                 [this](bool computed) {
                   if (computed) answers.keep(*loaded(), *estimating.found());
                   if (!set_since_opening_.contains("offset-b")) use_found_offset();
                   if (computed) use_answered_part();
                 }),
      rig(background, messages, [this](Estimate found) { estimating.set(std::move(found)); }),
      maps(background),
      places(background, [this](std::vector<PlacePtr> found) { take(std::move(found)); }),
      exports(background, messages) {}

Result<void> Explorer::perform(const Call& call, const std::string& gesture) {
  if (call.command == nullptr) return not_now("There is no command of that name.");
  if (auto allowed = files.check(call); !allowed) return allowed;
  if (const auto* action = std::get_if<Action>(&call.command->handler)) return action->run(*this, call);
  if (const auto* action = std::get_if<WindowAction>(&call.command->handler))
    return window != nullptr ? action->run(*this, *window, call)
                             : not_now(fmt::format("\"{}\" needs a window", call.command->name));
  return set(call, gesture);
}

Result<void> Explorer::set(const Call& call, const std::string& gesture) {
  if (auto allowed = check_range(call); !allowed) return allowed;
  Settings next = changed(settings_, call);
  if (auto allowed = check_offsets(next); !allowed) return allowed;
  for (const char* name : kOfRecording) {
    const Command& field = *find_in(setting_commands(), name);
    if (call.command == &field || field.get(next) != field.get(settings_)) set_since_opening_.insert(name);
  }
  if (call.command->name == "colouring") colouring_was_chosen_ = true;
  const bool turned = next.camera_a.turn_deg != settings_.camera_a.turn_deg ||
                      next.camera_a.elevation_deg != settings_.camera_a.elevation_deg;
  if (turned || next.heights != settings_.heights) view_was_chosen_ = true;
  if (call.command->moves_view) view.moved_by_person = true;
  if (next.offset_a_ms != settings_.offset_a_ms) changed_side_ = Side::kA;
  if (next.offset_b_ms != settings_.offset_b_ms) changed_side_ = Side::kB;
  const bool clipped = next.box_from_m != settings_.box_from_m || next.box_to_m != settings_.box_to_m;
  change(std::move(next), gesture);
  if (clipped || turned) refit_view();
  return {};
}

void Explorer::change(Settings next, const std::string& gesture) {
  if (next.linked && next.camera_a != settings_.camera_a)
    next.camera_b = next.camera_a;
  else if (next.linked)
    next.camera_a = next.camera_b;
  if (next == settings_) return;
  if (next.offset_a_ms != settings_.offset_a_ms || next.offset_b_ms != settings_.offset_b_ms)
    maps.solved.forget_cancelled();
  history_.record(settings_, gesture);
  settings_ = std::move(next);
}

std::pair<double, double> Explorer::offset_window_ms() const {
  const Parameter& any = find_in(setting_commands(), "offset-a")->parameters[0];
  const double reach_ms = loaded() ? 1e3 * search_scale(loaded()->prepared.motor).max_half_width_s : 0;
  if (!(reach_ms > 0)) return {any.least, any.greatest};
  double from_ms = -reach_ms, to_ms = reach_ms;
  const auto reach_about = [&](double first_ms, double last_ms) {
    from_ms = std::min(from_ms, first_ms - reach_ms);
    to_ms = std::max(to_ms, last_ms + reach_ms);
  };
  if (settings_.search == Search::kRange) reach_about(settings_.search_from_ms, settings_.search_to_ms);
  const Estimate* found = estimating.found();
  if (found && found->offset_s) reach_about(*found->offset_s * 1e3, *found->offset_s * 1e3);
  return {std::max(from_ms, any.least), std::min(to_ms, any.greatest)};
}

Result<void> Explorer::check_offsets(const Settings& next) const {
  const auto [from_ms, to_ms] = offset_window_ms();
  for (const auto& [now_ms, before_ms] : {std::pair{next.offset_a_ms, settings_.offset_a_ms},
                                          std::pair{next.offset_b_ms, settings_.offset_b_ms}}) {
    if (now_ms == before_ms || (now_ms >= from_ms && now_ms <= to_ms)) continue;
    return not_now(fmt::format(
        "An offset of {} ms is outside the search window of this recording, {:.0f} to {:.0f} ms: "
        "an offset farther away is not distinguished from its mirror image by this motor's motion. To search "
        "elsewhere, set the candidates of the search.",
        now_ms, std::ceil(from_ms), std::floor(to_ms)));
  }
  return {};
}

/// By value: the page's choices end with the page.
void Explorer::load(ReadingChoices choices,
                    std::optional<Restored> restored) {  // NOLINT(performance-unnecessary-value-param)
  if (const auto inside = files.check_reading(choices); !inside) {
    recording.fail(inside.error());
    return messages.error(inside.error());
  }
  files.add_inputs(choices);
  if (loaded() != nullptr && !(restored && restored->of_part)) set_since_opening_.clear();
  page.close();
  messages.dismiss();
  recording.read(choices, std::move(restored));
}

void Explorer::load_sample(const std::string& scene, double seconds, std::optional<Restored> restored) {
  if (loaded() != nullptr) set_since_opening_.clear();
  page.close();
  messages.dismiss();
  recording.simulate(scene, seconds, std::move(restored));
}

void Explorer::take(const Opened& opened) {
  // Where there is something to choose from, the page says what is missing; else a message does.
  if (opened.survey) {
    ReadingChoices none = options_.reading;
    none.file = opened.choices.file;
    const ReadingChoices* left = opened.choices == none ? page.left(none.file) : nullptr;
    if (left != nullptr) return page.show(ReadingChoices(*left));
    return page.show(opened.choices, *opened.survey, opened.loaded.error().message);
  }
  if (!opened.loaded) return messages.error(opened.loaded.error());
  end_recording();
  page.forget();
  recording.keep(*opened.loaded);
  rig.opened(loaded());
  maps.open(*opened.loaded, opened.first_map, options_.assume);
  const auto& restored = opened.restored;
  if (restored && restored->of_part) answers.keep(*loaded(), *restored->estimate);
  if (restored && !restored->of_part)
    restore(*restored);
  else
    begin_anew();
  answer();
}

void Explorer::restore(const Restored& restored) {
  change(restored.settings);
  set_since_opening_.insert("offset-b");
  view.moved_by_person = true;
  estimating.restore(restored.estimate);
}

/// What was asked of the recording before means nothing here; what was set since this one was asked for
/// stays.
void Explorer::begin_anew() {
  Settings next = settings_;
  for (const char* name : kOfRecording) {
    const Command& field = *find_in(setting_commands(), name);
    if (!set_since_opening_.contains(name)) next = changed(next, {&field, field.get(Settings())});
  }
  if (!colouring_was_chosen_) next.colouring = Settings().colouring;
  settings_ = std::move(next);
  use_first_view();
  settings_ = with_fitted_view();
  history_ = {};  // its settings are those of the recording before
  first_colouring_ = !colouring_was_chosen_;
}

/// The estimate that opening begins: by default, whatever the search is set to.
void Explorer::answer() {
  if (estimating.found() != nullptr || !options_.estimates_on_opening || !settings_.estimate_on_opening) {
    first_colouring_ = false;
    return;
  }
  answering_ = true;
  auto known = answers.of(*loaded());
  if (!known) return estimating.start(recording.loaded(), estimate_asked_for(Settings(), options_.assume));
  if (known->walk) loaded()->walk->keep(known->walk);
  estimating.set(std::move(*known));
}

void Explorer::close() {
  end_recording();
  rig.opened(nullptr);
  set_since_opening_.clear();
  begin_anew();
}

void Explorer::end_recording() {
  background.cancel_all("");
  recording.close();
  estimating.restore({});
  messages.dismiss();
  maps.close();
  places.close();
  walls_.reset();
  first_colouring_ = answering_ = false;
  view.moved_by_person = false;
  playing_ = false;
}

void Explorer::cancel() {
  background.cancel_all("");
  maps.cancel(settings_);
}

std::optional<double> Explorer::found_offset_ms() const {
  const Estimate* found = estimating.found();
  if (found == nullptr || !found->offset_s) return std::nullopt;
  return std::round(*found->offset_s * 1e5) / 1e2;
}

void Explorer::use_found_offset() {
  const auto found_ms = found_offset_ms();
  if (!found_ms) return;
  Settings next = settings_;
  next.offset_b_ms = *found_ms;
  change(std::move(next));
}

Result<void> Explorer::fit_view() {
  if (loaded() == nullptr) return not_now("There is no recording to fit the view to.");
  view.moved_by_person = false;
  change(with_fitted_view());
  return {};
}

Settings Explorer::with_fitted_view() {
  const auto box = maps.extent_in_view(settings_.heights);
  return box ? view.fitted(settings_, *box, place() != nullptr) : settings_;
}

/// A room that was measured from one place is recognised from behind the scanner and without its ceiling, a
/// walk from above.
void Explorer::use_first_view() {
  if (view_was_chosen_ || !options_.estimates_on_opening || !settings_.estimate_on_opening) return;
  constexpr double kTurn_deg = -60, kElevation_deg = 32;
  const bool room = loaded() != nullptr && was_stationary(*loaded(), options_.assume);
  settings_.heights = room ? Heights::kBelowCeiling : Settings().heights;
  for (ViewPoint* camera : {&settings_.camera_a, &settings_.camera_b}) {
    camera->turn_deg = room ? kTurn_deg : Settings().camera_a.turn_deg;
    camera->elevation_deg = room ? kElevation_deg : Settings().camera_a.elevation_deg;
  }
}

/// The offset that opening found may be that of the part in which the rig was stationary: that part is then
/// what the maps show.
void Explorer::use_answered_part() {
  const auto& part = estimating.found()->stationary_part;
  if (!part || !answering_ || loaded()->choices.file.empty() || loaded()->choices.window) return;
  ReadingChoices choices = loaded()->choices;
  choices.window = TimeWindow{part->begin_s, part->end_s};
  load(choices, Restored{settings_, *estimating.found(), true});
}

void Explorer::refit_view() {
  if (loaded() != nullptr && !view.moved_by_person)
    settings_ = with_fitted_view();  // nothing that undo would take back
}

void Explorer::set_picture_shape(const PictureShape& shape) {
  if (view.reshape(shape)) refit_view();
}

void Explorer::update(double seconds_since_last) {
  messages.update(seconds_since_last);
  background.take_finished();
  estimating.update();
  if (loaded() == nullptr) return;
  update_walls();  // before the maps: what they were coloured by may change with it
  maps.update(settings_, seconds_since_last, estimating.is_running() || recording.is_opening());
  const bool first = maps.solved.take_first_solved(), any = maps.solved.take_solved();
  if (first || (any && answering_)) refit_view();  // its extent is known now
  update_places();
  answering_ = answering_ && !at_rest();
  update_playback(seconds_since_last);
}

/// Once both maps are there in full.
void Explorer::update_places() {
  if (settings_.close_up && maps.is_complete() && !maps.is_held())
    places.compare(pane(Side::kA).request->placement, pane(Side::kB).request->placement);
  maps.show_close_ups(place());
  if (std::exchange(fitted_beside_, place() != nullptr) != (place() != nullptr)) refit_view();
}

/// Whether the panes show map A as recorded and map B at the offset found, all of both.
bool Explorer::shows_answer() const {
  const auto found_ms = found_offset_ms();
  if (!found_ms || !maps.is_complete() || maps.is_held()) return false;
  return pane(Side::kA).request->placement.offset_s == 0 &&
         pane(Side::kB).request->placement.offset_s == *found_ms * 1e-3;
}

void Explorer::update_walls() {
  if (!shows_answer()) return;
  const double offset_s = *estimating.found()->offset_s;
  if (walls_ && walls_->offset_s == offset_s) return;
  const Placement &a = pane(Side::kA).request->placement, &b = pane(Side::kB).request->placement;
  maps.blur.measure(a, b);
  const SlowValues *before = maps.blur.at(a), *after = maps.blur.at(b);
  if (before == nullptr || after == nullptr || !before->thickness || !after->thickness) return;
  const auto is_broken = [](const Pane& shown) {
    return shown.lost || (shown.consistency && shown.consistency->warned());
  };
  walls_ = {offset_s, *before->thickness, *after->thickness,
            is_broken(pane(Side::kA)) || is_broken(pane(Side::kB))};
  constexpr double kDiffer = 1.2;
  const bool differ = before->thickness->median_m > kDiffer * after->thickness->median_m;
  if (!std::exchange(first_colouring_, false) || !differ || colouring_was_chosen_) return;
  Settings next = settings_;
  next.colouring = ColourBy::kBlur;
  change(std::move(next));
}

std::string Explorer::walls_in_words() const {
  const Estimate* found = estimating.found();
  if (!walls_ || found == nullptr || found->offset_s != walls_->offset_s) return "";
  return fmt::format("Walls are {:.0f} mm thick as recorded, {:.0f} mm at {:.2f} ms{}.",
                     walls_->before.median_m * 1e3, walls_->after.median_m * 1e3, walls_->offset_s * 1e3,
                     walls_->broken ? "; but a map's path is not right, see Notes" : "");
}

/// The best place is shown, or, where a person went to another one, the one nearest to it.
void Explorer::take(std::vector<PlacePtr> found) {
  const PlacePtr before = place();
  places.keep(std::move(found));
  if (before && settings_.place > 1 && !places.all().empty()) settings_.place = places.nearest_to(*before);
}

Result<void> Explorer::play(bool on) {
  if (loaded() == nullptr) return not_now("There is no recording to play.");
  playing_ = on;
  const bool from_start = settings_.time_s < 0 || settings_.time_s >= loaded()->duration_s();
  if (playing_ && from_start) settings_.time_s = 0;
  return {};
}

void Explorer::update_playback(double seconds_since_last) {
  if (settings_.time_s < 0) playing_ = false;
  if (!playing_) return;
  settings_.time_s += seconds_since_last * settings_.play_speed;  // nothing that undo would take back
  if (settings_.time_s < loaded()->duration_s()) return;
  settings_.time_s = loaded()->duration_s();
  playing_ = false;
}

}  // namespace sweepscope::ui
