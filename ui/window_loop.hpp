#pragma once

#include <string>

#include "ui/script/script.hpp"

namespace sweepscope::ui {

/// The explorer in a window until it is closed. `first_line` is carried out at the beginning, and then the
/// script where there is one.
Result<void> run_in_window(Ui::Options options, int width_px, int height_px, const std::string& first_line,
                           const Script* script);

/// The same interface in a context without a window, for the length of a script.
Result<void> run_headless(gl::Context& context, Ui::Options options, const std::string& first_line,
                          const Script& script);

}  // namespace sweepscope::ui
