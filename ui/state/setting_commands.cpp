#include <algorithm>

#include "core/offset/estimate_options.hpp"
#include "ui/state/command_parts.hpp"

namespace sweepscope::ui {
namespace {

using Values = std::vector<Value>;

Command number(const CommandWords& words, double Settings::*field, Parameter parameter) {
  return {words.name,
          words.title,
          words.help,
          {std::move(parameter)},
          [field](const Settings& s) { return Values{s.*field}; },
          [field](Settings& s, const Values& v) { s.*field = std::get<double>(v[0]); }};
}

Command numbers(const CommandWords& words, double Settings::*from, double Settings::*to, Parameter first,
                Parameter second) {
  return {words.name,
          words.title,
          words.help,
          {std::move(first), std::move(second)},
          [=](const Settings& s) {
            return Values{s.*from, s.*to};
          },
          [=](Settings& s, const Values& v) {
            s.*from = std::get<double>(v[0]);
            s.*to = std::get<double>(v[1]);
          }};
}

Command toggle(const CommandWords& words, bool Settings::*field) {
  return {words.name,
          words.title,
          words.help,
          {{.name = "STATE", .kind = Kind::kSwitch}},
          [field](const Settings& s) { return Values{s.*field}; },
          [field](Settings& s, const Values& v) { s.*field = std::get<bool>(v[0]); }};
}

template <typename Enum>
Command choice(const CommandWords& words, Enum Settings::*field, const std::vector<std::string>& names) {
  const auto index = [names](const std::string& name) {
    return std::find(names.begin(), names.end(), name) - names.begin();
  };
  return {words.name,
          words.title,
          words.help,
          {choice_of("WHICH", names)},
          [field, names](const Settings& s) { return Values{names[static_cast<std::size_t>(s.*field)]}; },
          [field, index](Settings& s, const Values& v) {
            s.*field = static_cast<Enum>(index(std::get<std::string>(v[0])));
          }};
}

Command table_choice() {
  return {"table",
          "Colour table",
          "Viridis and cividis are safe for colour-blind eyes and for grey print; turbo shows finer steps.",
          {choice_of("WHICH", {"viridis", "cividis", "turbo", "grey"})},
          [](const Settings& s) { return Values{s.table}; },
          [](Settings& s, const Values& v) { s.table = std::get<std::string>(v[0]); }};
}

/// A cue of depth, as the command line's option of that name.
Command depth_cue(const DepthCueOption& option) {
  return {option.name,
          option.title,
          option.help + ".",
          {choice_of("WHICH", {kSwitchNames.begin(), kSwitchNames.end()})},
          [cue = option.cue](const Settings& s) {
            return Values{std::string(kSwitchNames[static_cast<std::size_t>(s.cues.*cue)])};
          },
          [cue = option.cue](Settings& s, const Values& v) {
            s.cues.*cue = switch_named(std::get<std::string>(v[0])).value();
          }};
}

/// A choice that an option of estimates has, or to leave it to the program.
Command estimate_choice(const CommandWords& words, std::string Settings::*field) {
  std::vector<std::string> choices{"automatic"};
  const auto& theirs = find_estimate_option(words.name)->choices;
  choices.insert(choices.end(), theirs.begin(), theirs.end());
  return {words.name,
          words.title,
          words.help,
          {choice_of("WHICH", choices)},
          [field](const Settings& s) { return Values{s.*field}; },
          [field](Settings& s, const Values& v) { s.*field = std::get<std::string>(v[0]); }};
}

/// Every value of the option "solve" in which each part is named once.
std::vector<std::string> parts_to_solve_for() {
  std::vector<std::string> choices{"offset"};
  for (const char* part : {"mount", "play", "encoder"}) {
    const std::vector<std::string> without = choices;
    for (const std::string& parts : without) choices.push_back(parts + "," + part);
  }
  return choices;
}

Command solve_for() {
  return {"solve-for",
          "Solve for",
          "Parts of the rig beside the offset: how the laser is mounted on the motor, the play of "
          "the gear, the encoder's eccentricity. By the direct method.",
          {choice_of("WHICH", parts_to_solve_for())},
          [](const Settings& s) { return Values{s.solve_for}; },
          [](Settings& s, const Values& v) { s.solve_for = std::get<std::string>(v[0]); }};
}

/// Two prior standard deviations of parts that are solved for.
Command prior(const CommandWords& words, const Parameter& first, const Parameter& second,
              double Settings::*of_first, double Settings::*of_second) {
  return {words.name,
          words.title,
          words.help,
          {first, second},
          [=](const Settings& s) {
            return Values{s.*of_first, s.*of_second};
          },
          [=](Settings& s, const Values& v) {
            s.*of_first = std::get<double>(v[0]);
            s.*of_second = std::get<double>(v[1]);
          }};
}

Command camera(const CommandWords& words, ViewPoint Settings::*field) {
  return {words.name,
          words.title,
          words.help,
          {number_of("X", "m", -1e5, 1e5, 0), number_of("Y", "m", -1e5, 1e5, 0),
           number_of("Z", "m", -1e5, 1e5, 0), number_of("HEIGHT", "m", 0.01, 1e5, 0),
           number_of("TURN", "°", -360, 360, 5), number_of("ELEVATION", "°", -90, 90, 5)},
          [field](const Settings& s) {
            const ViewPoint& v = s.*field;
            return Values{v.centre_m.x(), v.centre_m.y(), v.centre_m.z(),
                          v.height_m,     v.turn_deg,     v.elevation_deg};
          },
          [field](Settings& s, const Values& v) {
            const auto at = [&](std::size_t i) { return std::get<double>(v[i]); };
            s.*field = {{at(0), at(1), at(2)}, at(3), at(4), at(5)};
          }};
}

Command profile() {
  const auto place = [](const char* name) { return number_of(name, "m", -1e5, 1e5, 0); };
  return {"profile",
          "Profile line",
          "The line across a wall, in the map frame, along which the densities of both maps are compared, at "
          "most 50 m long. No line where both ends are equal.",
          {place("X1"), place("Y1"), place("X2"), place("Y2")},
          [](const Settings& s) {
            return Values{s.profile_from_m.x(), s.profile_from_m.y(), s.profile_to_m.x(), s.profile_to_m.y()};
          },
          [](Settings& s, const Values& v) {
            const auto at = [&](std::size_t i) { return std::get<double>(v[i]); };
            s.profile_from_m = {at(0), at(1)};
            s.profile_to_m = {at(2), at(3)};
          }};
}

Command measure() {
  const auto place = [](const char* name) { return number_of(name, "m", -1e5, 1e5, 0); };
  return {"measure",
          "Measured distance",
          "Between two places of the map frame. None where both are equal.",
          {place("X1"), place("Y1"), place("Z1"), place("X2"), place("Y2"), place("Z2")},
          [](const Settings& s) {
            const Eigen::Vector3d &a = s.measure_from_m, &b = s.measure_to_m;
            return Values{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()};
          },
          [](Settings& s, const Values& v) {
            const auto at = [&](std::size_t i) { return std::get<double>(v[i]); };
            s.measure_from_m = {at(0), at(1), at(2)};
            s.measure_to_m = {at(3), at(4), at(5)};
          }};
}

Command clipping_box() {
  const auto place = [](const char* name) { return number_of(name, "m", -1e5, 1e5, 0.1); };
  return {"box",
          "Clipping box",
          "Only points inside this box of the map frame are shown. Equal corners: all points.",
          {place("X0"), place("Y0"), place("Z0"), place("X1"), place("Y1"), place("Z1")},
          [](const Settings& s) {
            const Eigen::Vector3d &a = s.box_from_m, &b = s.box_to_m;
            return Values{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()};
          },
          [](Settings& s, const Values& v) {
            const auto at = [&](std::size_t i) { return std::get<double>(v[i]); };
            const Eigen::Vector3d a(at(0), at(1), at(2)), b(at(3), at(4), at(5));
            s.box_from_m = a.cwiseMin(b);
            s.box_to_m = a.cwiseMax(b);
          }};
}

Command edit(const CommandWords& words, std::vector<Parameter> parameters,
             std::function<void(Settings&, const Values&)> set) {
  return {words.name, words.title, words.help, std::move(parameters), {}, std::move(set)};
}

template <typename Change>
void for_both_cameras(Settings& s, const Change& change) {
  change(s.camera_a);
  change(s.camera_b);
}

void look(Settings& s, const std::string& from) {
  for_both_cameras(s, [&](ViewPoint& view) {
    view.elevation_deg = from == "top" ? 90 : from == "isometric" ? 35.264 : 0;
    if (from == "right") view.turn_deg = 90;
    if (from == "front") view.turn_deg = 0;
    if (from == "isometric") view.turn_deg = 45;
    if (from == "top") view.turn_deg = 0;
  });
}

void pan(Settings& s, double right, double up) {
  for_both_cameras(s, [&](ViewPoint& view) {
    const double turn = view.turn_deg * kRadPerDeg, tilt = view.elevation_deg * kRadPerDeg;
    const Eigen::Vector3d to_right(std::cos(turn), std::sin(turn), 0);
    const Eigen::Vector3d to_top(-std::sin(turn) * std::sin(tilt), std::cos(turn) * std::sin(tilt),
                                 std::cos(tilt));
    view.centre_m += view.height_m * (right * to_right + up * to_top);
  });
}

void add_fields_of_maps(std::vector<Command>& all) {
  const Parameter offset = number_of("OFFSET", "ms", -10000, 10000, 0.1);
  all.push_back(
      number({"offset-a", "Offset of map A", "t_motor = t_laser + offset, for the map on the left."},
             &Settings::offset_a_ms, offset));
  all.push_back(
      number({"offset-b", "Offset of map B", "t_motor = t_laser + offset, for the map on the right."},
             &Settings::offset_b_ms, offset));
  all.push_back(
      choice({"layout", "Layout",
              "Side by side; overlaid, with a movable divider; one map alone; or the distance of each point "
              "of B from its place in A; or A above B."},
             &Settings::layout, {"side-by-side", "swipe", "a", "b", "difference", "stacked"}));
  all.push_back(number({"map-share", "Share of map A", "Of the width side by side, of the height stacked."},
                       &Settings::map_share, number_of("SHARE", "", 0.15, 0.85, 0.05)));
  all.push_back(number({"divider", "Divider of the swipe", "Fraction of the width that shows map A."},
                       &Settings::divider, number_of("SHARE", "", 0, 1, 0.05)));
  all.push_back({"linked",
                 "Linked",
                 "Both maps are seen from the same camera; unlink to move each by itself.",
                 {{.name = "STATE", .kind = Kind::kSwitch}},
                 [](const Settings& s) { return Values{s.linked}; },
                 [](Settings& s, const Values& v) {
                   s.linked = std::get<bool>(v[0]);
                   if (s.linked) s.camera_b = s.camera_a;
                 }});
  all.push_back(
      toggle({"perspective", "Perspective", "Perspective projection; off: the same scale everywhere."},
             &Settings::perspective));
  all.push_back(camera(
      {"camera-a", "Camera of map A", "The point it looks at, the height of the view, and the direction."},
      &Settings::camera_a));
  all.push_back(camera(
      {"camera-b", "Camera of map B", "The point it looks at, the height of the view, and the direction."},
      &Settings::camera_b));
}

void add_fields_of_display(std::vector<Command>& all) {
  all.push_back(
      choice({"colouring", "Colour by",
              "Elevation in the map; the laser's intensity; the time of the beam; the direction that "
              "the motor turned in; edge and plane points; or the blur: how thick the surface is."},
             &Settings::colouring, {"elevation", "intensity", "time", "direction", "features", "blur"}));
  all.push_back(table_choice());
  all.push_back(choice({"heights", "Heights",
                        "Blur shows: at least 0.8 m above or below the sensor's path, without the "
                        "ceiling. All: everything. Slab: between two heights above the path."},
                       &Settings::heights, {"sharp", "all", "slab"}));
  all.push_back(numbers({"slab", "Slab", "The visible range of heights above the sensor's path."},
                        &Settings::slab_from_m, &Settings::slab_to_m, number_of("FROM", "m", -50, 50, 0.1),
                        number_of("TO", "m", -50, 50, 0.1)));
  all.push_back(number({"point-size", "Point size", "In pixels, before the display's scale."},
                       &Settings::point_size_px, number_of("SIZE", "px", 1, 8, 0.5)));
  all.push_back(choice({"backdrop", "Background", "Behind the points: the theme's, black or white."},
                       &Settings::backdrop, {"theme", "black", "white"}));
  for (const DepthCueOption& option : depth_cue_options()) all.push_back(depth_cue(option));
  all.push_back(toggle({"trajectory", "Sensor's path", "The path of the sensor as solved for map B."},
                       &Settings::trajectory));
  all.push_back(
      numbers({"time-window", "Time window",
               "Only beams of this part of the recording, in seconds since the first scan. Both 0: all."},
              &Settings::time_from_s, &Settings::time_to_s, number_of("FROM", "s", 0, 1e6, 0.5),
              number_of("TO", "s", 0, 1e6, 0.5)));
  all.push_back(numbers({"colour-range", "Colour range",
                         "The values at the ends of the colour table. Equal values: found from the maps."},
                        &Settings::colour_from, &Settings::colour_to, number_of("FROM", "", -1e6, 1e6, 0.1),
                        number_of("TO", "", -1e6, 1e6, 0.1)));
  all.push_back(clipping_box());
  all.push_back(number({"time", "Time",
                        "The time of playback, in seconds since the first scan: its scan is drawn in the "
                        "maps. Below 0: none."},
                       &Settings::time_s, number_of("TIME", "s", -1, 1e7, 0.1)));
  all.push_back(number({"play-speed", "Speed", "Seconds of the recording that are played in one second."},
                       &Settings::play_speed, number_of("SPEED", "×", 0.05, 50, 0.05)));
}

void add_fields_of_window(std::vector<Command>& all) {
  all.push_back(choice({"theme", "Theme", "Dark for the screen, light for paper and bright rooms."},
                       &Settings::theme, {"dark", "light"}));
  all.push_back(
      toggle({"panels", "Side panels", "The panels to the left and right of the maps."}, &Settings::panels));
  all.push_back(
      toggle({"criteria", "Criteria", "The criteria over the offset, below the maps."}, &Settings::criteria));
  all.push_back(
      numbers({"chart-range", "Offsets shown",
               "The part of the offset axis that the charts show, in milliseconds. Both 0: all. The "
               "wheel zooms, a drag beside the handles moves it, and a double click shows all."},
              &Settings::chart_from_ms, &Settings::chart_to_ms, number_of("FROM", "ms", -10000, 10000, 1),
              number_of("TO", "ms", -10000, 10000, 1)));
  all.push_back(number({"ui-scale", "Interface size", "1 is 100 %, 2 is 200 %; 0: the display's scale."},
                       &Settings::ui_scale, number_of("SCALE", "", 0, 4, 0.25)));
  const auto size_of = [&](const char* name, const char* title, double Settings::*field) {
    all.push_back(number({name, title, "At 100 %; 0: by the window's size. Its edge can be dragged."}, field,
                         number_of("SIZE", "px", 0, 4000, 1)));
  };
  size_of("left-width", "Width of the left panel", &Settings::left_width_px);
  size_of("right-width", "Width of the right panel", &Settings::right_width_px);
  size_of("charts-height", "Height of the charts", &Settings::charts_height_px);
}

void add_fields_of_tools(std::vector<Command>& all) {
  all.push_back(choice({"tool", "Tool",
                        "What a click on a map does: turn the view, show where a point comes from, measure "
                        "a distance, or draw a profile across a wall."},
                       &Settings::tool, {"look", "pick", "measure", "profile"}));
  all.push_back(profile());
  all.push_back(measure());
  all.push_back(numbers({"pick", "Inspected point",
                         "The point whose scan, beam, time, motor angle and places are shown. -1 -1: none."},
                        &Settings::asked_scan, &Settings::asked_beam, number_of("SCAN", "", -1, 1e7, 1),
                        number_of("BEAM", "", -1, 1e5, 1)));
  all.push_back(toggle({"scan-view", "Scan features",
                        "One scan with its edge points and plane points, as in the paper's Figure 2."},
                       &Settings::scan_view));
  all.push_back(number({"scan", "Scan", "The scan that the scan view shows, counted from 0."},
                       &Settings::scan, number_of("NUMBER", "", 0, 1e7, 1)));
  all.push_back(toggle({"close-up", "Close-up",
                        "A place where the maps differ most, from above, in a corner of each map. A blurred "
                        "surface fills more cells of 5 cm than a sharp one."},
                       &Settings::close_up));
  all.push_back(number({"place", "Place",
                        "Which place the close-up shows: 1 is where the maps differ most. Long walls come "
                        "after compact objects, which differ in all directions."},
                       &Settings::place, number_of("NUMBER", "", 1, 12, 1)));
}

void add_fields_of_estimates(std::vector<Command>& all) {
  all.push_back(
      choice({"search", "Search",
              "Automatic: coarse to fine about 0 ms. Range: the candidates that you specify. Over time: the "
              "offset in windows, and its course: constant, drifting or with jumps."},
             &Settings::search, {"automatic", "range", "over-time"}));
  all.push_back(number({"search-window", "Windows",
                        "The length of the windows of a search over time. 0: 10 s, and at least 12 sweeps."},
                       &Settings::window_s, number_of("LENGTH", "s", 0, 86400, 1)));
  all.push_back(
      Command{"search-range",
              "Candidates",
              "The candidate offsets: from, to and step. The paper uses 19 to 29 ms in steps of 1 ms.",
              {number_of("FROM", "ms", -10000, 10000, 1), number_of("TO", "ms", -10000, 10000, 1),
               number_of("STEP", "ms", 0.001, 1000, 0.1)},
              [](const Settings& s) {
                return Values{s.search_from_ms, s.search_to_ms, s.search_step_ms};
              },
              [](Settings& s, const Values& v) {
                s.search_from_ms = std::get<double>(v[0]);
                s.search_to_ms = std::get<double>(v[1]);
                s.search_step_ms = std::get<double>(v[2]);
              }});
  all.push_back(solve_for());
  all.push_back(prior({"mount-prior", "Mount prior",
                       "How far the mount may be turned and shifted from the rig file: standard deviations."},
                      number_of("TURN", "°", 0.001, 180, 0.5), number_of("SHIFT", "mm", 0.001, 1e5, 10),
                      &Settings::prior_mount_deg, &Settings::prior_mount_mm));
  all.push_back(prior({"gear-prior", "Gear prior",
                       "How far the gear's play and the encoder's eccentricity may be from the rig file: "
                       "standard deviations."},
                      number_of("PLAY", "°", 0.001, 90, 0.1), number_of("ENCODER", "°", 0.001, 90, 0.1),
                      &Settings::prior_play_deg, &Settings::prior_encoder_deg));
  all.push_back(estimate_choice(
      {"method", "Method",
       "Stationary: the offset at which odometry registers the least motion d (equation 3). Moving: the "
       "offset at which the map is sharpest, by matches n and their distance e (equations 6 and 7). Direct: "
       "the offset as an unknown of a least-squares fit. Automatic: direct."},
      &Settings::method));
  all.push_back(estimate_choice(
      {"fit", "Fit",
       "None: the best candidate. Parabola: the extremum of a parabola through n within 3 units of it, or "
       "through the squares of d or e within 1 unit. A unit is 1 ms, and more for slow motors."},
      &Settings::fit));
}

void add_edits(std::vector<Command>& all) {
  all.push_back(edit({"nudge", "Move an offset", "Adds to the offset of map A or B."},
                     {choice_of("MAP", {"a", "b"}), number_of("BY", "ms", -1000, 1000, 0.1)},
                     [](Settings& s, const Values& v) {
                       double& offset_ms = std::get<std::string>(v[0]) == "a" ? s.offset_a_ms : s.offset_b_ms;
                       offset_ms = std::round((offset_ms + std::get<double>(v[1])) * 1e4) / 1e4;
                     }));
  all.push_back(edit({"swap", "Swap A and B", "Exchanges the two offsets."}, {},
                     [](Settings& s, const Values&) { std::swap(s.offset_a_ms, s.offset_b_ms); }));
  all.push_back(edit({"flip", "Flip between A and B", "Shows one map alone, then the other."}, {},
                     [](Settings& s, const Values&) {
                       s.layout = s.layout == Layout::kOnlyA ? Layout::kOnlyB : Layout::kOnlyA;
                     }));
  all.push_back(edit({"look", "Look from", "Turns the cameras."},
                     {choice_of("FROM", {"front", "right", "top", "isometric"})},
                     [](Settings& s, const Values& v) { look(s, std::get<std::string>(v[0])); }));
  all.push_back(edit({"box-here", "Clip to the view", "Sets the clipping box to the middle of the view."}, {},
                     [](Settings& s, const Values&) {
                       const double reach_m = std::max(0.1, std::round(4 * s.camera_a.height_m) / 10);
                       const auto tenths = [](double metres) { return std::round(metres * 10) / 10; };
                       const Eigen::Vector3d middle_m = s.camera_a.centre_m.unaryExpr(tenths);
                       s.box_from_m = middle_m.array() - reach_m;
                       s.box_to_m = middle_m.array() + reach_m;
                     }));
  all.push_back(edit({"zoom", "Zoom", "By a factor; above 1 zooms in."},
                     {number_of("FACTOR", "", 0.01, 100, 1.25)}, [](Settings& s, const Values& v) {
                       for_both_cameras(s, [&](ViewPoint& view) {
                         view.height_m = std::clamp(view.height_m / std::get<double>(v[0]), 0.02, 1e4);
                       });
                     }));
  all.push_back(
      edit({"pan", "Move the view", "By fractions of its height, to the right and up."},
           {number_of("RIGHT", "", -10, 10, 0.1), number_of("UP", "", -10, 10, 0.1)},
           [](Settings& s, const Values& v) { pan(s, std::get<double>(v[0]), std::get<double>(v[1])); }));
  all.push_back(edit({"turn", "Turn the view", "About the vertical, and up or down."},
                     {number_of("ABOUT", "°", -360, 360, 15), number_of("UP", "°", -180, 180, 15)},
                     [](Settings& s, const Values& v) {
                       for_both_cameras(s, [&](ViewPoint& view) {
                         view.turn_deg = std::remainder(view.turn_deg + std::get<double>(v[0]), 360);
                         view.elevation_deg =
                             std::clamp(view.elevation_deg + std::get<double>(v[1]), -90.0, 90.0);
                       });
                     }));
}

}  // namespace

void add_settings(std::vector<Command>& all) {
  add_fields_of_maps(all);
  add_fields_of_display(all);
  add_fields_of_window(all);
  add_fields_of_tools(all);
  add_fields_of_estimates(all);
  add_edits(all);
}

}  // namespace sweepscope::ui
