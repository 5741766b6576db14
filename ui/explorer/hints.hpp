#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/offset/estimate.hpp"

namespace sweepscope::ui {

class Explorer;
struct Pane;

/// A message of the engine as a window shows it: without options of the command line, which stand in
/// parentheses.
std::string without_options(std::string text);
/// A remark of the engine for a window: without command-line words, from a capital to a full stop.
std::string sentence(const std::string& text);

/// What may help with something that is wrong: a button and its command.
struct Hint {
  std::string title, line;

  bool operator==(const Hint&) const = default;
};

/// The longest part in which the rig was stationary, of a whole recording in which it moved; absent if there
/// is none, or if only a part of the recording is open.
std::optional<RecordingPart> stationary_part(const Explorer& explorer);

/// What helps where an offset was refused, or is given with warnings; each command once.
std::vector<Hint> hints_for(const Explorer& explorer, const Estimate& estimate);
/// What helps with these remarks of the engine.
std::vector<Hint> hints_for(const Explorer& explorer, const std::vector<std::string>& remarks);

/// Why a pane shows no points, and what may help; no words where it shows some.
struct EmptyPane {
  std::string why;
  std::vector<Hint> hints;
};
EmptyPane empty_pane(const Explorer& explorer, const Pane& pane);

}  // namespace sweepscope::ui
