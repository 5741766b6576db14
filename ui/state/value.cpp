#include "ui/state/value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace sweepscope::ui {
namespace {

std::string listed(const std::vector<std::string>& choices) {
  std::string text;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ") + choices[i];
  }
  return text;
}

Result<Value> refuse(const Parameter& parameter, std::string_view word) {
  return failure(ExitCode::kWrongUsage,
                 fmt::format("{} must be {}, not \"{}\"", parameter.name, describe(parameter), word));
}

}  // namespace

Result<Value> parse_value(const Parameter& parameter, std::string_view word) {
  switch (parameter.kind) {
    case Kind::kNumber: {
      double number = 0;
      if (word.starts_with('+')) word.remove_prefix(1);
      const auto [after, error] = std::from_chars(word.data(), word.data() + word.size(), number);
      const bool whole = error == std::errc() && after == word.data() + word.size() && std::isfinite(number);
      if (!whole || number < parameter.least || number > parameter.greatest) return refuse(parameter, word);
      return number;
    }
    case Kind::kSwitch:
      if (word != "on" && word != "off") return refuse(parameter, word);
      return word == "on";
    case Kind::kChoice:
      if (std::find(parameter.choices.begin(), parameter.choices.end(), word) == parameter.choices.end())
        return refuse(parameter, word);
      return std::string(word);
    case Kind::kText:
      return std::string(word);
  }
  return refuse(parameter, word);
}

std::string to_word(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* on = std::get_if<bool>(&value)) return *on ? "on" : "off";
  return std::get<std::string>(value);
}

Result<std::vector<std::string>> split_words(std::string_view line) {
  std::vector<std::string> words;
  std::size_t i = 0;
  while (i < line.size()) {
    const char c = line[i];
    if (c == '#') break;
    if (c == ' ' || c == '\t' || c == '\r') {
      ++i;
      continue;
    }
    std::string word;
    if (c == '"') {
      const std::size_t close = line.find('"', i + 1);
      if (close == std::string_view::npos) return failure(ExitCode::kWrongUsage, "A quote is not closed");
      word = line.substr(i + 1, close - i - 1);
      i = close + 1;
    } else {
      const std::size_t end = std::min(line.find_first_of(" \t\r", i), line.size());
      word = line.substr(i, end - i);
      i = end;
    }
    words.push_back(std::move(word));
  }
  return words;
}

std::string quoted(const std::string& word) {
  return word.empty() || word.find_first_of(" \t#") != std::string::npos ? "\"" + word + "\"" : word;
}

std::string describe(const Parameter& parameter) {
  switch (parameter.kind) {
    case Kind::kNumber: {
      const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
      if (parameter.least <= -1e9 && parameter.greatest >= 1e9) return "a number" + unit;
      if (parameter.greatest >= 1e9) return fmt::format("{}{} or more", parameter.least, unit);
      return fmt::format("{} to {}{}", parameter.least, parameter.greatest, unit);
    }
    case Kind::kSwitch:
      return "on or off";
    case Kind::kChoice:
      return listed(parameter.choices);
    case Kind::kText:
      return "text";
  }
  return "";
}

}  // namespace sweepscope::ui
