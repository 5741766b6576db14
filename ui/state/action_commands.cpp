#include "core/simulation/scenes/scene.hpp"
#include "ui/state/command_parts.hpp"

namespace sweepscope::ui {
namespace {

Command action(const CommandWords& words, std::vector<Parameter> parameters = {}) {
  return {words.name, words.title, words.help, std::move(parameters)};
}

void add_actions_of_opening(std::vector<Command>& all) {
  const auto optional_text = [](std::string name) {
    return Parameter{.name = std::move(name), .kind = Kind::kText, .optional = true};
  };
  all.push_back(
      action({"choose", "Open with other choices",
              "Shows a page with everything that decides how a recording is read: its topics, the "
              "motor's joint, stamps, a rig file, a part in time, and a known trajectory. Without a "
              "file: of the recording that is open."},
             {optional_text("FILE")}));
  all.push_back(action({"choose-laser", "Laser", "On the page: the topic of the scans. None: detected."},
                       {optional_text("TOPIC")}));
  all.push_back(action({"choose-motor", "Motor",
                        "On the page: the joint that turns the laser, and its topic if several have a joint "
                        "of that name. None: detected."},
                       {optional_text("JOINT"), optional_text("TOPIC")}));
  all.push_back(action({"choose-stamps", "Stamps",
                        "On the page: the stamps that are used for laser and motor, the header's or those of "
                        "receiving."},
                       {choice_of("WHICH", {"detected", "header", "receive"})}));
  all.push_back(action({"choose-rig", "Rig file",
                        "On the page: a file (YAML) with topics, joint, stamps and the laser's place on the "
                        "motor. None: no file."},
                       {optional_text("FILE")}));
  all.push_back(action({"choose-poses", "Trajectory",
                        "On the page: a file (TUM) with the rig's known trajectory, used instead of solving "
                        "for it. None: no file."},
                       {optional_text("FILE")}));
  all.push_back(action({"choose-part", "Time range",
                        "On the page: the part of the recording that is used, in seconds since the first "
                        "scan. Both 0: all of it."},
                       {number_of("FROM", "s", 0, 1e7, 0.1), number_of("TO", "s", 0, 1e7, 0.1)}));
  all.push_back(action({"open-chosen", "Open", "Opens the recording with the choices of the page."}));
}

void add_recordings(std::vector<Command>& all) {
  all.push_back(action({"open", "Open a recording",
                        "A recording (a ROS 1 or ROS 2 bag, or a folder of CSV tables), with the trajectory "
                        "of the rig (TUM) if it is known; a saved session; or an estimate written as JSON."},
                       {text_of("FILE"), {.name = "POSES", .kind = Kind::kText, .optional = true}}));
  all.push_back(
      action({"sample", "Open a simulated sample",
              "A recording whose true offset is known to be 24 ms: a room, or the first seconds of a walk."},
             {choice_of("SCENE", simulation::scene_names()),
              {.name = "SECONDS", .unit = "s", .least = 1, .greatest = 300, .optional = true}}));
}

void add_actions_on_maps(std::vector<Command>& all) {
  all.push_back(action({"close", "Close the recording", "Back to the start page."}));
  all.push_back(action({"fit-view", "Fit the view", "Shows the whole map."}));
  all.push_back(action({"next-place", "Next place",
                        "Moves the close-up to the next place of the list; \"back\": to the previous one."},
                       {{.name = "WAY", .kind = Kind::kChoice, .choices = {"back"}, .optional = true}}));
  all.push_back(
      action({"look-at-place", "Look at the place", "Moves both cameras to the close-up's place."}));
  all.push_back(
      action({"play", "Play or pause",
              "Plays the recording: the current scan is drawn in the maps. At the end it starts again."},
             {{.name = "STATE", .kind = Kind::kSwitch, .optional = true}}));
  all.push_back(action({"estimate", "Estimate the offset", "Searches for the offset in the background."}));
  all.push_back(action({"cancel", "Cancel", "Stops everything that runs in the background."}));
  all.push_back(action({"solve", "Solve the maps", "Resumes what was cancelled."}));
  all.push_back(action({"take-found", "Use the found offset", "Sets map B to the offset that was found."}));
}

void add_actions_on_files(std::vector<Command>& all) {
  all.push_back(action({"undo", "Undo", "Reverts the last change of a setting."}));
  all.push_back(action({"redo", "Redo", "Repeats the change that was undone."}));
  all.push_back(
      action({"save-session", "Save the session", "The recording's name, all settings and the estimate."},
             {text_of("FILE")}));
  all.push_back(
      action({"copy", "Copy the offset or the point",
              "Copies the place of the inspected point in map B, in metres; without one, the offset "
              "that was changed last, in milliseconds."}));
  all.push_back(
      action({"copy-command", "Copy as command line", "Copies the shell command that makes this picture."}));
  all.push_back(action(
      {"export-picture", "Export the picture",
       "As PNG: everything, or the maps alone; the maps also with a size, such as 3840x2400, with legend "
       "and scale, all points and smooth edges."},
      {text_of("FILE"),
       {.name = "WHAT", .kind = Kind::kChoice, .choices = {"everything", "maps"}, .optional = true},
       {.name = "SIZE", .kind = Kind::kText, .optional = true}}));
  all.push_back(action({"export-cloud", "Export a map's points", "As PCD or PLY, by the file's ending."},
                       {choice_of("MAP", {"a", "b"}), text_of("FILE")}));
  all.push_back(action({"export-curve", "Export the criteria", "As CSV or JSON, by the file's ending."},
                       {text_of("FILE")}));
  all.push_back(action({"export-rig", "Export the rig found",
                        "The rig file with the parts that were solved for beside the offset."},
                       {text_of("FILE")}));
  all.push_back(
      action({"use-rig", "Use the rig found",
              "Writes the rig file and opens the recording with it: the maps are drawn with that rig."},
             {text_of("FILE")}));
  all.push_back(action({"export-report", "Export a report",
                        "Writes one HTML page into a folder: the offset, its evidence and the maps."},
                       {text_of("FOLDER")}));
}

void add_actions_on_windows(std::vector<Command>& all) {
  all.push_back(action({"palette", "All commands", "A searchable list of all commands."}));
  all.push_back(action({"help", "Keys", "The list of keys."}));
  all.push_back(
      action({"dismiss", "Close the front window", "The palette, a dialog, a message, or the tool."}));
  all.push_back(action(
      {"ask", "Ask for a file", "Shows the dialog that asks for a command's file."},
      {choice_of("COMMAND", {"open", "choose", "choose-rig", "choose-poses", "save-session", "export-picture",
                             "export-cloud", "export-curve", "export-rig", "use-rig", "export-report"}),
       {.name = "WHAT",
        .kind = Kind::kChoice,
        .choices = {"a", "b", "everything", "maps"},
        .optional = true}}));
  all.push_back(action({"menu", "Open a menu", "Shows it, for the arrow keys, Enter and Escape."},
                       {choice_of("MENU", {"file", "edit", "offset", "view", "tools", "help"})}));
  all.push_back(
      action({"next-field", "Next field", "Types into the next number; \"back\": into the previous one."},
             {{.name = "WAY", .kind = Kind::kChoice, .choices = {"back"}, .optional = true}}));
  all.push_back(action({"quit", "Quit", "Ends the program."}));
}

}  // namespace

void add_actions(std::vector<Command>& all) {
  add_recordings(all);
  add_actions_of_opening(all);
  add_actions_on_maps(all);
  add_actions_on_files(all);
  add_actions_on_windows(all);
}

}  // namespace sweepscope::ui
