#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <string>

#include "render/comparison/colouring.hpp"
#include "render/pictures/depth_cues.hpp"

namespace sweepscope::ui {

/// The view of a pane on its map: at `centre_m`, from `elevation_deg` above the horizon (90: from
/// above), turned by `turn_deg` about the vertical; `height_m` of the scene fills the pane's height.
struct ViewPoint {
  Eigen::Vector3d centre_m{0, 0, 0};
  double height_m = 20;
  double turn_deg = 0;
  double elevation_deg = 90;

  bool operator==(const ViewPoint&) const = default;
};

enum class Layout { kSideBySide, kSwipe, kOnlyA, kOnlyB, kDifference, kStacked };
enum class Heights { kSharp, kAll, kSlab, kBelowCeiling };
/// The side panel that is open where the window has no room for panels beside the maps.
enum class Sheet { kNone, kRecording, kDisplay };
enum class Theme { kDark, kLight };
enum class Backdrop { kTheme, kBlack, kWhite };
enum class Tool { kLook, kPick, kMeasure, kProfile };
enum class Search { kAutomatic, kRange, kOverTime };

/// Everything that a person can set in the explorer, and that a session keeps. Data alone; each field has
/// one command (commands.hpp) that sets it.
struct Settings {
  double offset_a_ms = 0, offset_b_ms = 0;

  Layout layout = Layout::kSideBySide;
  double divider = 0.5;    // of a swipe, from the pane's left edge
  double map_share = 0.5;  // of map A: of the width side by side, of the height stacked
  bool linked = true;      // the cameras of both panes
  bool perspective = false;
  ViewPoint camera_a, camera_b;

  ColourBy colouring = ColourBy::kElevation;
  std::string table = "viridis";
  Heights heights = Heights::kSharp;
  double slab_from_m = 0.8, slab_to_m = 2.5;  // above the sensor's path
  double point_size_px = 2;
  Backdrop backdrop = Backdrop::kTheme;
  DepthCues cues;
  bool trajectory = true;
  double time_from_s = 0, time_to_s = 0;  // since the first scan; both 0: all of the recording
  double colour_from = 0, colour_to = 0;  // values at the ends of the colour table; both the same: found
  Eigen::Vector3d box_from_m{0, 0, 0}, box_to_m{0, 0, 0};  // only points inside; both the same: all

  double time_s = -1;     // the moment that is played, since the first scan; below 0: none
  double play_speed = 1;  // seconds of the recording per second

  Tool tool = Tool::kLook;
  Eigen::Vector2d profile_from_m{0, 0}, profile_to_m{0, 0};        // both the same: none
  double asked_scan = -1, asked_beam = -1;                         // of the inspected point; below 0: none
  Eigen::Vector3d measure_from_m{0, 0, 0}, measure_to_m{0, 0, 0};  // both the same: none
  bool scan_view = false;
  double scan = 0;  // the scan of the scan view

  bool close_up = true;  // of the place where the maps differ most, in a corner of each
  double place = 1;      // the number of that place in their list, best first

  bool estimate_on_opening = true;
  Search search = Search::kAutomatic;
  double search_from_ms = 19, search_to_ms = 29, search_step_ms = 1;
  double window_s = 0;               // of a search over time; below 1: chosen by the program
  std::string solve_for = "offset";  // as the option "solve" takes it
  // How far these parts may be from the rig file: standard deviations. The defaults are those of RigSolve.
  double prior_mount_deg = 20, prior_mount_mm = 500, prior_play_deg = 0.5, prior_encoder_deg = 1;
  std::string method = "automatic",
              fit = "automatic";  // or a value of the option of that name (EstimateOption)

  Theme theme = Theme::kDark;
  bool panels = true;  // to the left and right of the maps
  Sheet sheet = Sheet::kNone;
  bool criteria = true;
  double chart_from_ms = 0, chart_to_ms = 0;  // the offsets that the charts show; both the same: all
  double ui_scale = 0;                        // 0: the display's scale
  double left_width_px = 0, right_width_px = 0, charts_height_px = 0;  // at 100 %; 0: by the window's size

  /// The priors as the option "prior" takes them.
  std::string prior() const {
    return fmt::format("mount_deg={},mount_mm={},play_deg={},encoder_deg={}", prior_mount_deg, prior_mount_mm,
                       prior_play_deg, prior_encoder_deg);
  }
  bool has_box() const { return box_from_m != box_to_m; }

  bool operator==(const Settings&) const = default;
};

}  // namespace sweepscope::ui
