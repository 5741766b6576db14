#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/manual.hpp"
#include "app/say.hpp"

using namespace sweepscope;

namespace {

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
  app::add_calibrate(app, exit_code);
  app::add_merge(app, exit_code);
  app::add_map(app, exit_code);
  app::add_compare(app, exit_code);
  app::add_figures(app, exit_code);
  app::add_report(app, exit_code, {argv + 1, argv + argc});
  app::add_view(app, exit_code);
  app::declare_manual(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::kWrongUsage);
  }
  return static_cast<int>(exit_code);
}

// Without standard streams the first files opened would take their numbers, and messages would go into them.
void hold_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    // Nothing can be written to standard output that is not there, and what is written must say so.
    const int held = open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY);
    if (held >= 0 && held != descriptor) close(held);
  }
}

int output_failed() {
  app::say("sweepscope: standard output: cannot be written: {}\n", std::strerror(errno));
  return static_cast<int>(ExitCode::kWrongUsage);
}

// What was printed may still lie in a buffer, and its disk may be full or its reader gone.
int with_output_written(int exit_code) {
  std::cout.flush();
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good();
  return written ? exit_code : output_failed();
}

}  // namespace

int main(int argc, char** argv) {
  hold_standard_streams();
  // A write that cannot be done fails with its reason instead of ending the program without a word.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  app::interrupt_flag();
  try {
    return with_output_written(run(argc, argv));
  } catch (const std::exception& error) {
    if (std::ferror(stdout) != 0) return output_failed();
    app::say("sweepscope: internal error: {}\n", error.what());
    return 1;
  }
}
