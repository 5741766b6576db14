#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "render/gl/window.hpp"
#include "ui/script/script.hpp"

namespace sweepscope::ui {

struct WindowOptions {
  int width_px = 0, height_px = 0;
  std::filesystem::path record;  // what is done after the scripts goes here, as a script; empty: nowhere
};

/// Runs the explorer in a window until it is closed. `first_line` is executed first, then the scripts.
Result<void> run_in_window(Ui::Options options, const WindowOptions& wanted, const std::string& first_line,
                           std::span<const Script> scripts);

/// What differs between kinds of windows.
struct WindowHooks {
  std::function<void()> wake;        // ends the window's wait() early; from any thread
  std::function<void(Ui&)> started;  // before anything is executed; may be empty
};

/// Runs the explorer in this window, as run_in_window does.
Result<void> run_explorer(gl::Window& window, Ui::Options options, const std::filesystem::path& record,
                          const WindowHooks& hooks, const std::string& first_line,
                          std::span<const Script> scripts);

/// Runs the same interface without a window until the scripts end. `record`: what they do goes here, as a
/// script whose places are in pixels; empty: nowhere.
Result<void> run_headless(gl::Context& context, Ui::Options options, const std::string& first_line,
                          std::span<const Script> scripts, const std::filesystem::path& record = {});

}  // namespace sweepscope::ui
