#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "ui/script/script.hpp"

namespace sweepscope::ui {

struct WindowOptions {
  int width_px = 0, height_px = 0;
  std::filesystem::path record;  // what is done after the scripts goes here, as a script; empty: nowhere
};

/// Runs the explorer in a window until it is closed. `first_line` is executed first, then the scripts.
Result<void> run_in_window(Ui::Options options, const WindowOptions& wanted, const std::string& first_line,
                           std::span<const Script> scripts);

/// Runs the same interface without a window until the scripts end.
Result<void> run_headless(gl::Context& context, Ui::Options options, const std::string& first_line,
                          std::span<const Script> scripts);

}  // namespace sweepscope::ui
