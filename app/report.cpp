#include "render/report/gather_report.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/estimate_options.hpp"
#include "app/memory.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "core/io/printable_text.hpp"
#include "core/offset/rig_estimate.hpp"
#include "render/gl/context.hpp"

namespace sweepscope::app {
namespace {

struct ReportArguments {
  RecordingOptions recording;
  std::string folder;
  EstimateOptions estimate;  // of it, what is solved for beside the offset
  std::size_t points = kDefaultLivePoints;
  std::string quoted;              // the options that decide, as the report quotes them
  std::vector<std::string> given;  // the options, as they were given
};

std::filesystem::path kept_candidates(const ReportArguments& options) {
  return std::filesystem::path(options.folder) / "report.candidates";
}

/// Finished candidates are kept in the report's folder until the report is there.
Result<ReportContent> make(const ReportArguments& options) {
  if (const auto drawable = gl::check_offscreen(); !drawable) return tl::unexpected(drawable.error());
  const Progress progress;
  const auto recording = options.recording.read(progress.job());
  if (!recording) return tl::unexpected(recording.error());
  if (const auto made = make_report_folder(options.folder); !made) return tl::unexpected(made.error());
  const auto kept = keep_while_working(kept_candidates(options), options.recording, options.given);
  if (!kept) return tl::unexpected(kept.error());
  auto content = prepare(*recording, FeatureOptions(), progress.job()).and_then([&](const auto& prepared) {
    const ReportOptions wanted{options.recording.assumed_kind(), options.estimate.solve, options.points};
    return gather_report(prepared, wanted, kept->get(), progress.job());
  });
  if (!content) return tl::unexpected(ended(content.error(), **kept));
  content->command = report_command(recording->name, options.quoted);
  if (const auto written = write_report(*content, options.folder); !written)
    return tl::unexpected(written.error());
  (*kept)->remove();
  return content;
}

Result<void> check_files(const ReportArguments& options) {
  std::vector<std::string> outputs{kept_candidates(options).string()};
  for (const auto& file : report_files(options.folder)) outputs.push_back(file.string());
  return check_outputs(outputs, options.recording.input_files(), options.folder);
}

ExitCode run(const ReportArguments& options) {
  reuse_memory();
  const auto threads = options.recording.limit_threads();
  if (const auto checked = check_files(options); !checked) return fail(checked.error());
  const auto content = make(options);
  if (!content) return fail(content.error());
  print("{}\n", (std::filesystem::path(options.folder) / "report.html").string());
  for (const std::string& reason : content->estimate.reasons()) say("{}\n", reason);
  return has_answer(content->estimate) ? ExitCode::kDone : ExitCode::kNotIdentifiable;
}

/// ReportArguments as a shell would take them, files by their names. What does not change the report is left
/// out, so that its bytes are the same wherever files lie and however many threads there are.
std::string quoted_options(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->get_positional() || name == "--output" || name == "--threads") continue;
    for (const std::string& value : option->results()) {
      const bool is_file = name == "--rig";
      text +=
          " " + name + " " + shell_word(is_file ? std::filesystem::path(value).filename().string() : value);
    }
  }
  return text;
}

}  // namespace

void add_report(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command =
      app.add_subcommand("report", "Write a self-contained HTML page: the offset, its evidence and the maps");
  auto options = std::make_shared<ReportArguments>();
  options->recording.declare(*command);
  options->recording.declare_computing(*command);
  declare_estimate_options(*command, options->estimate, {"solve", "prior"});
  command->add_option("-o,--output", options->folder, "The folder for report.html and estimate.json")
      ->type_name("DIR")
      ->required();
  command
      ->add_option("--points", options->points,
                   "Number of measured points that the page draws at any offset; 0: still pictures only")
      ->type_name("N")
      ->capture_default_str()
      ->check(CLI::Range(std::size_t{0}, kMaxLivePoints));
  command->callback([options, command, &exit_code] {
    options->given = deciding_options(*command);
    options->quoted = quoted_options(*command);
    exit_code = run(*options);
  });
}

}  // namespace sweepscope::app
