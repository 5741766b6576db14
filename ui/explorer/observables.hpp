#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ui/state/session.hpp"

namespace sweepscope::ui {

class Explorer;

/// The status line: what is shown, in words.
std::string status(const Explorer& explorer);

/// A number or word of the current state, for scripts; empty if there is none of that name.
std::optional<std::string> observe(const Explorer& explorer, std::string_view name);
/// Their names and meanings.
std::vector<std::pair<std::string, std::string>> observables();

/// What is kept of the current state.
Session session_of(const Explorer& explorer);

/// What the command "copy" copies, and in what words.
struct Copied {
  std::string text, what;
};
Copied what_to_copy(const Explorer& explorer);

/// The shell command that makes the current picture at this size.
std::string command_line(const Explorer& explorer, int width_px, int height_px);
/// " --assume moving"; empty where nothing is assumed.
std::string assume_option(const std::optional<RigKind>& assume);

}  // namespace sweepscope::ui
