#pragma once

#include <fmt/format.h>

#include <concepts>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include "core/io/printable_text.hpp"

namespace sweepscope::app {

/// A value to print; characters of a text that control a terminal are escaped.
template <typename T>
decltype(auto) printable(T&& value) {
  if constexpr (std::convertible_to<T, std::string_view>)
    return printable_message(std::forward<T>(value));
  else
    return std::forward<T>(value);
}

template <typename T>
using Printable = decltype(printable(std::declval<T>()));

/// The unchanged format, filled with printable values.
template <typename... T>
std::string printable_words(fmt::format_string<Printable<T>...> format, T&&... values) {
  return fmt::vformat(format, fmt::make_format_args(printable(std::forward<T>(values))...));
}

/// Prints a text for a person on stderr, made printable. A closed or full stderr is not an error.
template <typename... T>
void say(fmt::format_string<Printable<T>...> format, T&&... values) {
  const std::string text = printable_words<T...>(format, std::forward<T>(values)...);
  std::fwrite(text.data(), 1, text.size(), stderr);
}

/// Prints a part of a command's result on stdout, made printable. Throws if it cannot be written.
template <typename... T>
void print(fmt::format_string<Printable<T>...> format, T&&... values) {
  fmt::print("{}", printable_words<T...>(format, std::forward<T>(values)...));
}

}  // namespace sweepscope::app
