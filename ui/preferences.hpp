#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// What is kept from one run to the next: theme, layout, panels and sizes, whether opening estimates, and the
/// window's size.
struct Preferences {
  Settings look;                    // the other settings are the default ones
  int width_px = 0, height_px = 0;  // of the window; 0: not known

  bool operator==(const Preferences&) const = default;
};

/// The file of this user's preferences; empty without a home folder.
std::filesystem::path preferences_path();

/// Lines of commands, and `window WIDTH HEIGHT`. Lines that mean nothing are skipped.
Preferences parse_preferences(const std::string& text);
std::string to_text(const Preferences& preferences);

/// A file that cannot be read gives the default ones.
Preferences read_preferences(const std::filesystem::path& file);
/// Write errors are ignored: preferences are a convenience.
void write_preferences(const std::filesystem::path& file, const Preferences& preferences);

/// The part of the settings that is a preference, with the default ones otherwise.
Settings look_of(const Settings& settings);

}  // namespace sweepscope::ui
