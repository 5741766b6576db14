#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/manual.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "app/threads.hpp"
#include "core/io/printable_text.hpp"
#include "core/io/temporary_file.hpp"
#include "core/nearest_word.hpp"

using namespace sweepscope;

namespace {

/// What the chosen subcommand was to work on, as it was typed.
std::string input_of(const CLI::App& app) {
  std::vector<std::string> inputs;
  for (const CLI::App* command : app.get_subcommands()) {
    for (const CLI::Option* option : command->get_options())
      if (option->get_positional())
        inputs.insert(inputs.end(), option->results().begin(), option->results().end());
  }
  return inputs.empty() ? "sweepscope" : fmt::format("{}", fmt::join(inputs, ", "));
}

ExitCode fail_for_memory(const CLI::App& app) {
  return app::fail(app::too_little_memory(input_of(app)));
}

/// Says what is wrong with a first word that names no subcommand; "" if it names one, or is an option.
std::string unknown_subcommand(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return {};
  const std::string word = argv[1];
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == word) return {};
    names.push_back(command->get_name());
  }
  const std::string nearest = nearest_word(word, names);
  return fmt::format("sweepscope: there is no subcommand \"{}\".{} {}", printable_line(word),
                     nearest.empty() ? "" : fmt::format(" Did you mean \"{}\"?", nearest),
                     "All subcommands: sweepscope --help");
}

constexpr const char* kExamples =
    "Examples:\n"
    "  Find the offset          sweepscope estimate REC.bag\n"
    "  See what it does         sweepscope compare REC.bag --offsets-ms 19,24 -o maps.png\n"
    "  Explore it               sweepscope view REC.bag\n"
    "  Make figures             sweepscope figures assets/figures/quick.yaml -o figures\n"
    "  Correct the recording    sweepscope apply REC.bag --offset-ms 24 -o OUT.bag\n"
    "  Try it without a rig     sweepscope simulate room-1 --offset-ms 24 -o REC.bag\n"
    "\n"
    "sweepscope SUBCOMMAND --help lists the options of a subcommand.\n";

void declare_subcommands(CLI::App& app, ExitCode& exit_code) {
  const auto declare = [&](const char* task, auto... add) {
    (add(app, exit_code), ...);
    for (CLI::App* command : app.get_subcommands({}))
      if (command->get_group() == "Subcommands") command->group(task);
  };
  declare("Find the offset", app::add_estimate, app::add_calibrate, app::add_merge);
  declare("See what it does to the map", app::add_view, app::add_compare, app::add_map, app::add_report,
          app::add_figures);
  declare("Recordings and rigs", app::add_info, app::add_rig, app::add_apply, app::add_live, app::add_convert,
          app::add_simulate);
  app.footer(kExamples);
}

int run(int argc, char** argv) {
  CLI::App app{
      "sweepscope finds the constant time offset between an actuated 2D laser scanner and its motor,\n"
      "and shows what the offset does to the map.   t_motor = t_laser + offset",
      "sweepscope"};
  app.set_version_flag("--version", "sweepscope " SWEEPSCOPE_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(36);
  app.get_formatter()->label("Positionals", "Arguments");
  ExitCode exit_code = ExitCode::kDone;
  declare_subcommands(app, exit_code);
  app::declare_manual(app);
  if (argc < 2) {
    fmt::print("{}", app.help());  // lines end as they are
    return static_cast<int>(ExitCode::kDone);
  }
  if (const std::string unknown = unknown_subcommand(app, argc, argv); !unknown.empty()) {
    app::say("{}\n", unknown);
    return static_cast<int>(ExitCode::kWrongUsage);
  }
  try {
    app.parse(argc, argv);
  } catch (const std::bad_alloc&) {
    return static_cast<int>(fail_for_memory(app));
  } catch (const std::length_error&) {
    return static_cast<int>(fail_for_memory(app));  // more than any memory could be asked for
  } catch (const CLI::ParseError& error) {
    // What is wrong quotes what was typed.
    std::ostringstream wrong;
    const bool done = app.exit(error, std::cout, wrong) == 0;
    const std::string words = printable_text(wrong.str());
    std::fwrite(words.data(), 1, words.size(), stderr);
    return static_cast<int>(done ? ExitCode::kDone : ExitCode::kWrongUsage);
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

int internal_error(const std::exception& error) {
  if (std::ferror(stdout) != 0) return output_failed();
  constexpr int kFaultOfTheProgram = 70;  // as sysexits.h has it; 1 is an answer, that of --expect
  app::say("sweepscope: internal error: {}\n", error.what());
  return kFaultOfTheProgram;
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
  try {
    app::interrupt_flag();
    // To the end: TBB would start threads once nothing limits it.
    [[gnu::used]] static const auto* const threads = app::limit_threads().release();
    remove_abandoned_temporary_files();
    return with_output_written(run(argc, argv));
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again) return internal_error(error);
    app::say("sweepscope: no thread can be started; raise the limit of processes (ulimit -u)\n");
    return static_cast<int>(ExitCode::kWrongUsage);
  } catch (const std::exception& error) {
    return internal_error(error);
  }
}
