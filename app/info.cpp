#include "app/commands.hpp"

namespace sweepscope::app {

void add_info(CLI::App& app, ExitCode& exit_code) {
  (void)app;
  (void)exit_code;
}

}  // namespace sweepscope::app
