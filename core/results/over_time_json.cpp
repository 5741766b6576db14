#include "core/results/over_time_json.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/results/json_values.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

/// The windows of an offset over time; a gap has null, and why.
Json windows_to_json(const std::vector<OffsetWindow>& windows) {
  Json list = Json::array();
  for (const OffsetWindow& window : windows) {
    Json object{{"t_s", json::to_millisecond(window.time_s)},
                {"offset_ms", json::milliseconds_or_null(window.offset_s)},
                {"sigma_ms", json::milliseconds_or_null(window.sigma_s)},
                {"from_s", json::to_millisecond(window.begin_s)},
                {"to_s", json::to_millisecond(window.end_s)}};
    if (!window.offset_s) object["reason"] = window.reason;
    list.push_back(std::move(object));
  }
  return list;
}

double to_ppm(double rate) {
  return std::round(rate * 1e12) / 1e6;
}

}  // namespace

void write_over_time(const OffsetOverTime& over_time, Json& document) {
  document["over_time"] = windows_to_json(over_time.windows);
  const auto& course = over_time.course;
  document["middle_s"] = course ? Json(json::to_millisecond(course->middle_s)) : Json(nullptr);
  document["rate_ppm"] = course ? Json(to_ppm(course->rate)) : Json(nullptr);
  document["rate_sigma_ppm"] = course ? Json(to_ppm(course->rate_sigma)) : Json(nullptr);
  document["scatter"] = course ? Json(course->scatter) : Json(nullptr);
  document["jumps"] = Json::array();
  if (!course) return;
  for (const OffsetJump& jump : course->jumps)
    document["jumps"].push_back({{"from_s", json::to_millisecond(jump.begin_s)},
                                 {"to_s", json::to_millisecond(jump.end_s)},
                                 {"jump_ms", written_ms(jump.size_s)},
                                 {"sigma_ms", written_ms(jump.sigma_s)}});
}

namespace {

std::vector<OffsetWindow> windows_from_json(const Json& list) {
  if (!list.is_array()) throw json::BadValue("over_time is not a list");
  std::vector<OffsetWindow> windows;
  for (const Json& object : list) {
    const std::string where = fmt::format("over_time[{}].", windows.size());
    if (!object.is_object()) throw json::BadValue(where + " is not an object");
    OffsetWindow window;
    window.time_s = json::required<double>(object, "t_s", where);
    window.begin_s = json::optional_number(object, "from_s", where).value_or(window.time_s);
    window.end_s = json::optional_number(object, "to_s", where).value_or(window.time_s);
    const auto offset_ms = json::optional_number(object, "offset_ms", where);
    const auto sigma_ms = json::optional_number(object, "sigma_ms", where);
    if (offset_ms && sigma_ms) {
      window.offset_s = json::seconds(*offset_ms, where + "offset_ms");
      window.sigma_s = json::seconds(*sigma_ms, where + "sigma_ms");
    }
    window.reason = json::optional_text(object, "reason");
    windows.push_back(std::move(window));
  }
  return windows;
}

}  // namespace

std::optional<OffsetOverTime> over_time_from_json(const Json& document) {
  const auto found = document.find("over_time");
  if (found == document.end() || found->is_null()) return std::nullopt;
  OffsetOverTime over_time{windows_from_json(*found), {}};
  const auto offset_ms = json::optional_number(document, "offset_ms");
  if (!offset_ms || !json::optional_number(document, "middle_s")) return over_time;
  OffsetCourse course;
  course.middle_s = json::required<double>(document, "middle_s");
  course.offset_s = json::seconds(*offset_ms, "offset_ms");
  course.sigma_s = json::seconds(json::optional_number(document, "sigma_ms").value_or(0), "sigma_ms");
  course.rate = json::required<double>(document, "rate_ppm") / 1e6;
  course.rate_sigma = json::required<double>(document, "rate_sigma_ppm") / 1e6;
  course.scatter = json::optional_number(document, "scatter").value_or(1);
  const Json& jumps = json::member(document, "jumps", "");
  if (!jumps.is_array()) throw json::BadValue("jumps is not a list");
  for (const Json& object : jumps) {
    if (!object.is_object()) throw json::BadValue("a jump is not an object");
    course.jumps.push_back({json::required<double>(object, "from_s", "jumps."),
                            json::required<double>(object, "to_s", "jumps."),
                            json::seconds(json::required<double>(object, "jump_ms", "jumps."), "jump_ms"),
                            json::seconds(json::required<double>(object, "sigma_ms", "jumps."), "sigma_ms")});
  }
  for (const OffsetWindow& window : over_time.windows) course.windows += window.offset_s ? 1 : 0;
  over_time.course = std::move(course);
  return over_time;
}

}  // namespace sweepscope
