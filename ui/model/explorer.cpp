#include "ui/model/explorer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/offset/estimator.hpp"
#include "core/offset/prepared/search_window.hpp"
#include "ui/model/picking.hpp"
#include "ui/model/task_plans.hpp"
#include "ui/model/view_camera.hpp"

namespace sweepscope::ui {
namespace {

/// Turning the view to one of its directions leaves its middle and its size to the program.
bool moves_view(const std::string& command) {
  return command.starts_with("camera") || command == "zoom" || command == "pan" || command == "turn";
}

}  // namespace

Explorer::Explorer(Options options) : options_(std::move(options)), input_files_(options_.input_files) {}

Result<void> Explorer::perform(std::string_view line, const std::string& gesture) {
  const auto call = parse_call(line);
  if (!call) return tl::unexpected(call.error());
  return perform(*call, gesture);
}

Result<void> Explorer::perform(const Call& call, const std::string& gesture) {
  if (call.command->is_action()) return act(call);
  Settings next = changed(settings_, call);
  if (auto allowed = check_offsets(next); !allowed) return allowed;
  if (call.command->name == "offset-b") b_was_set_ = true;
  if (moves_view(call.command->name)) view_moved_ = true;
  if (next.offset_a_ms != settings_.offset_a_ms) changed_side_ = Side::kA;
  if (next.offset_b_ms != settings_.offset_b_ms) changed_side_ = Side::kB;
  const bool clipped = next.box_from_m != settings_.box_from_m || next.box_to_m != settings_.box_to_m;
  change_settings(std::move(next), gesture);
  if (clipped) refit_view();
  return {};
}

std::pair<double, double> Explorer::offset_window_ms() const {
  const Parameter& any = find_command("offset-a")->parameters[0];
  const double reach_ms = loaded_ ? 1e3 * search_scale(loaded_->prepared.motor).max_half_width_s : 0;
  if (!(reach_ms > 0)) return {any.least, any.greatest};
  double from_ms = -reach_ms, to_ms = reach_ms;
  const auto reach_about = [&](double first_ms, double last_ms) {
    from_ms = std::min(from_ms, first_ms - reach_ms);
    to_ms = std::max(to_ms, last_ms + reach_ms);
  };
  if (settings_.search == Search::kRange) reach_about(settings_.search_from_ms, settings_.search_to_ms);
  if (estimate_ && estimate_->offset_s) reach_about(*estimate_->offset_s * 1e3, *estimate_->offset_s * 1e3);
  return {std::max(from_ms, any.least), std::min(to_ms, any.greatest)};
}

Result<void> Explorer::check_offsets(const Settings& next) const {
  const std::pair<double, double> window_ms = offset_window_ms();
  for (const auto& [now_ms, before_ms] : {std::pair{next.offset_a_ms, settings_.offset_a_ms},
                                          std::pair{next.offset_b_ms, settings_.offset_b_ms}}) {
    if (now_ms == before_ms || (now_ms >= window_ms.first && now_ms <= window_ms.second)) continue;
    return failure(ExitCode::kWrongUsage,
                   fmt::format("An offset of {} ms is outside the search window of this recording, {:.0f} to "
                               "{:.0f} ms: beyond a quarter of the motor's period a mirror image of the map "
                               "fits as well. To search elsewhere, set the candidates of the search.",
                               now_ms, std::ceil(window_ms.first), std::floor(window_ms.second)));
  }
  return {};
}

Explorer::Copied Explorer::what_to_copy() const {
  const auto& shown = pane(Side::kB).request;
  const auto beam = loaded_ && shown ? beam_asked(settings_, loaded_->beams) : std::nullopt;
  if (beam) {
    const auto places_m =
        place_beams(loaded_->beams, shown->placement.map->path, shown->placement.offset_s, std::array{*beam});
    return {fmt::format("{:.3f} {:.3f} {:.3f}", places_m[0][0], places_m[0][1], places_m[0][2]),
            "the place of the inspected point in map B, in metres"};
  }
  const bool a = changed_side_ == Side::kA;
  return {to_word(Value(a ? settings_.offset_a_ms : settings_.offset_b_ms)),
          fmt::format("the offset of map {}, in ms", a ? "A" : "B")};
}

void Explorer::change_settings(Settings next, const std::string& gesture) {
  if (next.linked && next.camera_a != settings_.camera_a)
    next.camera_b = next.camera_a;
  else if (next.linked)
    next.camera_a = next.camera_b;
  if (next == settings_) return;
  if (next.offset_a_ms != settings_.offset_a_ms || next.offset_b_ms != settings_.offset_b_ms)
    cancelled_.clear();
  history_.record(settings_, gesture);
  settings_ = std::move(next);
}

Result<void> Explorer::act(const Call& call) {
  using Action = std::function<Result<void>(Explorer&, const Call&)>;
  const auto always = [](auto action) {
    return [action](Explorer& self, const Call& given) -> Result<void> {
      action(self, given);
      return {};
    };
  };
  static const std::map<std::string, Action> kActions{
      {"open", always([](Explorer& self, const Call& c) { self.open(c.text(0), c.text(1)); })},
      {"sample", always([](Explorer& self, const Call& c) {
         const double seconds = c.values.size() > 1 ? c.number(1) : 0;
         self.start_loading(
             "Simulating " + c.text(0), steps_of_simulating(),
             [=, scene = c.text(0)](const Job& job) { return load_sample(scene, seconds, job); });
       })},
      {"close", always([](Explorer& self, const Call&) { self.close(); })},
      {"choose", [](Explorer& self, const Call& c) { return self.start_choosing(c.text(0)); }},
      {"choose-laser", [](Explorer& self, const Call& c) { return self.choose(c); }},
      {"choose-motor", [](Explorer& self, const Call& c) { return self.choose(c); }},
      {"choose-stamps", [](Explorer& self, const Call& c) { return self.choose(c); }},
      {"choose-rig", [](Explorer& self, const Call& c) { return self.choose(c); }},
      {"choose-poses", [](Explorer& self, const Call& c) { return self.choose(c); }},
      {"choose-part", [](Explorer& self, const Call& c) { return self.choose(c); }},
      {"open-chosen", [](Explorer& self, const Call&) { return self.open_chosen(); }},
      {"cancel", always([](Explorer& self, const Call&) { self.cancel(); })},
      {"solve", always([](Explorer& self, const Call&) { self.solve(); })},
      {"undo",
       always([](Explorer& self, const Call&) { self.settings_ = self.history_.undo(self.settings_); })},
      {"redo",
       always([](Explorer& self, const Call&) { self.settings_ = self.history_.redo(self.settings_); })},
      {"fit-view",
       [](Explorer& self, const Call&) -> Result<void> {
         if (!self.loaded_) return not_now("There is no recording to fit the view to.");
         self.view_moved_ = false;
         self.fit_view();
         return {};
       }},
      {"play", [](Explorer& self, const Call& c) { return self.play(c); }},
      {"estimate", [](Explorer& self, const Call&) { return self.start_estimate(); }},
      {"take-found", [](Explorer& self, const Call&) { return self.take_found(); }},
      {"next-place", [](Explorer& self, const Call& c) { return self.next_place(c.text(0) == "back"); }},
      {"look-at-place", [](Explorer& self, const Call&) { return self.look_at_place(); }},
      {"save-session", [](Explorer& self, const Call& c) { return self.save_session(c.text(0)); }},
      {"export-cloud",
       [](Explorer& self, const Call& c) {
         return self.export_cloud(c.text(0) == "a" ? Side::kA : Side::kB, c.text(1));
       }},
      {"export-curve", [](Explorer& self, const Call& c) { return self.export_curve(c.text(0)); }},
      {"export-rig", [](Explorer& self, const Call& c) { return self.export_rig(c.text(0)); }},
      {"use-rig", [](Explorer& self, const Call& c) { return self.use_rig(c.text(0)); }},
      {"export-report", [](Explorer& self, const Call& c) { return self.export_report(c.text(0)); }}};
  if (auto inside = check_roots(call); !inside) return inside;
  if (auto checked = check_outputs_of(call); !checked) return checked;
  const auto action = kActions.find(call.command->name);
  if (action != kActions.end()) return action->second(*this, call);
  return at_window ? at_window(call) : not_now(fmt::format("\"{}\" needs a window", call.command->name));
}

void Explorer::cancel() {
  background_.cancel_all("");
  session_settings_.reset();
  session_estimate_.reset();
  if (!loaded_) return;
  for (const Side side : kBothSides) {
    if (!solved_at(offset_s(side))) cancelled_.insert(std::llround(offset_s(side) * 1e9));
  }
}

void Explorer::solve() {
  cancelled_.clear();
  unsolvable_.clear();
}

Result<void> Explorer::take_found() {
  if (!estimate_ || !estimate_->offset_s) return not_now("No offset has been found yet.");
  Settings next = settings_;
  next.offset_b_ms = std::round(*estimate_->offset_s * 1e6) / 1e3;
  change_settings(next, {});
  return {};
}

EstimateOptions Explorer::wanted_estimate() const {
  const Settings& settings = settings_;
  EstimateOptions options;
  options.assume = options_.assume;
  // Commands take no other values than these options do.
  (void)find_estimate_option("solve")->set(options, settings.solve_for);
  (void)find_estimate_option("prior")->set(options, settings.prior());
  if (settings.search == Search::kOverTime)
    (void)find_estimate_option("over-time")
        ->set(options, settings.window_s < 1 ? std::string() : to_word(Value(settings.window_s)));
  if (settings.method != "automatic") (void)find_estimate_option("method")->set(options, settings.method);
  if (settings.fit != "automatic") (void)find_estimate_option("fit")->set(options, settings.fit);
  if (settings.search == Search::kRange) {
    options.ranges = {
        {settings.search_from_ms * 1e-3, settings.search_to_ms * 1e-3, settings.search_step_ms * 1e-3}};
  }
  return options;
}

Result<void> Explorer::start_estimate() {
  if (!loaded_) return not_now("There is no recording to estimate from.");
  background_.cancel("estimate");
  const EstimateOptions options = wanted_estimate();
  growing_ = std::make_shared<GrowingCurve>();
  background_.start(
      "estimate", "estimate", "Estimating the offset",
      [this, options, loaded = loaded_, growing = growing_](const Job& job) -> Background::Finish {
        EstimateOptions along = options;
        along.walk = loaded->walk->get();
        const KeptCandidates candidates{
            nullptr, {}, [growing](const CurvePoint& point) { growing->add(point); }};
        auto found = std::make_shared<Result<Estimate>>(
            sweepscope::estimate(loaded->prepared, along, candidates, job));
        if (*found && (*found)->walk) loaded->walk->keep((*found)->walk);
        return [this, found] {
          if (*found) return take(std::move(**found));
          say(Message::Kind::kError, found->error().message);
        };
      },
      steps_of_estimating());
  return {};
}

void Explorer::update_growing_curve() {
  if (!background_.has("estimate")) growing_.reset();
  if (!growing_) so_far_.reset();
  if (!growing_ || growing_->size() < 2) return;
  if (!so_far_ || so_far_->curve.size() != growing_->size()) so_far_ = growing_->so_far();
}

const Estimate* Explorer::charted() const {
  return so_far_ ? &*so_far_ : estimate();
}

void Explorer::take(Estimate estimate) {
  estimate_ = std::move(estimate);
  if (!estimate_->offset_s || b_was_set_) return;
  Settings next = settings_;
  next.offset_b_ms = std::round(*estimate_->offset_s * 1e6) / 1e3;
  change_settings(next, {});
}

Settings Explorer::with_fitted_view() const {
  Settings next = settings_;
  const SolvedMap* map = panes_[0].request ? panes_[0].request->placement.map.get() : provisional_.get();
  if (map == nullptr) return next;
  Box box{{map->x_m.from, map->y_m.from, map->z_m.from}, {map->x_m.to, map->y_m.to, map->z_m.to}};
  if (next.has_box()) box = {next.box_from_m, next.box_to_m};
  const PictureShape shape = place() ? picture_shape_ : PictureShape{picture_shape_.aspect, 0, 0};
  for (ViewPoint* view : {&next.camera_a, &next.camera_b}) *view = fitted(*view, box, shape);
  return next;
}

void Explorer::fit_view() {
  change_settings(with_fitted_view(), {});
}

void Explorer::refit_view() {
  if (loaded_ && !view_moved_) settings_ = with_fitted_view();  // nothing that undo would take back
}

void Explorer::set_picture_shape(const PictureShape& shape) {
  if (shape == picture_shape_) return;
  picture_shape_ = shape;
  refit_view();
}

}  // namespace sweepscope::ui
