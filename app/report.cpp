#include "render/report/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "app/commands.hpp"
#include "app/offset_texts.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "core/io/atomic_file.hpp"
#include "core/io/estimate_json.hpp"
#include "core/map/offset_map.hpp"
#include "core/offset/motion_test.hpp"
#include "core/recording/inspect.hpp"

namespace sweepscope::app {
namespace {

constexpr double kOff_s = 0.005;
constexpr double kLeastRatio = 1.3;  // of a wall's widths: a face that shows no difference tells nothing

struct Options {
  RecordingOptions recording;
  std::string folder, command;
};

/// The maps 5 ms off and at the answer, and the face between them that tells most.
Result<void> add_maps(ReportContent& content, const Recording& recording, const Options& options,
                      const Job& job) {
  const double offset_s = std::round(*content.estimate.offset_s * 1e5) / 1e5;  // as it is printed
  const std::vector<double> offsets_s{offset_s - kOff_s, offset_s};
  MapOptions map_options;
  map_options.assume = parse_method(options.recording.assume);
  auto built = build_maps(recording, offsets_s, map_options, job);
  if (!built) return tl::unexpected(built.error());
  std::vector<MapOnPath> on_paths;
  for (OffsetMap& map : *built) {
    ComparedMap& next = content.maps.emplace_back();
    next.offset_s = map.offset_s;
    next.cloud = map.cloud;
    next.path = std::move(map.trajectory);
  }
  for (const ComparedMap& map : content.maps) on_paths.push_back({map.cloud.get(), map.path});
  SectionSearch search;
  search.motor_axis = recording.rig.mount.axis;
  const auto found = best_section(on_paths, search);
  if (found && found->widths_mm.at(0) > kLeastRatio * found->widths_mm.at(1))
    content.section = found->section;
  return {};
}

/// What the direct method says of the same recording.
Result<void> add_direct(ReportContent& content, const Recording& recording, const Job& job) {
  EstimateOptions wanted;
  wanted.method = Method::kDirect;
  wanted.assume = parse_method(content.estimate.kind);
  auto found = estimate(recording, wanted, job);
  if (!found) return tl::unexpected(found.error());
  if (found->interrupted) return failure(ExitCode::kInterrupted, "Interrupted in the direct method.");
  if (found->identifiable) content.direct = std::move(*found);
  return {};
}

Result<ReportContent> gather(const Options& options) {
  const Progress progress;
  const auto recording = options.recording.read(progress.job());
  if (!recording) return tl::unexpected(recording.error());
  ReportContent content;
  content.command = options.command;
  content.recording = inspect(*recording);
  const auto motion = test_motion(*recording, progress.job());
  if (!motion) return tl::unexpected(motion.error());
  if (motion->answered()) content.recording.motion = motion->moving() ? "moving" : "stationary";
  EstimateOptions wanted;
  wanted.assume = parse_method(options.recording.assume);
  auto found = estimate(*recording, wanted, progress.job());
  if (!found) return tl::unexpected(found.error());
  if (found->interrupted) return failure(ExitCode::kInterrupted, "Interrupted while looking for the offset.");
  content.estimate = std::move(*found);
  if (!content.estimate.identifiable || !content.estimate.offset_s) return content;
  return add_direct(content, *recording, progress.job())
      .and_then([&] { return add_maps(content, *recording, options, progress.job()); })
      .map([&] { return std::move(content); });
}

Result<void> write(const ReportContent& content, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return failure(ExitCode::kWrongUsage,
                   fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
  }
  return report_html(content)
      .and_then([&](const std::string& page) { return write_file(folder / "report.html", page); })
      .and_then(
          [&] { return write_estimate_json(folder / "estimate.json", content.estimate, Timing::kNull); });
}

ExitCode run(const Options& options) {
  const auto threads = options.recording.limit_threads();
  const auto content = gather(options);
  if (!content) return fail(content.error());
  if (const auto written = write(*content, options.folder); !written) return fail(written.error());
  fmt::print("{}\n", (std::filesystem::path(options.folder) / "report.html").string());
  for (const std::string& reason : content->estimate.reasons) say("{}\n", reason);
  return content->estimate.identifiable ? ExitCode::kDone : ExitCode::kNotIdentifiable;
}

/// The command as a shell would take it, whatever the path of the program.
std::string as_typed(const std::vector<std::string>& words) {
  std::string text = "sweepscope";
  for (const std::string& word : words) {
    const bool plain = !word.empty() && word.find_first_not_of(
                                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                            "-_./:,=+%@") == std::string::npos;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
    text += " " + (plain ? word : quoted + "'");
  }
  return text;
}

}  // namespace

void add_report(CLI::App& app, ExitCode& exit_code, const std::vector<std::string>& words) {
  CLI::App* command = app.add_subcommand("report", "Write one HTML page: the offset, its evidence, the maps");
  auto options = std::make_shared<Options>();
  options->command = as_typed(words);
  options->recording.declare(*command);
  options->recording.declare_computing(*command);
  command->add_option("-o,--output", options->folder, "The folder for report.html and estimate.json")
      ->type_name("DIR")
      ->required();
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace sweepscope::app
