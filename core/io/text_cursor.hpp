#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>

namespace sweepscope {

/// Reads a text in memory by lines or by words, never past its end.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text) : text_(text) {}

  /// The next line without its line end, or nothing at the end of the text.
  std::optional<std::string_view> next_line() {
    if (position_ >= text_.size()) return std::nullopt;
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    std::string_view line = text_.substr(position_, end - position_);
    position_ = std::min(end + 1, text_.size());
    ++line_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }

  /// The next word between blanks and line ends, or nothing at the end of the text.
  std::optional<std::string_view> next_word() {
    constexpr std::string_view kBlanks = " \t\r\n";
    const std::size_t begin = text_.find_first_not_of(kBlanks, position_);
    if (begin == std::string_view::npos) return std::nullopt;
    const std::size_t end = std::min(text_.find_first_of(kBlanks, begin), text_.size());
    position_ = end;
    return text_.substr(begin, end - begin);
  }

  /// The next word as a number (also nan and inf); nothing at the end of the text or if it is not a number.
  std::optional<double> next_number() {
    const auto word = next_word();
    if (!word) return std::nullopt;
    double number = 0;
    const auto [end, error] = std::from_chars(word->data(), word->data() + word->size(), number);
    if (error != std::errc() || end != word->data() + word->size()) return std::nullopt;
    return number;
  }

  std::size_t position() const { return position_; }  // in bytes from the text's beginning
  std::size_t line() const { return line_; }          // lines taken so far: the number of the last one

 private:
  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t line_ = 0;
};

}  // namespace sweepscope
