#include "core/results/json_values.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sweepscope::json {

double to_millisecond(double time_s) {
  return std::round(time_s * 1e3) / 1e3;
}

Json number(double value) {
  if (value == std::floor(value) && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
  return value;
}

Json number_or_null(const std::optional<double>& value, double scale) {
  return value ? number(*value * scale) : Json(nullptr);
}

Json milliseconds_or_null(const std::optional<double>& seconds) {
  return seconds ? Json(written_ms(*seconds)) : Json(nullptr);
}

Json seconds_or_null(const std::optional<double>& seconds) {
  return seconds ? Json(std::round(*seconds * 1e9) / 1e9) : Json(nullptr);
}

const Json& member(const Json& object, const char* key, const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end()) throw BadValue(where + key + " is missing");
  return *found;
}

std::size_t required_count(const Json& object, const char* key) {
  constexpr std::int64_t kMax = 1'000'000'000'000;
  const auto count = whole_number(member(object, key, ""), 0, kMax);
  if (!count) throw BadValue(fmt::format("{} is not a whole number from 0 to {}", key, kMax));
  return static_cast<std::size_t>(*count);
}

std::optional<double> optional_number(const Json& object, const char* key, const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return std::nullopt;
  if (!found->is_number()) throw BadValue(where + key + " is neither a number nor null");
  return found->get<double>();
}

std::string optional_text(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return {};
  if (!found->is_string()) throw BadValue(std::string(key) + " is neither text nor null");
  return found->get<std::string>();
}

double seconds(double milliseconds, const std::string& name) {
  if (!(std::abs(milliseconds) <= 1e6)) throw BadValue(name + " lies beyond 1000 s");
  return milliseconds / 1e3;
}

std::optional<double> optional_seconds(const Json& object, const char* key) {
  const auto milliseconds = optional_number(object, key);
  return milliseconds ? std::optional(seconds(*milliseconds, key)) : std::nullopt;
}

}  // namespace sweepscope::json
