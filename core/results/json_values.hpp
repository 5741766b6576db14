#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/results/fields.hpp"

/// Values of JSON documents, written and read: units, absent values, and what is wrong with a document.
namespace sweepscope::json {

using Json = nlohmann::ordered_json;

/// An instant in a recording, in whole milliseconds.
double to_millisecond(double time_s);
/// Whole numbers, such as counts, without a decimal point.
Json number(double value);
/// Null where there is none.
Json number_or_null(const std::optional<double>& value, double scale = 1);
Json milliseconds_or_null(const std::optional<double>& seconds);
/// To a nanosecond.
Json seconds_or_null(const std::optional<double>& seconds);

/// What is wrong with a document, as a place and a reason. All that follows throws it.
struct BadValue : std::runtime_error {
  using std::runtime_error::runtime_error;
};

const Json& member(const Json& object, const char* key, const std::string& where);

/// `where` is the path of the object, with a point at its end.
template <typename T>
T required(const Json& object, const char* key, const std::string& where = "") {
  try {
    return member(object, key, where).get<T>();
  } catch (const Json::exception&) {
    throw BadValue(where + key + " has the wrong type");
  }
}

std::size_t required_count(const Json& object, const char* key);
/// Absent: missing or null.
std::optional<double> optional_number(const Json& object, const char* key, const std::string& where = "");
/// Empty: missing or null.
std::string optional_text(const Json& object, const char* key);
/// Of milliseconds within 1000 s. Beyond it no clocks lie apart, and a millisecond would lose its last
/// digits.
double seconds(double milliseconds, const std::string& name);
std::optional<double> optional_seconds(const Json& object, const char* key);

}  // namespace sweepscope::json
