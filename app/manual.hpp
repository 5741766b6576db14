#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace sweepscope::app {

/// The manual page (man 7 groff_man) and the completions of shells, all from the declaration of the options.
std::string man_page(const CLI::App& app);
std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);
std::string fish_completion(const CLI::App& app);

/// Adds --man and --completion bash|zsh|fish, which print them. They are not listed in --help.
void declare_manual(CLI::App& app);

}  // namespace sweepscope::app
