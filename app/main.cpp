#include <fmt/format.h>

#include <exception>

#include "app/commands.hpp"

namespace {

using namespace sweepscope;

int run(int argc, char** argv) {
  CLI::App app{
      "sweepscope finds the constant time offset between an actuated 2D laser scanner and its motor,\n"
      "and shows what the offset does to the map.   t_motor = t_laser + offset",
      "sweepscope"};
  app.set_version_flag("--version", "sweepscope " SWEEPSCOPE_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(36);
  ExitCode exit_code = ExitCode::kDone;
  app::add_info(app, exit_code);
  app::add_convert(app, exit_code);
  app::add_rig(app, exit_code);
  app::add_simulate(app, exit_code);
  app::add_estimate(app, exit_code);
  app::add_map(app, exit_code);
  app::add_compare(app, exit_code);
  app::add_figures(app, exit_code);
  app::add_report(app, exit_code, {argv + 1, argv + argc});
  app::add_view(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::kWrongUsage);
  }
  return static_cast<int>(exit_code);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "sweepscope: internal error: {}\n", error.what());
    return 1;
  }
}
