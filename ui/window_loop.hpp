#pragma once

#include <span>
#include <string>

#include "ui/script/script.hpp"

namespace sweepscope::ui {

/// The explorer in a window until it is closed. `first_line` is carried out at the beginning, and then the
/// scripts.
Result<void> run_in_window(Ui::Options options, int width_px, int height_px, const std::string& first_line,
                           std::span<const Script> scripts);

/// The same interface in a context without a window, for the length of the scripts.
Result<void> run_headless(gl::Context& context, Ui::Options options, const std::string& first_line,
                          std::span<const Script> scripts);

}  // namespace sweepscope::ui
