#include "app/commands.hpp"

namespace sweepscope::app {

void add_simulate(CLI::App& app, ExitCode& exit_code) {
  (void)app;
  (void)exit_code;
}

}  // namespace sweepscope::app
