#include "render/figures/figures.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "app/threads.hpp"
#include "render/comparison/look_options.hpp"

namespace sweepscope::app {
namespace {

struct FiguresArguments {
  std::string recipe, folder, draw_in = "offscreen";
  int threads = 0;
};

ExitCode run(const FiguresArguments& options) {
  std::unique_ptr<tbb::global_control> limit;
  if (options.threads > 0) limit = limit_threads(static_cast<std::size_t>(options.threads));
  const auto recipe = read_recipe(options.recipe);
  if (!recipe) return fail(recipe.error());
  const Progress progress;
  const auto said = [&progress](const std::string& line) { progress.say(line); };
  const auto canvas = backend(options.draw_in).and_then(make_canvas);
  if (!canvas) return fail(canvas.error());
  const auto files = make_figures(*recipe, options.folder, **canvas, progress.job(), said);
  if (!files) return fail(files.error());
  for (const auto& file : *files) print("{}\n", file.string());
  return ExitCode::kDone;
}

/// The recipe's keys, for those who write one.
std::string recipe_keys() {
  std::string text =
      "A recipe is a YAML file with these keys; NAME is any name of yours:\n"
      "  recordings: {NAME: {file: REC, rig: F, stamps: header|receive, window_s: [A, B]}}\n"
      "        or  {NAME: {simulate: SCENE, offset_ms, seed, duration_s, noise_mm, dropout, sweep_s}}\n"
      "  estimates:  {NAME: {recording: NAME, method, assume, fit, scoring, ranges_ms: [[FROM, TO, STEP], "
      "...]}}\n"
      "  figures:    {NAME: {kind: ..., formats: [png, svg, pdf], and how it looks}}\n"
      "    kind: maps     maps: [{recording, offset_ms, label, points: all|features, poses: solved|truth}, "
      "...];\n"
      "                   estimate: its criteria below; each-own-view: true for maps of different places\n"
      "    kind: curves   estimates: NAME or [NAME, ...]; criteria: [d, e, n, roll]\n"
      "    kind: profile  maps; at_m: [X, Y], normal_deg, length_m, heights_m: [FROM, TO] above the path\n"
      "                   (without at_m: the wall that shows the offset best)\n"
      "    kind: scan     recording, at_s\n"
      "    kind: over-time  estimate: one with over-time\n"
      "    kind: residuals  estimate: one with solve\n"
      "    kind: trend    table: the JSON file of estimate --table\n"
      "    kind: interactive  two maps of one recording, estimate, points: a page to turn the offset in\n"
      "  tables:     {NAME: {title, estimates: [NAME, ...], columns: [{title, unit, decimals, and\n"
      "                   value: offset|sigma|offset-by-d|d|offset-by-n|offset-by-e|truth|difference,\n"
      "                   or values: [a text for each row]}]}}\n"
      "  look:       default look of all figures:\n";
  for (const LookOption& option : look_options()) {
    text += fmt::format("    {:<14} {:<18} {}\n", option.name,
                        option.type.empty() ? "true|false" : option.type, option.help);
  }
  return text;
}

}  // namespace

void add_figures(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command = app.add_subcommand("figures", "Make the figures and tables of a recipe");
  command->footer(recipe_keys);
  auto options = std::make_shared<FiguresArguments>();
  command->add_option("RECIPE", options->recipe, "A recipe (YAML), such as assets/figures/quick.yaml")
      ->required();
  command
      ->add_option("-o,--output", options->folder,
                   "Folder for pictures and tables; estimates are kept in its folder cache")
      ->type_name("DIR")
      ->required();
  command->add_option("--draw-in", options->draw_in, "offscreen, or window to watch the pictures being drawn")
      ->capture_default_str()
      ->check(CLI::IsMember({"offscreen", "window"}));
  command->add_option("--threads", options->threads, "Number of threads (default: all processors)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace sweepscope::app
