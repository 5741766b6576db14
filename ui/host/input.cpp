#include "ui/host/input.hpp"

#include <array>

namespace sweepscope::ui {
namespace {

struct Named {
  std::string_view name;
  Key key;
};
constexpr std::array kNamed{Named{"Space", keys::kSpace},
                            Named{"Comma", ','},
                            Named{"Minus", '-'},
                            Named{"Period", '.'},
                            Named{"Plus", '='},
                            Named{"Escape", keys::kEscape},
                            Named{"Enter", keys::kEnter},
                            Named{"Tab", keys::kTab},
                            Named{"Backspace", keys::kBackspace},
                            Named{"Delete", keys::kDelete},
                            Named{"Right", keys::kRight},
                            Named{"Left", keys::kLeft},
                            Named{"Down", keys::kDown},
                            Named{"Up", keys::kUp},
                            Named{"PageUp", keys::kPageUp},
                            Named{"PageDown", keys::kPageDown},
                            Named{"Home", keys::kHome},
                            Named{"End", keys::kEnd},
                            Named{"F1", keys::kF1},
                            Named{"F10", keys::kF10},
                            Named{"?", '?'}};

struct NamedModifier {
  std::string_view name;
  unsigned bit;
};
constexpr std::array kModifiers{NamedModifier{"Ctrl", kCtrl}, NamedModifier{"Shift", kShift},
                                NamedModifier{"Alt", kAlt}};

bool is_letter_or_digit(int c) {
  return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

}  // namespace

std::optional<Chord> parse_chord(std::string_view text) {
  Chord chord;
  bool found = true;
  while (found) {
    found = false;
    for (const NamedModifier& modifier : kModifiers) {
      if (!text.starts_with(modifier.name) || text.substr(modifier.name.size()).substr(0, 1) != "+") continue;
      chord.modifiers |= modifier.bit;
      text.remove_prefix(modifier.name.size() + 1);
      found = true;
    }
  }
  if (text.size() == 1 && is_letter_or_digit(text[0])) {
    chord.key = static_cast<unsigned char>(text[0]);
    return chord;
  }
  for (const Named& named : kNamed) {
    if (text != named.name) continue;
    chord.key = named.key;
    return chord;
  }
  return std::nullopt;
}

std::string to_text(const Chord& chord) {
  std::string text;
  for (const NamedModifier& modifier : kModifiers) {
    if ((chord.modifiers & modifier.bit) != 0) text += std::string(modifier.name) + "+";
  }
  if (is_letter_or_digit(chord.key)) return text + static_cast<char>(chord.key);
  for (const Named& named : kNamed) {
    if (named.key == chord.key) return text + std::string(named.name);
  }
  return text + "?";
}

}  // namespace sweepscope::ui
