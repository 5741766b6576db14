#include <algorithm>
#include <array>

#include "core/offset/estimate_options.hpp"
#include "ui/state/command.hpp"

namespace sweepscope::ui {
namespace {

using Values = std::vector<Value>;
using Commands = std::vector<Command>;

/// `refs`: from settings to an array of pointers to their numbers.
template <typename Refs>
Command numbers(const CommandWords& words, std::vector<Parameter> parameters, Refs refs) {
  const auto get = [refs](const Settings& s) {
    Values values;
    for (const double* value : refs(s)) values.emplace_back(*value);
    return values;
  };
  const auto set = [refs](Settings& s, const Values& v) {
    std::size_t i = 0;
    for (double* value : refs(s)) *value = std::get<double>(v[i++]);
  };
  return {words.name, words.title, words.help, std::move(parameters), Field{get, set}};
}

template <typename... Members>
auto members(Members... all) {
  return [=](auto& s) { return std::array{&(s.*all)...}; };
}

Command number(const CommandWords& words, double Settings::*member, Parameter parameter) {
  return numbers(words, {std::move(parameter)}, members(member));
}

Command range(const CommandWords& words, double Settings::*from, double Settings::*to, Parameter first,
              Parameter second) {
  return numbers(words, {std::move(first), std::move(second)}, members(from, to));
}

Command toggle(const CommandWords& words, bool Settings::*member) {
  const auto get = [member](const Settings& s) { return Values{s.*member}; };
  const auto set = [member](Settings& s, const Values& v) { s.*member = std::get<bool>(v[0]); };
  return {words.name, words.title, words.help, {switch_of("STATE")}, Field{get, set}};
}

/// `member`: of the settings, an enumeration whose values have these names in order, or one of the names.
template <typename Member>
Command choice(const CommandWords& words, Member member, const std::vector<std::string>& names) {
  using Held = std::remove_reference_t<std::invoke_result_t<Member, Settings&>>;
  const auto get = [=](const Settings& s) {
    if constexpr (std::is_enum_v<Held>)
      return Values{names[static_cast<std::size_t>(std::invoke(member, s))]};
    else
      return Values{std::invoke(member, s)};
  };
  const auto set = [=](Settings& s, const Values& v) {
    const std::string& name = std::get<std::string>(v[0]);
    if constexpr (std::is_enum_v<Held>)
      std::invoke(member, s) = static_cast<Held>(std::find(names.begin(), names.end(), name) - names.begin());
    else
      std::invoke(member, s) = name;
  };
  return {words.name, words.title, words.help, {choice_of("WHICH", names)}, Field{get, set}};
}

std::vector<std::string> names_of(std::span<const std::string_view> names) {
  return {names.begin(), names.end()};
}

/// What points are coloured by alone: the difference is a layout.
std::vector<std::string> colourings() {
  std::vector<std::string> names = names_of(colour_by_names());
  names.erase(names.begin() + static_cast<std::ptrdiff_t>(ColourBy::kDistance));
  return names;
}

/// The choices that an option of estimates has, or to leave it to the program.
std::vector<std::string> automatic_or(const char* option) {
  std::vector<std::string> choices{"automatic"};
  const auto& theirs = find_estimate_option(option)->choices;
  choices.insert(choices.end(), theirs.begin(), theirs.end());
  return choices;
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

Command needing_recording(Command command) {
  command.needs = Need::kRecording;
  return command;
}

/// The same field, which does something more once it is set.
Command field_then(Command command, void (*more)(Settings&)) {
  Field& field = std::get<Field>(command.handler);
  field.set = [set = field.set, more](Settings& s, const Values& v) {
    set(s, v);
    more(s);
  };
  return command;
}

Command edit(const CommandWords& words, std::vector<Parameter> parameters,
             std::function<void(Settings&, const Values&)> set) {
  return {words.name, words.title, words.help, std::move(parameters), Edit{std::move(set)}};
}

Command moving_view(Command command) {
  command.moves_view = true;
  return command;
}

Command camera(const std::string& name, const std::string& title, ViewPoint Settings::*member) {
  return moving_view(
      numbers({name, title, "The point it looks at, the height of the view, and the direction."},
              {number_of("X", "m", -1e5, 1e5, 0), number_of("Y", "m", -1e5, 1e5, 0),
               number_of("Z", "m", -1e5, 1e5, 0), number_of("HEIGHT", "m", 0.01, 1e5, 0),
               number_of("TURN", "°", -360, 360, 5), number_of("ELEVATION", "°", -90, 90, 5)},
              [member](auto& s) {
                auto& v = s.*member;
                return std::array{&v.centre_m[0], &v.centre_m[1], &v.centre_m[2],
                                  &v.height_m,    &v.turn_deg,    &v.elevation_deg};
              }));
}

/// Two places of the map frame.
template <typename Place>
Command two_places(const CommandWords& words, std::vector<std::string> names, double step,
                   Place Settings::*from, Place Settings::*to) {
  std::vector<Parameter> parameters;
  for (std::string& name : names) parameters.push_back(number_of(std::move(name), "m", -1e5, 1e5, step));
  return needing_recording(numbers(words, std::move(parameters), [from, to](auto& s) {
    constexpr std::size_t kSize = Place::SizeAtCompileTime;
    std::array<decltype(&(s.*from)[0]), 2 * kSize> all{};
    for (std::size_t i = 0; i < kSize; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      all[i] = &(s.*from)[axis];
      all[kSize + i] = &(s.*to)[axis];
    }
    return all;
  }));
}

template <typename Change>
void for_both_cameras(Settings& s, const Change& change) {
  change(s.camera_a);
  change(s.camera_b);
}

void look(Settings& s, const std::string& from) {
  for_both_cameras(s, [&](ViewPoint& view) {
    view.elevation_deg = from == "top" ? 90 : from == "isometric" ? 35.264 : 0;
    view.turn_deg = from == "right" ? 90 : from == "isometric" ? 45 : 0;
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

void clip_to_view(Settings& s) {
  const double reach_m = std::max(0.1, std::round(4 * s.camera_a.height_m) / 10);
  const auto tenths = [](double metres) { return std::round(metres * 10) / 10; };
  const Eigen::Vector3d middle_m = s.camera_a.centre_m.unaryExpr(tenths);
  s.box_from_m = middle_m.array() - reach_m;
  s.box_to_m = middle_m.array() + reach_m;
}

Commands fields_of_maps() {
  const Parameter offset = number_of("OFFSET", "ms", -10000, 10000, 0.1);
  return {
      number({"offset-a", "Offset of map A", "t_motor = t_laser + offset, for the map on the left."},
             &Settings::offset_a_ms, offset),
      number({"offset-b", "Offset of map B", "t_motor = t_laser + offset, for the map on the right."},
             &Settings::offset_b_ms, offset),
      choice({"layout", "Layout",
              "Side by side; overlaid, with a movable divider; one map alone; or the distance of each point "
              "of B from its place in A; or A above B."},
             &Settings::layout, {"side-by-side", "swipe", "a", "b", "difference", "stacked"}),
      number({"map-share", "Share of map A", "Of the width side by side, of the height stacked."},
             &Settings::map_share, number_of("SHARE", "", 0.15, 0.85, 0.05)),
      number({"divider", "Divider of the swipe", "Fraction of the width that shows map A."},
             &Settings::divider, number_of("SHARE", "", 0, 1, 0.05)),
      field_then(toggle({"linked", "Linked",
                         "Both maps are seen from the same camera; unlink to move each by itself."},
                        &Settings::linked),
                 [](Settings& s) {
                   if (s.linked) s.camera_b = s.camera_a;
                 }),
      toggle({"perspective", "Perspective", "Perspective projection; off: the same scale everywhere."},
             &Settings::perspective),
      camera("camera-a", "Camera of map A", &Settings::camera_a),
      camera("camera-b", "Camera of map B", &Settings::camera_b),
  };
}

Commands fields_of_points() {
  return {
      choice({"colouring", "Colour by",
              "Elevation in the map; the laser's intensity; the time of the beam; the direction that "
              "the motor turned in; edge and plane points; or the blur: how thick the surface is."},
             &Settings::colouring, colourings()),
      choice({"table", "Colour table",
              "Viridis and cividis are safe for colour-blind eyes and for grey print; turbo shows finer "
              "steps."},
             &Settings::table, names_of(colour_table_names())),
      choice({"heights", "Heights",
              "Blur shows: at least 0.8 m above or below the sensor's path, without the ceiling. "
              "All: everything. Slab: between two heights above the path. No ceiling: everything below it."},
             &Settings::heights, {"sharp", "all", "slab", "no-ceiling"}),
      range({"slab", "Slab", "The visible range of heights above the sensor's path."}, &Settings::slab_from_m,
            &Settings::slab_to_m, number_of("FROM", "m", -50, 50, 0.1), number_of("TO", "m", -50, 50, 0.1)),
      number({"point-size", "Point size", "In pixels, before the display's scale."}, &Settings::point_size_px,
             number_of("SIZE", "px", 1, 8, 0.5)),
      choice({"backdrop", "Background", "Behind the points: the theme's, black or white."},
             &Settings::backdrop, {"theme", "black", "white"}),
  };
}

/// As the command line's options of these names.
Commands fields_of_depth() {
  Commands all;
  for (const DepthCueOption& option : depth_cue_options())
    all.push_back(choice(
        {option.name, option.title, option.help + "."},
        [cue = option.cue](auto& s) -> auto& { return s.cues.*cue; }, names_of(kSwitchNames)));
  return all;
}

Commands fields_of_parts() {
  return {
      toggle({"trajectory", "Sensor's path", "The path of the sensor as solved for map B."},
             &Settings::trajectory),
      range({"time-window", "Time window",
             "Only beams of this part of the recording, in seconds since the first scan. Both 0: all."},
            &Settings::time_from_s, &Settings::time_to_s, number_of("FROM", "s", 0, 1e6, 0.5),
            number_of("TO", "s", 0, 1e6, 0.5)),
      needing_recording(
          range({"colour-range", "Colour range",
                 "The values at the ends of the colour table. Equal values: found from the maps."},
                &Settings::colour_from, &Settings::colour_to, number_of("FROM", "", -1e6, 1e6, 0.1),
                number_of("TO", "", -1e6, 1e6, 0.1))),
      field_then(
          two_places({"box", "Clipping box",
                      "Only points inside this box of the map frame are shown. Equal corners: all points."},
                     {"X0", "Y0", "Z0", "X1", "Y1", "Z1"}, 0.1, &Settings::box_from_m, &Settings::box_to_m),
          [](Settings& s) {
            const Eigen::Vector3d a = s.box_from_m, b = s.box_to_m;
            s.box_from_m = a.cwiseMin(b);
            s.box_to_m = a.cwiseMax(b);
          }),
      needing_recording(
          number({"time", "Time",
                  "The time of playback, in seconds since the first scan: its scan is drawn in the maps. "
                  "Below 0: none."},
                 &Settings::time_s, number_of("TIME", "s", -1, 1e7, 0.1))),
      number({"play-speed", "Speed", "Seconds of the recording that are played in one second."},
             &Settings::play_speed, number_of("SPEED", "×", 0.05, 50, 0.05)),
  };
}

Command size_at_100_percent(const char* name, const char* title, double Settings::*member) {
  return number({name, title, "At 100 %; 0: by the window's size. Its edge can be dragged."}, member,
                number_of("SIZE", "px", 0, 4000, 1));
}

Commands fields_of_interface() {
  return {
      choice({"theme", "Theme", "Dark for the screen, light for paper and bright rooms."}, &Settings::theme,
             {"dark", "light"}),
      toggle({"panels", "Side panels", "The panels to the left and right of the maps."}, &Settings::panels),
      choice(
          {"open-panel", "Open panel",
           "In a small window, which has no room for panels beside the maps: the one that lies over them."},
          &Settings::sheet, {"none", "recording", "display"}),
      toggle({"criteria", "Criteria", "The criteria over the offset, below the maps."}, &Settings::criteria),
      range({"chart-range", "Offsets shown",
             "The part of the offset axis that the charts show, in milliseconds. Both 0: all. The "
             "wheel zooms, a drag beside the handles moves it, and a double click shows all."},
            &Settings::chart_from_ms, &Settings::chart_to_ms, number_of("FROM", "ms", -10000, 10000, 1),
            number_of("TO", "ms", -10000, 10000, 1)),
      number({"ui-scale", "Interface size", "1 is 100 %, 2 is 200 %; 0: the display's scale."},
             &Settings::ui_scale, number_of("SCALE", "", 0, 4, 0.25)),
      size_at_100_percent("left-width", "Width of the left panel", &Settings::left_width_px),
      size_at_100_percent("right-width", "Width of the right panel", &Settings::right_width_px),
      size_at_100_percent("charts-height", "Height of the charts", &Settings::charts_height_px),
  };
}

Commands fields_of_tools() {
  return {
      choice({"tool", "Tool",
              "What a click on a map does: turn the view, show where a point comes from, measure "
              "a distance, or draw a profile across a wall."},
             &Settings::tool, {"look", "pick", "measure", "profile"}),
      two_places({"profile", "Profile line",
                  "The line across a wall, in the map frame, along which the densities of both maps are "
                  "compared, at most 50 m long. No line where both ends are equal."},
                 {"X1", "Y1", "X2", "Y2"}, 0, &Settings::profile_from_m, &Settings::profile_to_m),
      two_places(
          {"measure", "Measured distance", "Between two places of the map frame. None where both are equal."},
          {"X1", "Y1", "Z1", "X2", "Y2", "Z2"}, 0, &Settings::measure_from_m, &Settings::measure_to_m),
      needing_recording(range({"pick", "Inspected point",
                               "The point whose scan, beam, time, motor angle and places are shown. -1 -1: "
                               "none."},
                              &Settings::asked_scan, &Settings::asked_beam, number_of("SCAN", "", -1, 1e7, 1),
                              number_of("BEAM", "", -1, 1e5, 1))),
      toggle({"scan-view", "Scan features",
              "One scan with its edge points and plane points, as in the paper's Figure 2."},
             &Settings::scan_view),
      number({"scan", "Scan", "The scan that the scan view shows, counted from 0."}, &Settings::scan,
             number_of("NUMBER", "", 0, 1e7, 1)),
      toggle({"close-up", "Close-up",
              "A place where the maps differ most, from above, in a corner of each map. A blurred "
              "surface fills more cells of 5 cm than a sharp one."},
             &Settings::close_up),
      number({"place", "Place",
              "Which place the close-up shows: 1 is where the maps differ most. Long walls come "
              "after compact objects, which differ in all directions."},
             &Settings::place, number_of("NUMBER", "", 1, 12, 1)),
  };
}

Commands fields_of_estimates() {
  return {
      toggle({"estimate-on-opening", "Estimate on opening",
              "A recording that is opened is estimated at once; map A stays as recorded, map B shows the "
              "offset found."},
             &Settings::estimate_on_opening),
      choice({"search", "Search",
              "Automatic: coarse to fine about 0 ms. Range: the candidates that you specify. Over time: the "
              "offset in windows, and its course: constant, drifting or with jumps."},
             &Settings::search, {"automatic", "range", "over-time"}),
      number({"search-window", "Windows",
              "The length of the windows of a search over time. 0: 10 s, and at least 12 sweeps."},
             &Settings::window_s, number_of("LENGTH", "s", 0, 86400, 1)),
      numbers({"search-range", "Candidates",
               "The candidate offsets: from, to and step. The paper uses 19 to 29 ms in steps of 1 ms."},
              {number_of("FROM", "ms", -10000, 10000, 1), number_of("TO", "ms", -10000, 10000, 1),
               number_of("STEP", "ms", 0.001, 1000, 0.1)},
              members(&Settings::search_from_ms, &Settings::search_to_ms, &Settings::search_step_ms)),
      choice({"solve-for", "Solve for",
              "Parts of the rig beside the offset: how the laser is mounted on the motor, the play of "
              "the gear, the encoder's eccentricity. By the direct method."},
             &Settings::solve_for, parts_to_solve_for()),
      range({"mount-prior", "Mount prior",
             "How far the mount may be turned and shifted from the rig file: standard deviations."},
            &Settings::prior_mount_deg, &Settings::prior_mount_mm, number_of("TURN", "°", 0.001, 180, 0.5),
            number_of("SHIFT", "mm", 0.001, 1e5, 10)),
      range({"gear-prior", "Gear prior",
             "How far the gear's play and the encoder's eccentricity may be from the rig file: "
             "standard deviations."},
            &Settings::prior_play_deg, &Settings::prior_encoder_deg, number_of("PLAY", "°", 0.001, 90, 0.1),
            number_of("ENCODER", "°", 0.001, 90, 0.1)),
      choice({"method", "Method",
              "Stationary: the offset at which odometry registers the least motion d (equation 3). "
              "Moving: the offset at which the map is sharpest, by matches n and their distance e "
              "(equations 6 and 7). Direct: the offset as an unknown of a least-squares fit. Automatic: "
              "direct."},
             &Settings::method, automatic_or("method")),
      choice({"fit", "Fit",
              "None: the best candidate. Parabola: the extremum of a parabola through n within 3 units of"
              " it, or through the squares of d or e within 1 unit. A unit is 1 ms, and more for slow "
              "motors."},
             &Settings::fit, automatic_or("fit")),
  };
}

Commands edits() {
  return {
      edit({"nudge", "Move an offset", "Adds to the offset of map A or B."},
           {choice_of("MAP", {"a", "b"}), number_of("BY", "ms", -1000, 1000, 0.1)},
           [](Settings& s, const Values& v) {
             double& offset_ms = std::get<std::string>(v[0]) == "a" ? s.offset_a_ms : s.offset_b_ms;
             offset_ms = std::round((offset_ms + std::get<double>(v[1])) * 1e4) / 1e4;
           }),
      edit({"swap", "Swap A and B", "Exchanges the two offsets."}, {},
           [](Settings& s, const Values&) { std::swap(s.offset_a_ms, s.offset_b_ms); }),
      edit({"flip", "Flip between A and B", "Shows one map alone, then the other."}, {},
           [](Settings& s, const Values&) {
             s.layout = s.layout == Layout::kOnlyA ? Layout::kOnlyB : Layout::kOnlyA;
           }),
      edit({"look", "Look from", "Turns the cameras."},
           {choice_of("FROM", {"front", "right", "top", "isometric"})},
           [](Settings& s, const Values& v) { look(s, std::get<std::string>(v[0])); }),
      needing_recording(
          edit({"box-here", "Clip to the view", "Sets the clipping box to the middle of the view."}, {},
               [](Settings& s, const Values&) { clip_to_view(s); })),
      moving_view(edit({"zoom", "Zoom", "By a factor; above 1 zooms in."},
                       {number_of("FACTOR", "", 0.01, 100, 1.25)},
                       [](Settings& s, const Values& v) {
                         for_both_cameras(s, [&](ViewPoint& view) {
                           view.height_m = std::clamp(view.height_m / std::get<double>(v[0]), 0.02, 1e4);
                         });
                       })),
      moving_view(
          edit({"pan", "Move the view", "By fractions of its height, to the right and up."},
               {number_of("RIGHT", "", -10, 10, 0.1), number_of("UP", "", -10, 10, 0.1)},
               [](Settings& s, const Values& v) { pan(s, std::get<double>(v[0]), std::get<double>(v[1])); })),
      moving_view(edit({"turn", "Turn the view", "About the vertical, and up or down."},
                       {number_of("ABOUT", "°", -360, 360, 15), number_of("UP", "°", -180, 180, 15)},
                       [](Settings& s, const Values& v) {
                         for_both_cameras(s, [&](ViewPoint& view) {
                           view.turn_deg = std::remainder(view.turn_deg + std::get<double>(v[0]), 360);
                           view.elevation_deg =
                               std::clamp(view.elevation_deg + std::get<double>(v[1]), -90.0, 90.0);
                         });
                       })),
  };
}

}  // namespace

std::span<const Command> setting_commands() {
  static const Commands all = [] {
    Commands joined;
    for (const auto& group : {fields_of_maps, fields_of_points, fields_of_depth, fields_of_parts,
                              fields_of_interface, fields_of_tools, fields_of_estimates, edits})
      std::ranges::copy(group(), std::back_inserter(joined));
    return joined;
  }();
  return all;
}

}  // namespace sweepscope::ui
