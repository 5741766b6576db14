#include "ui/model/explorer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/io/atomic_file.hpp"
#include "core/io/cloud_file.hpp"
#include "core/io/estimate_json.hpp"
#include "ui/state/session.hpp"

namespace sweepscope::ui {
namespace {

tl::unexpected<Error> not_now(std::string why) {
  return failure(ExitCode::kWrongUsage, std::move(why));
}

EstimateOptions estimate_options(const Settings& settings, std::optional<Method> assume) {
  EstimateOptions options;
  options.assume = assume;
  if (settings.method != SearchMethod::kAutomatic)
    options.method = settings.method == SearchMethod::kMoving ? Method::kMoving : Method::kStationary;
  if (settings.fit != SearchFit::kAutomatic)
    options.fit = settings.fit == SearchFit::kNone ? Fit::kNone : Fit::kParabola;
  if (settings.search == Search::kRange) {
    options.ranges = {
        {settings.search_from_ms * 1e-3, settings.search_to_ms * 1e-3, settings.search_step_ms * 1e-3}};
  }
  return options;
}

bool ends_with_any(const std::string& path, std::initializer_list<std::string_view> endings) {
  return std::any_of(endings.begin(), endings.end(),
                     [&](std::string_view ending) { return path.ends_with(ending); });
}

}  // namespace

Explorer::Explorer(Options options) : options_(std::move(options)) {}

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
  history_.record(settings_, gesture);
  settings_ = std::move(next);
}

Result<void> Explorer::act(const Call& call) {
  const std::string& name = call.command->name;
  if (name == "open") return open(call.text(0));
  if (name == "sample") {
    const std::string scene = call.text(0);
    const double seconds = call.values.size() > 1 ? call.number(1) : 0;
    return start_loading("Simulating " + scene,
                         [=](const Job& job) { return load_sample(scene, seconds, job); });
  }
  if (name == "close") {
    close();
    return {};
  }
  if (name == "fit-view") {
    if (!loaded_) return not_now("There is no recording to fit the view to.");
    fit_view();
    return {};
  }
  if (name == "estimate") return start_estimate();
  if (name == "cancel") {
    background_.cancel_all("");
    for (const auto& key : {offset_s(Side::kA), offset_s(Side::kB)})
      if (loaded_ && !standing() && !solved_at(key))
        unsolvable_[static_cast<std::int64_t>(std::llround(key * 1e9))] =
            "Cancelled: move the offset, or press Estimate.";
    return {};
  }
  if (name == "take-found") {
    if (!estimate_ || !estimate_->offset_s) return not_now("No offset has been found yet.");
    Settings next = settings_;
    next.offset_b_ms = std::round(*estimate_->offset_s * 1e6) / 1e3;
    change_settings(next, {});
    return {};
  }
  if (name == "undo" || name == "redo") {
    settings_ = name == "undo" ? history_.undo(settings_) : history_.redo(settings_);
    return {};
  }
  if (name == "save-session") return save_session(call.text(0));
  if (name == "export-cloud") return export_cloud(call.text(0), call.text(1));
  if (name == "export-curve") return export_curve(call.text(0));
  return at_window ? at_window(call) : not_now(fmt::format("\"{}\" wants a window", name));
}

Result<void> Explorer::open(const std::string& path) {
  if (!path.ends_with(".json")) {
    const ReadOptions reading = options_.reading;
    return start_loading("Reading " + path, [=](const Job& job) { return load_file(path, reading, job); });
  }
  auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  auto session = parse_session(*text, path);
  if (!session) return tl::unexpected(session.error());
  session_settings_ = session->settings;
  session_estimate_ = session->estimate;
  if (session->source.empty()) {
    change_settings(*session_settings_, {});
    session_settings_.reset();
    return {};
  }
  return perform(session->source);
}

Result<void> Explorer::start_loading(const std::string& title,
                                     std::function<Result<LoadedPtr>(const Job&)> load) {
  background_.cancel("load");
  message_.reset();
  background_.start("load", "load", title, [this, load](const Job& job) -> Background::Finish {
    auto loaded = std::make_shared<Result<LoadedPtr>>(load(job));
    return [this, loaded] {
      if (*loaded) return take(**loaded);
      session_settings_.reset();
      session_estimate_.reset();
      say(Message::Kind::kError, loaded->error().message);
    };
  });
  return {};
}

void Explorer::close() {
  background_.cancel_all("");
  loaded_ = nullptr;
  estimate_.reset();
  message_.reset();
  solved_.clear();
  solved_order_.clear();
  unsolvable_.clear();
  provisional_ = nullptr;
  features_ = nullptr;
  span_maps_ = {nullptr, nullptr};
  panes_ = {};
  b_was_set_ = false;
  view_fitted_ = false;
}

void Explorer::take(LoadedPtr loaded) {
  close();
  loaded_ = std::move(loaded);
  provisional_ = provisional_map(*loaded_, offset_s(Side::kA));
  if (session_settings_) {
    change_settings(*session_settings_, {});
    b_was_set_ = view_fitted_ = true;
    estimate_ = session_estimate_;
  } else {
    fit_view();
  }
  session_settings_.reset();
  session_estimate_.reset();
}

Result<void> Explorer::start_estimate() {
  if (!loaded_) return not_now("There is no recording to estimate from.");
  background_.cancel("estimate");
  const EstimateOptions options = estimate_options(settings_, options_.assume);
  background_.start("estimate", "estimate", "Estimating the offset",
                    [this, options, loaded = loaded_](const Job& job) -> Background::Finish {
                      auto found = std::make_shared<Result<Estimate>>(
                          sweepscope::estimate(loaded->recording, options, job));
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

std::string Explorer::session_json() const {
  return session_to_json({loaded_ ? loaded_->source : "", settings_, estimate_});
}

Result<void> Explorer::save_session(const std::string& path) {
  auto written = write_file(path, session_json());
  if (written) say(Message::Kind::kNote, fmt::format("The session is saved in {}.", path));
  return written;
}

Result<void> Explorer::export_cloud(const std::string& side, const std::string& path) {
  const Pane& shown = pane(side == "a" ? Side::kA : Side::kB);
  if (!shown.full || !shown.request) return not_now("The map's points are not all placed yet.");
  const Beams& beams = loaded_->beams;
  MapCloud cloud;
  std::vector<std::size_t> order(shown.full->beams.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return shown.full->beams[a] < shown.full->beams[b]; });
  for (const std::size_t i : order) {
    const std::uint32_t beam = shown.full->beams[i];
    MapPoint point{};
    point.x = shown.full->points->xyz_m[i][0];
    point.y = shown.full->points->xyz_m[i][1];
    point.z = shown.full->points->xyz_m[i][2];
    point.intensity = static_cast<float>(intensity_of(shown.request->placement, beam));
    point.sweep = shown.request->placement.map->path.sweep_of_scan[beams.scan[beam]];
    point.time_s = beams.time_s(beam);
    cloud.push_back(point);
  }
  auto written = write_cloud(path, cloud);
  if (written) say(Message::Kind::kNote, fmt::format("{} points are saved in {}.", cloud.size(), path));
  return written;
}

Result<void> Explorer::export_curve(const std::string& path) {
  if (!estimate_) return not_now("There is no estimate to export yet.");
  if (!ends_with_any(path, {".csv", ".json"}))
    return not_now(fmt::format("{}: the criteria are written as .csv or .json", path));
  auto written = path.ends_with(".csv") ? write_curve_csv(path, *estimate_)
                                        : write_estimate_json(path, *estimate_, Timing::kNull);
  if (written) say(Message::Kind::kNote, fmt::format("The criteria are saved in {}.", path));
  return written;
}

void Explorer::fit_view() {
  const SolvedMap* map = panes_[0].request ? panes_[0].request->placement.map.get() : provisional_.get();
  if (map == nullptr) return;
  constexpr double kRoom = 1.12;  // about nearly all points
  const double width_m = map->x_m.to - map->x_m.from, depth_m = map->y_m.to - map->y_m.from;
  Settings next = settings_;
  for (ViewPoint* view : {&next.camera_a, &next.camera_b}) {
    view->centre_m = {(map->x_m.from + map->x_m.to) / 2, (map->y_m.from + map->y_m.to) / 2,
                      (map->z_m.from + map->z_m.to) / 2};
    view->height_m = std::max({kRoom * width_m / pane_aspect_, kRoom * depth_m, 1.0});
    for (double* metre : {&view->centre_m.x(), &view->centre_m.y(), &view->centre_m.z(), &view->height_m})
      *metre = std::round(*metre * 100) / 100;
  }
  change_settings(next, {});
}

}  // namespace sweepscope::ui
