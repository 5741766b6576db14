#include "render/figures/figures.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <memory>
#include <string>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"

namespace sweepscope::app {
namespace {

struct Options {
  std::string recipe, folder, draw_in = "offscreen";
  int threads = 0;
};

ExitCode run(const Options& options) {
  std::unique_ptr<tbb::global_control> limit;
  if (options.threads > 0) {
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<std::size_t>(options.threads));
  }
  const auto recipe = read_recipe(options.recipe);
  if (!recipe) return fail(recipe.error());
  const Progress progress;
  const auto said = [&progress](const std::string& line) { progress.say(line); };
  const auto canvas = backend(options.draw_in).and_then(make_canvas);
  if (!canvas) return fail(canvas.error());
  const auto files = make_figures(*recipe, options.folder, **canvas, progress.job(), said);
  if (!files) return fail(files.error());
  for (const auto& file : *files) fmt::print("{}\n", file.string());
  return ExitCode::kDone;
}

}  // namespace

void add_figures(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command = app.add_subcommand("figures", "Make the figures and tables that a recipe lists");
  auto options = std::make_shared<Options>();
  command->add_option("RECIPE", options->recipe, "A recipe (YAML), such as assets/figures/quick.yaml")
      ->required();
  command
      ->add_option("-o,--output", options->folder,
                   "The folder for pictures and tables; its folder cache keeps the estimates")
      ->type_name("DIR")
      ->required();
  command
      ->add_option("--draw-in", options->draw_in,
                   "offscreen, or window, where pictures are seen as they are drawn")
      ->capture_default_str()
      ->check(CLI::IsMember({"offscreen", "window"}));
  command->add_option("--threads", options->threads, "Threads (default: as many as there are processors)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace sweepscope::app
