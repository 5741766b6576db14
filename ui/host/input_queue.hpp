#pragma once

#include <span>
#include <vector>

#include "ui/host/input.hpp"

namespace sweepscope::ui {

/// Input that waits for its frame. Text typed in a row is one frame's; a press and a release of a mouse
/// button or of a key that edits need a frame each, and what is typed after something that moves the focus
/// waits until the field has it: so text arrives whole, in order, and in the field that it was meant for.
class InputQueue {
 public:
  void add(std::span<const InputEvent> events);
  /// The events of the next frame, perhaps none yet.
  std::vector<InputEvent> take(bool space_presses = false);
  bool empty() const { return waiting_.empty(); }

 private:
  std::vector<InputEvent> waiting_;
  int frames_to_focus_ = 0;
};

/// How many of the events fit into one frame.
std::size_t events_of_next_frame(std::span<const InputEvent> events, bool space_presses = false);

}  // namespace sweepscope::ui
