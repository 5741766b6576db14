#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace sweepscope::screenshots {

/// A picture that is held to its baseline, screenshots/NAME.png.
struct Screenshot {
  std::string command;  // what is typed after `sweepscope`, in the folder of inputs; it writes {out}
  std::string made;     // instead of a command: a picture that the preparation left in that folder
  int width_px = 0, height_px = 0;
};

/// A picture that must not pass: a command that is spoiled on purpose, against the baseline of the right one.
struct Control {
  std::string of;           // the screenshot
  std::string replace, by;  // in its command; by may be nothing
};

/// screenshots/manifest.yaml. In commands, {out} stands for the picture.
struct Manifest {
  std::vector<std::string> preparation;  // commands that make the inputs, once per run of the tests
  std::map<std::string, Screenshot> pictures;
  std::map<std::string, Control> controls;
  std::set<std::string> other_files;  // files of the baselines' folder that are no baselines
};

/// Unknown keys, sizes that are none, and controls of nothing are refused with line and column.
Result<Manifest> read_manifest(const std::filesystem::path& path);

}  // namespace sweepscope::screenshots
