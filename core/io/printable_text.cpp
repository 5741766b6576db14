#include "core/io/printable_text.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>

namespace sweepscope {
namespace {

struct CodePoint {
  char32_t value = 0;
  std::size_t bytes = 0;  // 0: the text does not begin with valid UTF-8
};

/// The first code point of a text that is not empty. Overlong forms, surrogates and what lies beyond U+10FFFF
/// are no UTF-8.
CodePoint first_code_point(std::string_view text) {
  constexpr std::array<char32_t, 5> kMin{0, 0, 0x80, 0x800, 0x10000};
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xF8 ? 0 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 0;
  if (bytes == 0 || bytes > text.size()) return {};
  char32_t value = lead & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return {};
    value = value << 6 | (byte(i) & 0x3FU);
  }
  const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
  if (value < kMin[bytes] || surrogate || value > 0x10FFFF) return {};
  return {value, bytes};
}

bool is_control(char32_t c) {
  const bool ascii = c < 0x20 || c == 0x7F, c1 = c >= 0x80 && c <= 0x9F;
  const bool turns = c == 0x061C || c == 0x200E || c == 0x200F || (c >= 0x202A && c <= 0x202E) ||
                     (c >= 0x2066 && c <= 0x2069);
  const bool breaks = c == 0x2028 || c == 0x2029;
  const bool no_character = c == 0xFFFE || c == 0xFFFF;
  return ascii || c1 || turns || breaks || no_character;
}

std::string byte_escape(char byte) {
  return fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
}

/// `rest` begins with the control character.
std::string escape_of(CodePoint control, std::string_view rest) {
  if (control.value < 0x80) return byte_escape(rest.front());
  return fmt::format("\\u{{{:04x}}}", static_cast<std::uint32_t>(control.value));
}

/// `escape(control, rest)`: what stands for the control character that `rest` begins with.
template <typename Escape>
std::string escaped(std::string_view text, const Escape& escape) {
  std::string out;
  while (!text.empty()) {
    const CodePoint first = first_code_point(text);
    const std::size_t bytes = first.bytes == 0 ? 1 : first.bytes;
    if (first.bytes == 0)
      out += byte_escape(text.front());
    else if (is_control(first.value))
      out += escape(first, text);
    else
      out += text.substr(0, bytes);
    text.remove_prefix(bytes);
  }
  return out;
}

using Json = nlohmann::ordered_json;

void make_valid(Json& json) {
  if (json.is_string()) json = valid_utf8(json.get_ref<const std::string&>());
  if (!json.is_structured()) return;
  for (Json& member : json) make_valid(member);
}

}  // namespace

std::string printable_line(std::string_view text) {
  return escaped(text, escape_of);
}

std::string printable_text(std::string_view text) {
  return escaped(text, [](CodePoint control, std::string_view rest) {
    return control.value == '\n' ? std::string("\n") : escape_of(control, rest);
  });
}

std::string printable_message(std::string_view text) {
  return escaped(text, [](CodePoint control, std::string_view rest) {
    return rest.starts_with("\n  ") ? std::string("\n") : escape_of(control, rest);
  });
}

std::string valid_utf8(std::string_view text) {
  return escaped(text, [](CodePoint control, std::string_view rest) {
    return std::string(rest.substr(0, control.bytes));
  });
}

std::string shell_word(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./:,=+%@";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

std::string markup_escaped(std::string_view printable) {
  std::string out;
  for (const char c : printable) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string markup_line(std::string_view text) {
  return markup_escaped(printable_line(text));
}

std::string json_text(Json document) {
  make_valid(document);
  // Names of members are the program's own, but for those of a file that is passed on.
  const std::string text = document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  return escaped(text, [](CodePoint control, std::string_view) {
    if (control.value == '\n') return std::string("\n");
    return fmt::format("\\u{:04x}", static_cast<std::uint32_t>(control.value));
  });
}

std::string json_string(std::string_view text) {
  std::string quoted = json_text(std::string(text));
  quoted.pop_back();  // the line end
  return quoted;
}

}  // namespace sweepscope
