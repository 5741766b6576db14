#pragma once

#include <imgui.h>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/map/sections/cross_section.hpp"
#include "render/pictures/live_view.hpp"
#include "ui/commands/commands.hpp"
#include "ui/explorer/explorer.hpp"
#include "ui/explorer/maps_picture.hpp"
#include "ui/host/theme.hpp"
#include "ui/model/file_list.hpp"
#include "ui/panes/layout.hpp"

namespace sweepscope::ui {

/// The state of the interface besides the settings; it is not saved.
struct Transient {
  bool palette = false, help = false;
  bool quit = false, quits_at_once = false;  // asked for; though a file is still written
  std::string palette_query;
  int palette_choice = 0;
  struct Asked {
    std::string command, what;
  };
  std::optional<Asked> asks_for;  // the command whose file is asked for, and what of it
  std::string asked_text;
  struct Browsing {
    std::string folder;  // whose entries are known
    std::vector<FileEntry> entries;
    bool known = false, all = false, to_end = false;
    int choice = -1;  // among the entries that match what is typed; below 0: none
  };
  Browsing browsing;  // of the dialog that opens
  struct Figure {     // of its dialog
    std::string size = kUsualFigureSize;
    FigureParts parts;
  };
  Figure figure;
  double pane_aspect = 1;    // of a map's picture: width over height
  std::string replaces;      // what exists, and is to be replaced if it is confirmed once more
  bool for_picture = false;  // of the maps: nothing is drawn that only hands need
  bool just_opened = false;  // the window in front takes the keyboard
  std::optional<Eigen::Vector3d> measure_from_m;  // the first end, until there is a second
  std::optional<Eigen::Vector2d> profile_from_m;  // while a profile is drawn
  std::string gesture;                            // of the current drag
  int gestures = 0;
  struct HandleDrag {
    Side side = Side::kA;
    double plot_left = 0, plot_width = 1, from_ms = 0, to_ms = 1;  // the axis as it was at the start
    double grab_ms = 0;                                            // of the mouse, from the offset
  };
  std::optional<HandleDrag> handle;
  struct Brought {
    Side side = Side::kA;
    double from_ms = 0;
  };
  std::optional<Brought> brought;  // the handle that the last click in a chart moved
  struct ChartPan {
    double plot_width = 1, from_ms = 0, to_ms = 1, mouse_px = 0;  // as they were at the start
    std::size_t chart = 0;
  };
  std::optional<ChartPan> chart_pan;
  struct Typing {
    std::string box;  // NumberBox::id
    std::string text;
    bool begun = false, focused = false;
  };
  std::optional<Typing> typing;          // the number that is typed into
  std::optional<std::string> type_next;  // the box that is typed into from the next frame on
  std::vector<std::string> boxes;        // of this frame, in the order of drawing
  std::string opens_menu;                // a menu's title, until it is open
  int start_choice = -1;                 // of the start page, by the keyboard; below 0: none
  std::vector<std::string> start_lines;  // what can be chosen there
  double time_handle = 0;                // which end of a time window is held
  bool on_choices_page = false;          // it was drawn in the frame before
  struct KnownProfile {
    PlacedCloudPtr cloud;
    std::array<double, 4> line{};
    Profile profile;
  };
  std::array<KnownProfile, 2> profiles;  // of both maps, along the line of the settings
  double camera_moved_s = 1e9;           // ago
  ImGuiID resting_on = 0;                // the widget whose tooltip comes next
  double resting_since_s = 0;
  std::vector<std::string> recent;
};

class FigurePreview;

/// The context that every pane is drawn with.
struct PaneContext {
  Explorer& explorer;
  Transient& transient;
  const Fonts& fonts;
  const Style& style;
  double scale;
  std::array<LiveView*, 2> views, close_ups;
  FigurePreview& preview;
  double draw_budget_s;  // of each pane and frame; a slice of points may go beyond it
  /// Names of positions that scripts can click: "button estimate", "handle a", "map b", ...
  std::map<std::string, PixelRect>& anchors;

  const Settings& settings() const { return explorer.settings(); }
  double px(double at_100_percent) const { return at_100_percent * scale; }
  float pxf(double at_100_percent) const { return static_cast<float>(at_100_percent * scale); }
  /// Executes a command line; an error is shown as a message.
  void perform(const std::string& line, const std::string& gesture = {}) const;
  void perform(const Call& call, const std::string& gesture = {}) const;
  /// A new name for a drag that begins.
  std::string begin_gesture() const;
  void anchor(const std::string& name, const PixelRect& rect) const { anchors[name] = rect; }
  /// The last widget's place.
  void anchor_last(const std::string& name) const;
};

/// The colour behind the points.
Colour backdrop_of(const PaneContext& context);
/// Of lines and letters over it.
Colour ink_of(const PaneContext& context);

/// Each pane is drawn into its part of the interface, once per frame.
void draw_menu_bar(const PaneContext& context, const PixelRect& place);
void draw_status_bar(const PaneContext& context, const PixelRect& place);
void draw_start_page(const PaneContext& context, const PixelRect& place);
/// What decides how a recording is read, to choose from, each with what was detected.
void draw_choices_page(const PaneContext& context, const PixelRect& place);
void draw_loading_page(const PaneContext& context, const PixelRect& place);
/// `above`: over the maps, in a window without room for panels beside them.
void draw_recording_panel(const PaneContext& context, const PixelRect& place, bool above);
void draw_display_panel(const PaneContext& context, const PixelRect& place, bool above);
/// What opens these panels, and the estimate.
void draw_tabs(const PaneContext& context, const PixelRect& place);
void draw_maps(const PaneContext& context, const PixelRect& place);
void draw_criteria(const PaneContext& context, const PixelRect& place);
/// Where the recording is played: the time, and how fast it goes on.
void draw_playback(const PaneContext& context, const PixelRect& place);
/// Edges between the parts of the interface that can be dragged; a double click gives the size by the window.
void draw_splitters(const PaneContext& context, const Places& places, const PixelRect& whole);
/// The card of the inspected point, and of the measured distance.
void draw_cards(const PaneContext& context, const PixelRect& maps);
/// The windows in front: the palette, the keys, a dialog.
void draw_palette(const PaneContext& context, const PixelRect& whole);
void draw_help(const PaneContext& context, const PixelRect& whole);
void draw_ask(const PaneContext& context, const PixelRect& whole);
/// The strip above the status line, and the height that it needs; 0 without a message.
void draw_message(const PaneContext& context, const PixelRect& place);
double message_height(const PaneContext& context, double width_px);

}  // namespace sweepscope::ui
