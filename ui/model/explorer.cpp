#include "ui/model/explorer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/offset/estimator.hpp"
#include "ui/model/view_camera.hpp"

namespace sweepscope::ui {
namespace {

tl::unexpected<Error> not_now(std::string why) {
  return failure(ExitCode::kWrongUsage, std::move(why));
}

EstimateOptions estimate_options(const Settings& settings, std::optional<RigKind> assume) {
  EstimateOptions options;
  options.assume = assume;
  // Commands take no other values than these options do.
  if (settings.method != "automatic") (void)find_estimate_option("method")->set(options, settings.method);
  if (settings.fit != "automatic") (void)find_estimate_option("fit")->set(options, settings.fit);
  if (settings.search == Search::kRange) {
    options.ranges = {
        {settings.search_from_ms * 1e-3, settings.search_to_ms * 1e-3, settings.search_step_ms * 1e-3}};
  }
  return options;
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
  if (call.command->name == "offset-b") b_was_set_ = true;
  if (call.command->name.starts_with("camera")) view_fitted_ = true;
  change_settings(changed(settings_, call), gesture);
  return {};
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
         self.start_loading("Simulating " + c.text(0), [=, scene = c.text(0)](const Job& job) {
           return load_sample(scene, seconds, job);
         });
       })},
      {"close", always([](Explorer& self, const Call&) { self.close(); })},
      {"cancel", always([](Explorer& self, const Call&) { self.cancel(); })},
      {"solve", always([](Explorer& self, const Call&) { self.solve(); })},
      {"undo",
       always([](Explorer& self, const Call&) { self.settings_ = self.history_.undo(self.settings_); })},
      {"redo",
       always([](Explorer& self, const Call&) { self.settings_ = self.history_.redo(self.settings_); })},
      {"fit-view",
       [](Explorer& self, const Call&) -> Result<void> {
         if (!self.loaded_) return not_now("There is no recording to fit the view to.");
         self.fit_view();
         return {};
       }},
      {"estimate", [](Explorer& self, const Call&) { return self.start_estimate(); }},
      {"take-found", [](Explorer& self, const Call&) { return self.take_found(); }},
      {"save-session", [](Explorer& self, const Call& c) { return self.save_session(c.text(0)); }},
      {"export-cloud",
       [](Explorer& self, const Call& c) {
         return self.export_cloud(c.text(0) == "a" ? Side::kA : Side::kB, c.text(1));
       }},
      {"export-curve", [](Explorer& self, const Call& c) { return self.export_curve(c.text(0)); }},
      {"export-report", [](Explorer& self, const Call& c) { return self.export_report(c.text(0)); }}};
  if (auto checked = check_outputs_of(call); !checked) return checked;
  const auto action = kActions.find(call.command->name);
  if (action != kActions.end()) return action->second(*this, call);
  return at_window ? at_window(call) : not_now(fmt::format("\"{}\" wants a window", call.command->name));
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

Result<void> Explorer::start_estimate() {
  if (!loaded_) return not_now("There is no recording to estimate from.");
  background_.cancel("estimate");
  const EstimateOptions options = estimate_options(settings_, options_.assume);
  background_.start("estimate", "estimate", "Estimating the offset",
                    [this, options, loaded = loaded_](const Job& job) -> Background::Finish {
                      EstimateOptions along = options;
                      along.walk = loaded->walk->get();
                      auto found = std::make_shared<Result<Estimate>>(
                          sweepscope::estimate(loaded->prepared, along, {}, job));
                      if (*found && (*found)->walk) loaded->walk->keep((*found)->walk);
                      return [this, found] {
                        if (*found) return take(std::move(**found));
                        say(Message::Kind::kError, found->error().message);
                      };
                    });
  return {};
}

void Explorer::take(Estimate estimate) {
  estimate_ = std::move(estimate);
  if (!estimate_->offset_s || b_was_set_) return;
  Settings next = settings_;
  next.offset_b_ms = std::round(*estimate_->offset_s * 1e6) / 1e3;
  change_settings(next, {});
}

void Explorer::fit_view() {
  const SolvedMap* map = panes_[0].request ? panes_[0].request->placement.map.get() : provisional_.get();
  if (map == nullptr) return;
  const Box box{{map->x_m.from, map->y_m.from, map->z_m.from}, {map->x_m.to, map->y_m.to, map->z_m.to}};
  Settings next = settings_;
  for (ViewPoint* view : {&next.camera_a, &next.camera_b}) *view = fitted(*view, box, pane_aspect_);
  change_settings(next, {});
}

}  // namespace sweepscope::ui
