#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/memory.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "core/io/atomic_file.hpp"
#include "core/io/output_check.hpp"
#include "ui/preferences.hpp"
#include "ui/script/script.hpp"
#include "ui/serve/serve.hpp"
#include "ui/window_loop.hpp"

namespace sweepscope::app {
namespace {

struct ViewOptions {
  RecordingOptions reading;
  std::string recording;  // or a session
  std::string poses;
  bool headless = false, size_given = false, no_estimate = false;
  std::string size = "1600x1000", script, run, record;
  double scale = 0;
  bool served = false, once = false, listen_anywhere = false;
  std::string address;  // of --serve
  std::vector<std::string> roots, hosts;
};

struct Size {
  int width_px = 0, height_px = 0;
};

constexpr int kMinSide_px = 320, kMaxSide_px = 8000;

Result<Size> parse_size(const std::string& text) {
  Size size;
  const char *begin = text.data(), *end = begin + text.size();
  const auto [x, first] = std::from_chars(begin, end, size.width_px);
  const bool separated = first == std::errc() && x != end && *x == 'x';
  const auto [after, second] =
      separated ? std::from_chars(x + 1, end, size.height_px) : std::from_chars_result{x, first};
  if (!separated || second != std::errc() || after != end || size.width_px < kMinSide_px ||
      size.height_px < kMinSide_px || size.width_px > kMaxSide_px || size.height_px > kMaxSide_px)
    return failure(ExitCode::kWrongUsage,
                   fmt::format("--size {}: WxH is needed, such as 1600x1000, with sides of {} to {} pixels",
                               text, kMinSide_px, kMaxSide_px));
  return size;
}

Result<ui::Ui::Options> ui_options(const ViewOptions& options) {
  ui::Ui::Options out;
  out.explorer.assume = options.reading.assumed_kind();
  out.explorer.estimates_on_opening = !options.no_estimate;
  ui::ReadingChoices& reading = out.explorer.reading;
  reading.streams = options.reading.streams;
  reading.stamps = options.reading.stamps;
  if (options.reading.rig) {
    if (auto rig = read_rig(*options.reading.rig); !rig) return tl::unexpected(rig.error());
    reading.rig_file = options.reading.rig->string();
    out.explorer.input_files.push_back(*options.reading.rig);
  }
  if (const auto& part = options.reading.window) reading.window = TimeWindow{part->from_s, part->to_s};
  if (!options.script.empty()) out.explorer.input_files.emplace_back(options.script);
  if (options.scale > 0) out.display_scale = options.scale;
  out.scale_given = options.scale > 0;
  return out;
}

/// The scripts to carry out one after the other: the file's and --run's.
Result<std::vector<ui::Script>> scripts_of(const ViewOptions& options) {
  std::vector<ui::Script> scripts;
  const auto keep = [&](ui::Script script) { scripts.push_back(std::move(script)); };
  if (!options.script.empty()) {
    const auto kept =
        read_file(options.script)
            .and_then([&](const std::string& text) { return ui::parse_script(text, options.script); })
            .map(keep);
    if (!kept) return tl::unexpected(kept.error());
  }
  if (!options.run.empty()) {
    const auto kept = ui::parse_script(options.run, "--run", true).map(keep);
    if (!kept) return tl::unexpected(kept.error());
  }
  return scripts;
}

/// The script that is written must not replace what is read.
Result<void> check_record(const ViewOptions& options) {
  if (options.record.empty()) return {};
  std::vector<std::filesystem::path> inputs;
  for (const std::string& input : {options.recording, options.poses, options.script})
    if (!input.empty()) inputs.emplace_back(input);
  if (options.reading.rig) inputs.push_back(*options.reading.rig);
  return check_run_files({inputs, {options.record}, {}});
}

/// The folders for viewers; what the command line names may be read wherever it is.
Result<ui::FileRoots> file_roots(const ViewOptions& options) {
  std::vector<std::filesystem::path> folders(options.roots.begin(), options.roots.end());
  if (folders.empty()) folders.emplace_back(".");
  return ui::FileRoots::of(folders).map([&](ui::FileRoots roots) {
    for (const std::string& input : {options.recording, options.poses})
      if (!input.empty()) roots.allow_reading(input);
    if (options.reading.rig) roots.allow_reading(*options.reading.rig);
    return roots;
  });
}

/// From the root of the file system: the working folder changes before it is opened.
std::string absolute(const std::string& path) {
  std::error_code failed;
  const auto whole = std::filesystem::absolute(path, failed);
  return path.empty() || failed ? path : whole.string();
}

std::string first_line_of(const std::string& recording, const std::string& poses) {
  std::string line = recording.empty() ? "" : "open " + ui::quoted(recording);
  if (!poses.empty()) line += " " + ui::quoted(poses);
  return line;
}

Result<void> serve(const ViewOptions& options, ui::Ui::Options with, const ui::WindowOptions& window,
                   std::span<const ui::Script> scripts) {
  const auto address = ui::allowed_listen_address(options.address, options.listen_anywhere);
  if (!address) return tl::unexpected(address.error());
  const auto roots = file_roots(options);
  if (!roots) return tl::unexpected(roots.error());
  const std::string first = first_line_of(absolute(options.recording), absolute(options.poses));
  with.explorer.roots = *roots;
  for (auto& input : with.explorer.input_files) input = absolute(input.string());
  with.explorer.reading.rig_file = absolute(with.explorer.reading.rig_file);
  if (!options.roots.empty()) {
    // What viewers name without a folder lies in the first of theirs.
    std::error_code failed;
    std::filesystem::current_path(roots->folders().front(), failed);
    if (failed)
      return failure(ExitCode::kWrongUsage, fmt::format("--root {}: {}", options.roots[0], failed.message()));
  }
  ui::ServeOptions served;
  served.window = window;
  served.server.address = *address;
  served.server.hosts = {options.listen_anywhere, options.hosts};
  served.server.token = ui::random_token();
  served.server.hub.once = options.once;
  served.server.hub.roots = *roots;
  served.say = [](const std::string& text) {
    for (const std::string& part : {text, std::string("Ctrl-C ends it.\n")}) {
      fmt::print("{}", part);
      std::fflush(stdout);  // it may be read by a program
    }
  };
  return ui::run_served(std::move(with), std::move(served), first, scripts);
}

/// That of the last window, or the default one on a display of this scale (0: the display's own).
Size usual_size(const Size& at_100_percent, double scale) {
  const ui::Preferences before = ui::read_preferences(ui::preferences_path());
  if (before.width_px >= kMinSide_px && before.height_px >= kMinSide_px)
    return {before.width_px, before.height_px};
  const double times = scale > 0 ? scale : gl::display_scale();
  const auto scaled = [&](int side_px) { return static_cast<int>(std::lround(side_px * times)); };
  return {scaled(at_100_percent.width_px), scaled(at_100_percent.height_px)};
}

Result<void> view(const ViewOptions& options) {
  return_memory();  // clouds come and go by the hundred megabytes
  auto size = parse_size(options.size);
  if (!size) return tl::unexpected(size.error());
  const auto scripts = scripts_of(options);
  if (!scripts) return tl::unexpected(scripts.error());
  if (const auto checked = check_record(options); !checked) return checked;
  auto with = ui_options(options);
  if (!with) return tl::unexpected(with.error());
  if (options.served)
    return serve(options, std::move(*with), {size->width_px, size->height_px, absolute(options.record)},
                 *scripts);
  const std::string first = first_line_of(options.recording, options.poses);
  if (!options.headless && !options.size_given) size = usual_size(*size, options.scale);
  if (!options.headless)
    return ui::run_in_window(std::move(*with), {size->width_px, size->height_px, options.record}, first,
                             *scripts);
  if (scripts->empty()) return failure(ExitCode::kWrongUsage, "--headless needs --script F or --run 'LINES'");
  auto context = gl::make_offscreen_context(size->width_px, size->height_px);
  if (!context) return tl::unexpected(context.error());
  return ui::run_headless(**context, std::move(*with), first, *scripts, options.record);
}

void declare_serving(CLI::App& command, ViewOptions& options, CLI::Option* headless) {
  constexpr const char* kServing = "In a browser";
  CLI::Option* serve = command.add_option("--serve", options.address,
                                          "Show this interface in a browser, without a display here; prints "
                                          "the address to open (default: 127.0.0.1:8717)");
  serve->expected(0, 1)->type_name("[ADDRESS:PORT]")->excludes(headless)->group(kServing);
  command
      .add_option(
          "--root", options.roots,
          "Open and write files below this folder only; repeatable. Names without a folder lie in the "
          "first (default: the working folder)")
      ->type_name("DIR")
      ->group(kServing)
      ->needs(serve)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_flag("--once", options.once, "End when the last viewer has left")
      ->group(kServing)
      ->needs(serve);
  command
      .add_flag("--listen-anywhere", options.listen_anywhere,
                "Allow an ADDRESS that other machines can reach; nothing is encrypted")
      ->group(kServing)
      ->needs(serve);
  command
      .add_option("--host", options.hosts,
                  "A name under which browsers reach it, such as that of a reverse proxy; repeatable")
      ->type_name("NAME")
      ->group(kServing)
      ->needs(serve)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void declare(CLI::App& command, ViewOptions& options) {
  constexpr const char* kScripts = "Scripts";
  options.reading.declare_reading(command);
  options.reading.declare_computing(command);
  CLI::Option* recording = command.add_option("REC", options.recording,
                                              "A recording, or a session (.json); default: the start page");
  command
      .add_option("--poses", options.poses,
                  "Trajectory of the rig (TUM), used instead of solving for it; the maps are in its frame")
      ->type_name("F")
      ->needs(recording);
  command.add_flag("--no-estimate", options.no_estimate, "Do not estimate recordings that are opened");
  CLI::Option* headless = command.add_flag("--headless", options.headless,
                                           "Run a script on the same interface without a display");
  headless->group(kScripts);
  command
      .add_option("--size", options.size,
                  "Size of the window in pixels (a window: by default that of the last one)")
      ->capture_default_str();
  command.add_option("--scale", options.scale, "1 is 100 %, 2 is 200 % (default: the display's)")
      ->check(finite_number())
      ->check(CLI::Range(0.5, 4.0));
  command.add_option("--script", options.script, "Script to run: see below")->type_name("F")->group(kScripts);
  command.add_option("--run", options.run, "Script lines, separated by ;, run after those of --script")
      ->type_name("LINES")
      ->group(kScripts);
  command
      .add_option("--record", options.record,
                  "Record as a script what is done in the window, or by a script, with places in pixels")
      ->type_name("F")
      ->group(kScripts);
  declare_serving(command, options, headless);
  command.footer([] { return "\n" + ui::script_help(); });
}

}  // namespace

void add_view(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command =
      app.add_subcommand("view", "Open the explorer: change the offset and watch the map come into focus");
  auto options = std::make_shared<ViewOptions>();
  declare(*command, *options);
  command->callback([options, command, &exit_code] {
    const auto threads = options->reading.limit_threads();
    options->size_given = command->count("--size") > 0;
    options->served = command->count("--serve") > 0;
    end_at_first_interrupt();
    if (const auto done = view(*options); !done) exit_code = fail(done.error());
  });
}

}  // namespace sweepscope::app
