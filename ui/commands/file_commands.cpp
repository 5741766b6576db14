#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/io/atomic_file.hpp"
#include "core/io/cloud_file.hpp"
#include "core/results/estimate_json.hpp"
#include "core/results/found_rig.hpp"
#include "render/report/gather_report.hpp"
#include "ui/commands/commands.hpp"
#include "ui/explorer/explorer.hpp"
#include "ui/explorer/observables.hpp"
#include "ui/jobs/task_plans.hpp"
#include "ui/state/session.hpp"

namespace sweepscope::ui {
namespace {

constexpr std::array<std::string_view, 1> kSessionTypes{"json"};
constexpr std::array<std::string_view, 2> kRigTypes{"yaml", "yml"};

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

/// Says what is written, or why it is not.
Result<void> tell(const Explorer& explorer, Result<void> written, const std::string& path, const char* what) {
  if (written) explorer.exports.written(path, fmt::format("{} in {}.", what, whole_path(path)));
  return written;
}

Result<void> save_session(Explorer& explorer, const Call& call) {
  const std::string path = call.text(0);
  if (auto right = check_type(path, kSessionTypes); !right) return right;
  auto written = write_file(path, session_to_json(session_of(explorer)));
  if (written) explorer.files.set_session(path);
  return tell(explorer, std::move(written), path, "The session is saved");
}

Result<void> export_cloud(Explorer& explorer, const Call& call) {
  const Pane& shown = explorer.pane(call.text(0) == "a" ? Side::kA : Side::kB);
  if (!shown.full || !shown.request) return not_now("The map's points are not all placed yet.");
  const std::string path = call.text(1);
  explorer.exports.start(
      {.title = "Writing " + path,
       .done = fmt::format("{} points are saved in {}.", shown.full->beams.size(), whole_path(path)),
       .file = path,
       .write = [path, request = *shown.request, placed = shown.full](const Job&) {
         return write_cloud(path, cloud_of(request, *placed));
       }});
  return {};
}

Result<void> export_curve(Explorer& explorer, const Call& call) {
  const std::string path = call.text(0);
  const Estimate* found = explorer.estimating.found();
  if (found == nullptr) return not_now("There is no estimate to export yet.");
  if (!path.ends_with(".csv") && !path.ends_with(".json"))
    return not_now(fmt::format("{}: the criteria are written as .csv or .json", path));
  auto written = path.ends_with(".csv") ? write_curve_csv(path, *found)
                                        : write_estimate_json(path, *found, Timing::kNull);
  return tell(explorer, std::move(written), path, "The criteria are saved");
}

Result<void> export_rig(Explorer& explorer, const Call& call) {
  const std::string path = call.text(0);
  if (auto right = check_type(path, kRigTypes); !right) return right;
  const Estimate* found = explorer.estimating.found();
  if (found == nullptr || !found->rig)
    return not_now("No rig has been solved for: choose what to solve for, then estimate the offset.");
  return tell(explorer, write_file(path, found_rig_file(*found->rig, found->recording)), path,
              "The rig file is saved");
}

Result<void> use_rig(Explorer& explorer, const Call& call) {
  const Loaded* loaded = explorer.loaded();
  if (loaded != nullptr && loaded->choices.file.empty())
    return not_now("A sample has no rig file: simulate it into a file first.");
  if (auto written = export_rig(explorer, call); !written) return written;
  ReadingChoices choices = loaded->choices;
  choices.rig_file = call.text(0);
  explorer.load(choices, Restored{explorer.settings(), *explorer.estimating.found()});
  return {};
}

/// The options that a report quotes: files without their folders.
std::string report_options(const Explorer& explorer) {
  const Settings& settings = explorer.settings();
  std::string words = shell_options(explorer.loaded()->choices, false);
  if (settings.solve_for != Settings().solve_for) {
    words += " --solve " + settings.solve_for;
    if (settings.prior() != Settings().prior()) words += " --prior " + settings.prior();
  }
  return words + assume_option(explorer.options().assume);
}

Result<void> export_report(Explorer& explorer, const Call& call) {
  const std::string folder = call.text(0);
  if (explorer.loaded() == nullptr) return not_now("There is no recording to report on.");
  const std::string command = report_command(explorer.loaded()->recording.name, report_options(explorer));
  ReportOptions wanted{.assume = explorer.options().assume};
  wanted.solve = estimate_asked_for(explorer.settings(), wanted.assume).solve;
  const std::filesystem::path page = std::filesystem::path(folder) / "report.html";
  explorer.exports.start({.title = "Writing a report",
                          .done = fmt::format("The report is saved in {}.", whole_path(page)),
                          .file = page,
                          .write = [loaded = explorer.recording.loaded(), wanted, folder,
                                    command](const Job& job) -> Result<void> {
                            auto content = gather_report(loaded->prepared, wanted, nullptr, job);
                            if (!content) return tl::unexpected(content.error());
                            content->command = command;
                            job.report("drawing", 0);
                            return write_report(*content, folder, job);
                          },
                          .steps = steps_of_reporting()});
  return {};
}

void copy(Explorer& explorer, Window& window, const Call&) {
  const Copied copied = what_to_copy(explorer);
  window.copy(copied.text);
  explorer.messages.note(fmt::format("Copied {}: {}", copied.what, copied.text));
}

void copy_command(Explorer& explorer, Window& window, const Call&) {
  const std::string line = window.command_line();
  window.copy(line);
  explorer.messages.note("Copied: " + line);
}

Parameter written_file(std::string ending, FileUse use = FileUse::kWritten) {
  return {.name = use == FileUse::kReport ? "FOLDER" : "FILE",
          .kind = Kind::kText,
          .file = use,
          .ending = std::move(ending)};
}

}  // namespace

std::string suggested_file(const Explorer& explorer, const std::string& command, const std::string& what) {
  const Loaded* loaded = explorer.loaded();
  const Settings& settings = explorer.settings();
  std::string name =
      loaded != nullptr ? std::filesystem::path(loaded->recording.name).stem().string() : "sweepscope";
  if (command == "export-cloud")
    name += fmt::format("-{}ms", what == "a" ? settings.offset_a_ms : settings.offset_b_ms);
  if (command == "export-picture" && what == "maps") name += "-maps";
  if (command == "export-figure") name += "-figure";
  for (const Parameter& parameter : find_command(command)->parameters)
    if (!parameter.ending.empty()) return name + parameter.ending;
  return "";
}

std::vector<Command> file_commands() {
  return {
      action({"save-session", "Save the session", "The recording's name, all settings and the estimate."},
             {written_file(".session.json", FileUse::kSession)}, save_session, Need::kRecording),
      window_action({"copy", "Copy the offset or the point",
                     "Copies the place of the inspected point in map B, in metres; without one, the offset "
                     "that was changed last, in milliseconds."},
                    {}, copy),
      window_action(
          {"copy-command", "Copy as command line", "Copies the shell command that makes this picture."}, {},
          copy_command, Need::kRecording),
      window_action(
          {"export-picture", "Export the picture",
           "As PNG or JPEG, by the file's ending: everything, or the maps alone; the maps also with a size, such as 3840x2400, with legend "
           "and scale, all points and smooth edges."},
          {written_file(".png"), optional_of(choice_of("WHAT", {"everything", "maps"})),
           optional_of(text_of("SIZE"))},
          [](Explorer&, Window& window, const Call& call) {
            return window.export_picture(call.text(0), call.text(1), call.text(2));
          },
          Need::kRecording),
      window_action(
          {"export-figure", "Export a figure",
           "The maps as PNG, SVG or PDF, by the file's ending. PARTS: offsets, legend, scale and close-up, "
           "separated by commas, or none."},
          {written_file(".png"), optional_of(text_of("SIZE")), optional_of(text_of("PARTS"))},
          [](Explorer&, Window& window, const Call& call) {
            return window.export_figure(call.text(0), call.text(1), call.text(2));
          },
          Need::kRecording),
      action({"export-cloud", "Export a map's points", "As PCD or PLY, by the file's ending."},
             {choice_of("MAP", {"a", "b"}), written_file(".pcd")}, export_cloud, Need::kMaps),
      action({"export-curve", "Export the criteria", "As CSV or JSON, by the file's ending."},
             {written_file("-criteria.csv")}, export_curve, Need::kEstimate),
      action({"export-rig", "Export the rig found",
              "The rig file with the parts that were solved for beside the offset."},
             {written_file("-rig.yaml")}, export_rig, Need::kEstimate),
      action({"use-rig", "Use the rig found",
              "Writes the rig file and opens the recording with it: the maps are drawn with that rig."},
             {written_file("-rig.yaml")}, use_rig, Need::kEstimate),
      action({"export-report", "Export a report",
              "Writes one HTML page into a folder: the offset, its evidence and the maps."},
             {written_file("-report", FileUse::kReport)}, export_report, Need::kRecording),
  };
}

}  // namespace sweepscope::ui
