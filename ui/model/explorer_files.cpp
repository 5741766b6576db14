#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/io/atomic_file.hpp"
#include "core/io/cloud_file.hpp"
#include "core/io/output_check.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "core/results/estimate_json.hpp"
#include "core/results/found_rig.hpp"
#include "render/report/gather_report.hpp"
#include "ui/model/explorer.hpp"
#include "ui/model/task_plans.hpp"
#include "ui/state/session.hpp"

namespace sweepscope::ui {
namespace {

/// What a pane shows, in the order of time.
MapCloud cloud_of(const CloudRequest& request, const PlacedCloud& placed) {
  const Beams& beams = request.placement.loaded->beams;
  const auto sweep_of = assign_sweeps(beams.recording->scans, request.placement.loaded->prepared.motor.sweeps,
                                      request.placement.offset_s);
  std::vector<std::size_t> order(placed.beams.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return placed.beams[a] < placed.beams[b]; });
  MapCloud cloud;
  for (const std::size_t i : order) {
    const std::uint32_t beam = placed.beams[i];
    MapPoint point{};
    point.x = placed.points->xyz_m[i][0];
    point.y = placed.points->xyz_m[i][1];
    point.z = placed.points->xyz_m[i][2];
    point.intensity = static_cast<float>(intensity_of(request.placement, beam));
    point.sweep = static_cast<std::uint32_t>(sweep_of[beams.scan[beam]]);
    point.time_s = beams.time_s(beam);
    cloud.push_back(point);
  }
  return cloud;
}

/// A path in a session is that of the working folder, or lies beside the session.
std::string found_beside(const std::string& path, const std::filesystem::path& session,
                         const FileRoots& roots) {
  std::error_code ignored;
  if (path.empty() || (roots.can_read(path) && std::filesystem::exists(path, ignored))) return path;
  const std::filesystem::path beside = session.parent_path() / path;
  return std::filesystem::exists(beside, ignored) ? beside.string() : path;
}

/// The options that a report quotes: files without their folders.
std::string report_options(const Loaded& loaded, const std::optional<RigKind>& assume,
                           const Settings& settings) {
  std::string words = shell_options(loaded.choices, false);
  if (settings.solve_for != Settings().solve_for) {
    words += " --solve " + settings.solve_for;
    if (settings.prior() != Settings().prior()) words += " --prior " + settings.prior();
  }
  if (assume) words += *assume == RigKind::kMoving ? " --assume moving" : " --assume stationary";
  return words;
}

/// Whether the command writes the file of its first argument.
bool writes_one_file(const std::string& command) {
  return command == "save-session" || command == "export-curve" || command == "export-picture" ||
         command == "export-rig" || command == "use-rig";
}

/// How a session's recording is read: what the program was started with goes before what the session says.
ReadingChoices reading_of(const Session& session, const Call& open, const std::filesystem::path& path,
                          const ReadingChoices& given, const FileRoots& roots) {
  ReadingChoices choices = session.reading;
  choices.file = found_beside(open.text(0), path, roots);
  choices.poses = found_beside(open.text(1), path, roots);
  choices.rig_file = found_beside(choices.rig_file, path, roots);
  return merged(choices, given);
}

}  // namespace

/// A session that may be read can name a recording that may not, and a folder can hold links.
Result<void> Explorer::check_recording_roots(const ReadingChoices& choices) const {
  const FileRoots& roots = options_.roots;
  if (!roots.limited()) return {};
  std::vector<std::filesystem::path> files{choices.file};
  // What the program was started with may lie anywhere.
  const ReadingChoices& given = options_.reading;
  if (!choices.poses.empty() && choices.poses != given.poses) files.emplace_back(choices.poses);
  if (!choices.rig_file.empty() && choices.rig_file != given.rig_file) files.emplace_back(choices.rig_file);
  for (const auto& file : files)
    if (auto inside = roots.check_read(file); !inside) return inside;
  for (const auto& file : recording_files(choices.file))
    if (auto inside = roots.check_read(file); !inside) return inside;
  return {};
}

void Explorer::open(const std::string& path, const std::string& poses) {
  if (path.ends_with(".json")) {
    if (const auto done = open_json(path); !done) say(Message::Kind::kError, done.error().message);
    return;
  }
  ReadingChoices choices = options_.reading;
  choices.file = path;
  if (!poses.empty()) choices.poses = poses;
  load(choices);
}

void Explorer::load(const ReadingChoices& choices) {
  if (const auto inside = check_recording_roots(choices); !inside) {
    load_failure_ = inside.error();
    return say(Message::Kind::kError, inside.error().message);
  }
  for (const auto& file : recording_files(choices.file)) input_files_.push_back(file);
  for (const std::string& file : {choices.poses, choices.rig_file})
    if (!file.empty()) input_files_.emplace_back(file);
  start_loading(
      "Reading " + choices.file, steps_of_loading(),
      [choices](const Job& job) { return load_file(choices, job); }, choices);
}

Result<void> Explorer::open_json(const std::string& path) {
  input_files_.emplace_back(path);
  const auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  const auto json = nlohmann::json::parse(*text, nullptr, false);
  const bool is_estimate =
      json.is_object() && json.value("schema", nlohmann::json()) == "sweepscope.estimate/1";
  return is_estimate ? open_estimate(*text, path) : open_session(*text, path);
}

Result<void> Explorer::open_estimate(const std::string& text, const std::string& path) {
  if (!loaded_) return not_now(path + " is an estimate: open its recording first.");
  auto estimate = parse_estimate_json(text, path);
  if (!estimate) return tl::unexpected(estimate.error());
  background_.cancel("estimate");
  take(std::move(*estimate));
  return {};
}

Result<void> Explorer::open_session(const std::string& text, const std::string& path) {
  auto session = parse_session(text, path);
  if (!session) return tl::unexpected(session.error());
  if (session->source.empty()) {
    change_settings(session->settings, {});
    return {};
  }
  const auto call = parse_call(session->source);
  const bool opens = call && call->command->name == "open" && !call->text(0).ends_with(".json");
  if (!opens && !(call && call->command->name == "sample"))
    return unreadable(fmt::format("{}: source: \"{}\" does not open a recording", path, session->source));
  if (opens)
    load(reading_of(*session, *call, path, options_.reading, options_.roots));
  else if (auto done = perform(*call); !done)
    return done;
  session_settings_ = session->settings;
  session_estimate_ = session->estimate;
  session_file_ = path;
  return {};
}

void Explorer::start_loading(const std::string& title, std::vector<TaskStep> steps,
                             std::function<Result<LoadedPtr>(const Job&)> load,
                             const std::optional<ReadingChoices>& file) {
  background_.cancel("load");
  stop_choosing();
  session_settings_.reset();
  session_estimate_.reset();
  message_.reset();
  load_failure_.reset();
  const auto work = [this, load = std::move(load), file,
                     assume = options_.assume](const Job& job) -> Background::Finish {
    auto loaded = load(job);
    if (loaded) {
      job.report("the first map", 0);
      // At 0 ms whatever the settings are, so that the same lines always give the same picture.
      auto first_map = map_without_solving(**loaded, stands(**loaded, assume), 0);
      return [this, opened = *loaded, first_map] { take(opened, first_map); };
    }
    // Where there is something to choose from, the page says what is missing; else a message does.
    const auto survey = file && !job.cancelled() ? survey_file(*file, job) : unreadable("");
    const bool page = survey && !(survey->streams.lasers.empty() && survey->streams.joints.empty());
    if (!page) return [this, why = loaded.error()] { give_up_loading(why); };
    return [this, why = loaded.error(), choices = *file, found = *survey] {
      load_failure_ = why;
      choosing_ = Choosing{choices, found, why.message};
    };
  };
  background_.start("load", "load", title, work, std::move(steps));
}

void Explorer::give_up_loading(const Error& why) {
  session_settings_.reset();
  session_estimate_.reset();
  load_failure_ = why;
  say(Message::Kind::kError, why.message);
}

void Explorer::close() {
  background_.cancel_all("");
  loaded_ = nullptr;
  estimate_.reset();
  growing_.reset();
  so_far_.reset();
  message_.reset();
  solved_.clear();
  solved_order_.clear();
  unsolvable_.clear();
  cancelled_.clear();
  provisional_ = nullptr;
  span_maps_ = {nullptr, nullptr};
  panes_ = {};
  places_.clear();
  places_of_.reset();
  b_was_set_ = false;
  view_moved_ = false;
  playing_ = false;
}

void Explorer::take(LoadedPtr loaded, SolvedMapPtr first_map) {
  close();
  loaded_ = std::move(loaded);
  provisional_ = std::move(first_map);
  if (session_settings_) {
    change_settings(*session_settings_, {});
    b_was_set_ = view_moved_ = true;
    estimate_ = session_estimate_;
  } else {
    Settings next = settings_;  // what was asked of the recording before means nothing here
    next.asked_scan = next.asked_beam = -1;
    next.time_s = -1;
    next.box_from_m = next.box_to_m = {0, 0, 0};
    next.colour_from = next.colour_to = 0;
    next.profile_from_m = next.profile_to_m = {0, 0};
    next.measure_from_m = next.measure_to_m = {0, 0, 0};
    change_settings(next, {});
    fit_view();
  }
  session_settings_.reset();
  session_estimate_.reset();
}

std::string whole_path(const std::filesystem::path& path) {
  std::error_code failed;
  const auto whole = std::filesystem::absolute(path, failed);
  return failed ? path.string() : whole.lexically_normal().string();
}

std::string Explorer::replaced_by(std::string_view line) const {
  const auto call = parse_call(line);
  if (!call) return {};
  const std::string& name = call->command->name;
  std::filesystem::path path;
  if (writes_one_file(name)) path = call->text(0);
  if (name == "export-cloud") path = call->text(1);
  if (name == "export-report") path = std::filesystem::path(call->text(0)) / "report.html";
  std::error_code failed;
  if (path.empty() || !options_.roots.can_write(path) || !std::filesystem::exists(path, failed)) return {};
  if (name == "save-session" && std::filesystem::equivalent(path, session_file_, failed)) return {};
  return whole_path(path);
}

std::string Explorer::suggested_file(const std::string& command, const std::string& what) const {
  if (command == "open") return "";
  const std::string name =
      loaded_ ? std::filesystem::path(loaded_->recording.name).stem().string() : "sweepscope";
  if (command == "save-session") return name + ".session.json";
  if (command == "export-picture") return name + (what == "maps" ? "-maps.png" : ".png");
  if (command == "export-curve") return name + "-criteria.csv";
  if (command == "export-rig" || command == "use-rig") return name + "-rig.yaml";
  if (command == "export-report") return name + "-report";
  const double offset_ms = what == "a" ? settings_.offset_a_ms : settings_.offset_b_ms;
  return fmt::format("{}-{}ms.pcd", name, offset_ms);
}

std::string Explorer::session_json() const {
  return session_to_json(
      {loaded_ ? loaded_->source : "", loaded_ ? loaded_->choices : ReadingChoices(), settings_, estimate_});
}

Result<void> Explorer::check_outputs(std::vector<std::filesystem::path> outputs) const {
  return check_run_files({input_files_, std::move(outputs), {}});
}

Result<void> Explorer::check_outputs_of(const Call& call) const {
  const std::string& name = call.command->name;
  if (name == "export-report") {
    const std::filesystem::path folder = call.text(0);
    return check_run_files({input_files_, report_files(folder), folder});
  }
  std::error_code ignored;
  const bool saves = name == "save-session";
  if (saves && std::filesystem::equivalent(call.text(0), session_file_, ignored)) return {};
  if (writes_one_file(name)) return check_outputs({call.text(0)});
  if (name == "export-cloud") return check_outputs({call.text(1)});
  return {};
}

Result<void> Explorer::check_roots(const Call& call) const {
  const FileRoots& roots = options_.roots;
  const std::string& name = call.command->name;
  if (!roots.limited()) return {};
  if (name == "choose" || name == "choose-rig" || name == "choose-poses")
    return call.text(0).empty() ? Result<void>() : roots.check_read(call.text(0));
  if (name == "open") {
    const auto inside = roots.check_read(call.text(0));
    return inside && !call.text(1).empty() ? roots.check_read(call.text(1)) : inside;
  }
  if (name == "export-report") {
    for (const auto& file : report_files(call.text(0)))
      if (auto inside = roots.check_write(file); !inside) return inside;
    return roots.check_write(call.text(0));
  }
  if (writes_one_file(name)) return roots.check_write(call.text(0));
  if (name == "export-cloud") return roots.check_write(call.text(1));
  return {};
}

void Explorer::tell_written(const std::filesystem::path& file) const {
  if (wrote) wrote(file);
}

Result<void> Explorer::save_session(const std::string& path) {
  auto written = write_file(path, session_json());
  if (!written) return written;
  session_file_ = path;
  say(Message::Kind::kNote, fmt::format("The session is saved in {}.", whole_path(path)));
  tell_written(path);
  return written;
}

void Explorer::start_export(Export wanted) {
  background_.start(
      "export", kExport, wanted.title,
      [this, write = std::move(wanted.write), done = std::move(wanted.done),
       file = std::move(wanted.file)](const Job& job) -> Background::Finish {
        const auto written = write(job);
        if (written) {
          return [this, done, file] {
            say(Message::Kind::kNote, done);
            tell_written(file);
          };
        }
        return [this, why = written.error()] {
          export_failure_ = why;
          say(Message::Kind::kError, why.message);
        };
      },
      std::move(wanted.steps));
}

Result<void> Explorer::export_cloud(Side side, const std::string& path) {
  const Pane& shown = pane(side);
  if (!shown.full || !shown.request) return not_now("The map's points are not all placed yet.");
  start_export({.title = "Writing " + path,
                .done = fmt::format("{} points are saved in {}.", shown.full->beams.size(), whole_path(path)),
                .file = path,
                .write = [path, request = *shown.request, placed = shown.full](const Job&) {
                  return write_cloud(path, cloud_of(request, *placed));
                }});
  return {};
}

Result<void> Explorer::export_curve(const std::string& path) {
  if (!estimate_) return not_now("There is no estimate to export yet.");
  if (!path.ends_with(".csv") && !path.ends_with(".json"))
    return not_now(fmt::format("{}: the criteria are written as .csv or .json", path));
  auto written = path.ends_with(".csv") ? write_curve_csv(path, *estimate_)
                                        : write_estimate_json(path, *estimate_, Timing::kNull);
  if (!written) return written;
  say(Message::Kind::kNote, fmt::format("The criteria are saved in {}.", whole_path(path)));
  tell_written(path);
  return written;
}

Result<void> Explorer::export_rig(const std::string& path) {
  if (!estimate_ || !estimate_->rig)
    return not_now("No rig has been solved for: choose what to solve for, then estimate the offset.");
  auto written = write_file(path, found_rig_file(*estimate_->rig, estimate_->recording));
  if (!written) return written;
  say(Message::Kind::kNote, fmt::format("The rig file is saved in {}.", whole_path(path)));
  tell_written(path);
  return written;
}

Result<void> Explorer::use_rig(const std::string& path) {
  if (loaded_ && loaded_->choices.file.empty())
    return not_now("A sample has no rig file: simulate it into a file first.");
  if (auto written = export_rig(path); !written) return written;
  ReadingChoices choices = loaded_->choices;
  choices.rig_file = path;
  const Settings settings = settings_;
  auto estimate = estimate_;
  load(choices);
  session_settings_ = settings;
  session_estimate_ = std::move(estimate);
  return {};
}

Result<void> Explorer::export_report(const std::string& folder) {
  if (!loaded_) return not_now("There is no recording to report on.");
  const std::string command =
      report_command(loaded_->recording.name, report_options(*loaded_, options_.assume, settings_));
  ReportOptions wanted{.assume = options_.assume};
  wanted.solve = wanted_estimate().solve;
  const std::filesystem::path page = std::filesystem::path(folder) / "report.html";
  start_export({.title = "Writing a report",
                .done = fmt::format("The report is saved in {}.", whole_path(page)),
                .file = page,
                .write = [loaded = loaded_, wanted, folder, command](const Job& job) -> Result<void> {
                  auto content = gather_report(loaded->prepared, wanted, nullptr, job);
                  if (!content) return tl::unexpected(content.error());
                  content->command = command;
                  job.report("drawing", 0);
                  return write_report(*content, folder);
                },
                .steps = steps_of_reporting()});
  return {};
}

}  // namespace sweepscope::ui
