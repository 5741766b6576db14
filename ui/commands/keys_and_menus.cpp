#include <algorithm>
#include <array>
#include <string_view>

#include "ui/commands/commands.hpp"

namespace sweepscope::ui {
namespace {

const std::vector<Shortcut> kShortcuts{
    {"Ctrl+O", "ask open"},
    {"Ctrl+Shift+O", "choose"},
    {"Ctrl+S", "ask save-session"},
    {"Ctrl+E", "ask export-picture"},
    {"Ctrl+Shift+E", "ask export-figure"},
    {"Ctrl+R", "ask export-report"},
    {"Ctrl+C", "copy"},
    {"Ctrl+Shift+C", "copy-command"},
    {"Ctrl+Z", "undo"},
    {"Ctrl+Shift+Z", "redo"},
    {"Ctrl+Y", "redo"},
    {"Ctrl+P", "palette"},
    {"Ctrl+Q", "quit"},
    {"H", "help"},
    {"F1", "help"},
    {"?", "help"},
    {"F10", "menu file", "Open the menus"},
    {"Tab", "next-field", "Next field"},
    {"Shift+Tab", "next-field back", "Previous field"},
    {"Escape", "dismiss"},
    {"E", "estimate"},
    {"X", "cancel"},
    {"G", "take-found"},
    {"1", "look front"},
    {"3", "look right"},
    {"7", "look top"},
    {"9", "look isometric"},
    {"0", "fit-view"},
    {"Plus", "zoom 1.25", "Zoom in"},
    {"Minus", "zoom 0.8", "Zoom out"},
    {"Left", "pan -0.1 0", "Pan left"},
    {"Right", "pan 0.1 0", "Pan right"},
    {"Up", "pan 0 0.1", "Pan up"},
    {"Down", "pan 0 -0.1", "Pan down"},
    {"Shift+Left", "turn -15 0", "Turn left"},
    {"Shift+Right", "turn 15 0", "Turn right"},
    {"Shift+Up", "turn 0 15", "Turn up"},
    {"Shift+Down", "turn 0 -15", "Turn down"},
    {"Comma", "nudge a -0.1", "Map A: 0.1 ms less"},
    {"Period", "nudge a 0.1", "Map A: 0.1 ms more"},
    {"Shift+Comma", "nudge a -1", "Map A: 1 ms less"},
    {"Shift+Period", "nudge a 1", "Map A: 1 ms more"},
    {"K", "nudge b -0.1", "Map B: 0.1 ms less"},
    {"L", "nudge b 0.1", "Map B: 0.1 ms more"},
    {"Shift+K", "nudge b -1", "Map B: 1 ms less"},
    {"Shift+L", "nudge b 1", "Map B: 1 ms more"},
    {"Space", "flip"},
    {"B", "layout side-by-side"},
    {"Shift+B", "layout stacked"},
    {"S", "layout swipe"},
    {"D", "layout difference"},
    {"U", "linked"},
    {"Q", "perspective"},
    {"N", "next-place", "Next place that differs"},
    {"Shift+N", "next-place back", "Previous place"},
    {"Y", "close-up"},
    {"Shift+Y", "look-at-place"},
    {"C", "colouring", "Next colouring"},
    {"O", "colouring blur", "Colour by blur"},
    {"V", "table", "Next colour table"},
    {"Z", "heights", "Next heights"},
    {"T", "theme"},
    {"F", "scan-view"},
    {"I", "tool pick"},
    {"M", "tool measure"},
    {"P", "tool profile"},
    {"W", "panels"},
    {"Shift+W", "criteria"},
    {"J", "trajectory"},
    {"R", "play"},
    {"Shift+R", "time -1", "Stop playing"},
    {"Shift+C", "box-here"},
    {"Ctrl+0", "box 0 0 0 0 0 0", "No clipping box"},
    {"A", "lighting", "Next lighting"},
};

const std::vector<MenuItem> kMenuItems{
    {"File", "ask open", "Open …"},
    {"File", "choose", "Open with other choices …"},
    {"File", "ask add-recording", "Add a recording of this rig …"},
    {"File", "sample room-1", "Sample: a room, stationary"},
    {"File", "sample metro-station 20", "Sample: a metro station, 20 s of walking"},
    {"File", "ask save-session", "Save the session …"},
    {"File", ""},
    {"File", "ask export-picture", "Export the picture …"},
    {"File", "ask export-figure", "Export a figure …"},
    {"File", "ask export-cloud a", "Export the points of map A …"},
    {"File", "ask export-cloud b", "Export the points of map B …"},
    {"File", "ask export-curve", "Export the criteria …"},
    {"File", "ask export-rig", "Export the rig found …"},
    {"File", "ask export-report", "Export a report …"},
    {"File", ""},
    {"File", "close"},
    {"File", "quit"},
    {"Edit", "undo"},
    {"Edit", "redo"},
    {"Edit", ""},
    {"Edit", "copy"},
    {"Edit", "copy-command"},
    {"Edit", ""},
    {"Edit", "palette", "All commands …"},
    {"Offset", "estimate", "Estimate"},
    {"Offset", "take-found", "Use the found offset for B"},
    {"Offset", "swap"},
    {"Offset", "cancel", "Cancel running jobs"},
    {"Offset", "solve"},
    {"Offset", "estimate-on-opening", "Estimate when a recording is opened"},
    {"View", "layout side-by-side", "Side by side"},
    {"View", "layout stacked", "Stacked"},
    {"View", "layout swipe", "Swipe"},
    {"View", "flip"},
    {"View", "layout difference", "Difference"},
    {"View", ""},
    {"View", "look front", "From the front"},
    {"View", "look right", "From the right"},
    {"View", "look top", "From above"},
    {"View", "look isometric", "Isometric"},
    {"View", "fit-view"},
    {"View", "perspective"},
    {"View", "linked", "Linked cameras"},
    {"View", ""},
    {"View", "play"},
    {"View", "box-here"},
    {"View", "box 0 0 0 0 0 0", "No clipping box"},
    {"View", ""},
    {"View", "lighting", "Lighting: auto, on, off"},
    {"View", "splats", "Splats: auto, on, off"},
    {"View", "grid", "Ground grid: auto, on, off"},
    {"View", "scanner", "Scanner: auto, on, off"},
    {"View", ""},
    {"View", "panels"},
    {"View", "criteria"},
    {"View", "theme", "Dark or light"},
    {"Tools", "tool look", "Turn the view"},
    {"Tools", "tool pick", "Inspect a point"},
    {"Tools", "tool measure", "Measure a distance"},
    {"Tools", "tool profile", "Profile across a wall"},
    {"Tools", ""},
    {"Tools", "close-up", "Close-up where the maps differ"},
    {"Tools", "next-place", "Next place that differs"},
    {"Tools", "look-at-place"},
    {"Tools", ""},
    {"Tools", "scan-view"},
    {"Help", "help"},
};

struct Synonym {
  const char *line, *words;
};
/// What people call a line, asked for in a dialog or not, beside its title and its words. In small letters.
constexpr std::array kSynonyms{
    Synonym{"look top", "top view plan above bird's eye"},
    Synonym{"look front", "front view side elevation"},
    Synonym{"look right", "side view"},
    Synonym{"look isometric", "3d view tilted"},
    Synonym{"fit-view", "reset view zoom all extents home"},
    Synonym{"chart-range", "reset chart zoom axis"},
    Synonym{"linked", "sync synchronise cameras link lock"},
    Synonym{"export-figure", "png svg pdf image figure print paper save"},
    Synonym{"export-picture", "png jpg jpeg image screenshot save"},
    Synonym{"export-cloud a", "pcd ply cloud save"},
    Synonym{"export-cloud b", "pcd ply cloud save"},
    Synonym{"export-curve", "csv json curve save"},
    Synonym{"export-report", "html save"},
    Synonym{"colouring", "color colour thickness sharpness"},
    Synonym{"colouring blur", "color sharpness thickness walls"},
    Synonym{"colouring elevation", "color height z"},
    Synonym{"table", "colormap color map palette"},
    Synonym{"theme", "dark mode light mode night"},
    Synonym{"backdrop", "color"},
    Synonym{"ui-scale", "font size bigger text zoom dpi"},
    Synonym{"layout swipe", "overlay slider before after"},
    Synonym{"layout difference", "diff distance"},
    Synonym{"perspective", "orthographic projection"},
    Synonym{"lighting", "shading edl"},
    Synonym{"trajectory", "path track"},
    Synonym{"box-here", "crop clip region"},
    Synonym{"box 0 0 0 0 0 0", "reset crop clip"},
    Synonym{"take-found", "answer result snap apply"},
    Synonym{"swap", "exchange"},
    Synonym{"cancel", "stop abort"},
    Synonym{"choose", "topic joint stamps rig import"},
    Synonym{"help", "shortcuts keyboard hotkeys"},
    Synonym{"tool measure", "distance ruler"},
    Synonym{"tool pick", "select point query"},
};

}  // namespace

std::string_view synonyms_of(std::string_view line) {
  constexpr std::string_view kAsk = "ask ";
  if (line.starts_with(kAsk)) line.remove_prefix(kAsk.size());
  const auto found = std::ranges::find(kSynonyms, line, &Synonym::line);
  return found == kSynonyms.end() ? std::string_view() : found->words;
}

std::span<const Shortcut> shortcuts() {
  return kShortcuts;
}

std::string chord_of(std::string_view line) {
  const auto found = std::ranges::find(kShortcuts, line, &Shortcut::line);
  return found == kShortcuts.end() ? "" : found->chord;
}

std::span<const MenuItem> menu_items() {
  static const std::vector<MenuItem> all = [] {
    std::vector<MenuItem> items = kMenuItems;
    for (MenuItem& item : items)
      if (item.title.empty() && !item.line.empty()) item.title = find_command(item.line)->title;
    return items;
  }();
  return all;
}

std::vector<std::string> menu_names() {
  std::vector<std::string> names;
  for (const MenuItem& item : kMenuItems)
    if (names.empty() || names.back() != item.menu) names.push_back(item.menu);
  return names;
}

}  // namespace sweepscope::ui
