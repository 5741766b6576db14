#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace sweepscope::ui {

/// Keys, numbered as in GLFW: letters and digits are their ASCII codes.
using Key = int;

enum Modifier : unsigned { kShift = 1, kCtrl = 2, kAlt = 4 };

/// One event, from a person or a script. Positions are in pixels from the top left corner of the drawing, y
/// downwards.
struct InputEvent {
  enum class What { kMove, kButton, kWheel, kKey, kText, kDrop };
  What what = What::kMove;
  double x = 0, y = 0;  // kMove
  int button = 0;       // kButton: 0 left, 1 right, 2 middle
  bool down = false;    // kButton, kKey
  double wheel = 0;     // kWheel: up is positive
  Key key = 0;          // kKey
  unsigned modifiers = 0;
  std::string text = {};  // kText: UTF-8; kDrop: a path

  static InputEvent move(double x, double y) { return {.what = What::kMove, .x = x, .y = y}; }
  static InputEvent press(int button, bool down, unsigned modifiers = 0) {
    return {.what = What::kButton, .button = button, .down = down, .modifiers = modifiers};
  }
  static InputEvent scroll(double wheel) { return {.what = What::kWheel, .wheel = wheel}; }
  static InputEvent stroke(Key key, bool down, unsigned modifiers) {
    return {.what = What::kKey, .down = down, .key = key, .modifiers = modifiers};
  }
  static InputEvent words(std::string text) { return {.what = What::kText, .text = std::move(text)}; }
  static InputEvent drop(std::string path) { return {.what = What::kDrop, .text = std::move(path)}; }
};

/// A key with modifiers, written "Ctrl+Shift+Z".
struct Chord {
  Key key = 0;
  unsigned modifiers = 0;
  bool operator==(const Chord&) const = default;
};
std::optional<Chord> parse_chord(std::string_view text);
std::string to_text(const Chord& chord);

namespace keys {
inline constexpr Key kTab = 258, kEnter = 257, kEscape = 256, kBackspace = 259, kDelete = 261, kRight = 262,
                     kLeft = 263, kDown = 264, kUp = 265, kPageUp = 266, kPageDown = 267, kHome = 268,
                     kEnd = 269, kSpace = 32, kF1 = 290, kF10 = 299;
}  // namespace keys

}  // namespace sweepscope::ui
