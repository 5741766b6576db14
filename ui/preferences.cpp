#include "ui/preferences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "core/io/atomic_file.hpp"
#include "ui/commands/commands.hpp"
#include "ui/recent.hpp"

namespace sweepscope::ui {
namespace {

constexpr std::array<std::string_view, 19> kFields{
    "layout",   "linked",   "perspective", "table",      "point-size",         "backdrop",      "theme",
    "panels",   "criteria", "ui-scale",    "left-width", "right-width",        "charts-height", "map-share",
    "lighting", "splats",   "grid",        "scanner",    "estimate-on-opening"};
constexpr int kMaxSide_px = 16000;

bool is_preference(const Command& command) {
  return std::find(kFields.begin(), kFields.end(), command.name) != kFields.end();
}

}  // namespace

std::filesystem::path preferences_path() {
  const std::filesystem::path recent = recent_list_path();
  return recent.empty() ? recent : recent.parent_path() / "preferences";
}

Settings look_of(const Settings& settings) {
  Settings look;
  for (const Command& command : setting_commands())
    if (command.is_field() && is_preference(command)) look = changed(look, {&command, command.get(settings)});
  return look;
}

Preferences parse_preferences(const std::string& text) {
  Preferences read;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first;
    int width_px = 0, height_px = 0;
    if (words >> first >> width_px >> height_px && first == "window" && width_px > 0 && height_px > 0 &&
        width_px <= kMaxSide_px && height_px <= kMaxSide_px) {
      read.width_px = width_px;
      read.height_px = height_px;
    }
    const auto call = parse_call(line);
    if (call && call->command->is_field() && is_preference(*call->command) && !call->values.empty())
      read.look = changed(read.look, *call);
  }
  return read;
}

std::string to_text(const Preferences& preferences) {
  std::string text;
  for (const std::string& line : lines_to_reach(look_of(preferences.look))) text += line + "\n";
  if (preferences.width_px > 0)
    text += fmt::format("window {} {}\n", preferences.width_px, preferences.height_px);
  return text;
}

Preferences read_preferences(const std::filesystem::path& file) {
  const auto text = file.empty() ? Result<std::string>("") : read_file(file);
  return text ? parse_preferences(*text) : Preferences();
}

void write_preferences(const std::filesystem::path& file, const Preferences& preferences) {
  if (file.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  (void)write_file(file, to_text(preferences));
}

}  // namespace sweepscope::ui
