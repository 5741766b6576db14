#include "ui/host/input_queue.hpp"

#include <algorithm>

namespace sweepscope::ui {
namespace {

using What = InputEvent::What;

/// ImGui gives the focus a frame after it was asked for, and takes text a frame after that.
constexpr int kFramesToFocus = 3;

bool is_chord(const InputEvent& event) {
  return event.what == What::kKey && (event.modifiers & (kCtrl | kAlt)) != 0;
}

bool is_function_key(Key key) {
  return key >= keys::kF1 && key < keys::kF1 + 25;
}

/// A key that does something in a field, rather than a letter whose text comes as an event of its own, or
/// Shift.
bool edits(const InputEvent& event) {
  const bool named = event.key >= keys::kEscape && event.key <= keys::kEnd;
  return event.what == What::kKey && (named || is_function_key(event.key) || is_chord(event));
}

bool types(const InputEvent& event) {
  return event.what == What::kText || (event.what == What::kKey && event.down);
}

/// After it another field may have the focus, or none.
bool moves_focus(const InputEvent& event) {
  if (event.what == What::kButton) return true;
  const bool key = event.key == keys::kTab || event.key == keys::kEnter || event.key == keys::kEscape ||
                   is_function_key(event.key);
  return event.what == What::kKey && event.down && (key || is_chord(event));
}

bool needs_own_frame(const InputEvent& earlier, const InputEvent& later, bool space_presses) {
  if (moves_focus(earlier) && types(later)) return true;
  switch (earlier.what) {
    case What::kButton:
      return later.what == What::kButton || later.what == What::kMove;
    case What::kMove:
      // ImGui ends a drag in the frame of the release, whatever the move before it: it would stop short.
      return later.what == What::kMove || (later.what == What::kButton && !later.down);
    case What::kKey:
      // ImGui takes a frame's text before its keys, and none while Ctrl is down.
      if (later.what == What::kText) return is_chord(earlier) || (edits(earlier) && earlier.down);
      return (edits(earlier) || (space_presses && earlier.key == keys::kSpace)) && later.what == What::kKey &&
             later.key == earlier.key;
    case What::kText:
      return later.what == What::kButton || is_chord(later);
    default:
      return false;
  }
}

}  // namespace

std::size_t events_of_next_frame(std::span<const InputEvent> events, bool space_presses) {
  for (std::size_t i = 1; i < events.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (needs_own_frame(events[j], events[i], space_presses)) return i;
    }
  }
  return events.size();
}

void InputQueue::add(std::span<const InputEvent> events) {
  waiting_.insert(waiting_.end(), events.begin(), events.end());
}

std::vector<InputEvent> InputQueue::take(bool space_presses) {
  const bool focused = frames_to_focus_ <= 0;
  frames_to_focus_ = std::max(0, frames_to_focus_ - 1);
  const auto held = focused ? waiting_.end() : std::find_if(waiting_.begin(), waiting_.end(), types);
  const auto count =
      static_cast<std::ptrdiff_t>(events_of_next_frame({waiting_.begin(), held}, space_presses));
  std::vector<InputEvent> now(waiting_.begin(), waiting_.begin() + count);
  waiting_.erase(waiting_.begin(), waiting_.begin() + count);
  if (std::any_of(now.begin(), now.end(), moves_focus)) frames_to_focus_ = kFramesToFocus;
  return now;
}

}  // namespace sweepscope::ui
