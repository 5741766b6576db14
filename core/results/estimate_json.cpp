#include "core/results/estimate_json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/io/atomic_file.hpp"
#include "core/io/printable_text.hpp"
#include "core/numbers.hpp"
#include "core/results/fields.hpp"
#include "core/results/rig_json.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kEstimateSchema = "sweepscope.estimate/1";

// Of an instant in a recording.
double to_millisecond(double time_s) {
  return std::round(time_s * 1e3) / 1e3;
}

/// Whole numbers, such as counts, without a decimal point.
Json number(double value) {
  if (value == std::floor(value) && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
  return value;
}

Json number_or_null(const std::optional<double>& value) {
  return value ? number(*value) : Json(nullptr);
}

Json milliseconds_or_null(const std::optional<double>& seconds) {
  return seconds ? Json(written_ms(*seconds)) : Json(nullptr);
}

Json curve_to_json(const std::vector<CurvePoint>& curve) {
  Json points = Json::array();
  for (const CurvePoint& point : curve) {
    Json object;
    object["offset_ms"] = written_ms(point.offset_s);
    for (const CurveColumn& column : kCurveColumns) object[column.key] = number_or_null(point.*column.value);
    points.push_back(std::move(object));
  }
  return points;
}

constexpr std::array kMethodNames{"direct", "stationary", "moving"};  // by Method
constexpr std::array kKindNames{"stationary", "moving"};              // by RigKind

/// What is wrong with a document, as a place and a reason.
struct BadValue : std::runtime_error {
  using std::runtime_error::runtime_error;
};

const Json& member(const Json& object, const char* key, const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end()) throw BadValue(where + key + " is missing");
  return *found;
}

template <typename T>
T required(const Json& object, const char* key, const std::string& where = "") {
  try {
    return member(object, key, where).get<T>();
  } catch (const Json::exception&) {
    throw BadValue(where + key + " has the wrong type");
  }
}

/// The value of an enum whose names are these.
template <typename T>
T named(const std::string& name, const auto& names, const char* key) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw BadValue(fmt::format("{} is not one of {}", key, fmt::join(names, ", ")));
  return static_cast<T>(found - names.begin());
}

std::size_t required_count(const Json& object, const char* key) {
  constexpr std::int64_t kMax = 1'000'000'000'000;
  const auto count = whole_number(member(object, key, ""), 0, kMax);
  if (!count) throw BadValue(fmt::format("{} is not a whole number from 0 to {}", key, kMax));
  return static_cast<std::size_t>(*count);
}

std::optional<double> optional_number(const Json& object, const char* key, const std::string& where = "") {
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

/// Beyond a thousand seconds no clocks lie apart, and a millisecond would lose its last digits.
double seconds(double milliseconds, const std::string& name) {
  if (!(std::abs(milliseconds) <= 1e6)) throw BadValue(name + " lies beyond 1000 s");
  return milliseconds / 1e3;
}

std::optional<double> optional_seconds(const Json& object, const char* key) {
  const auto milliseconds = optional_number(object, key);
  return milliseconds ? std::optional(seconds(*milliseconds, key)) : std::nullopt;
}

std::vector<CurvePoint> curve_from_json(const Json& curve) {
  if (!curve.is_array()) throw BadValue("curve is not a list");
  std::vector<CurvePoint> points;
  for (const Json& object : curve) {
    const std::string where = fmt::format("curve[{}].", points.size());
    CurvePoint point;
    if (!object.is_object()) throw BadValue(where + " is not an object");
    point.offset_s = seconds(required<double>(object, "offset_ms", where), where + "offset_ms");
    for (const CurveColumn& column : kCurveColumns)
      point.*column.value = optional_number(object, column.key, where);
    points.push_back(point);
  }
  return points;
}

/// To a nanosecond.
Json seconds_or_null(const std::optional<double>& seconds) {
  return seconds ? Json(std::round(*seconds * 1e9) / 1e9) : Json(nullptr);
}

Json sigma_parts_to_json(const Estimate& estimate) {
  Json parts;
  for (const SigmaPart& part : estimate.sigma_parts) parts[part.name + "_ms"] = written_ms(part.sigma_s);
  return parts;
}

/// What play and a tilted mount would add, per degree.
Json rig_effects_to_json(const RigEffects& effects) {
  return {
      {"play_ms_per_deg", written_ms(effects.play_s_rad * kRadPerDeg)},
      {"mount_tilt_ms_per_deg",
       effects.mount_tilt_s_rad ? Json(written_ms(*effects.mount_tilt_s_rad * kRadPerDeg)) : Json(nullptr)}};
}

/// The windows of an offset over time; a gap has null, and why.
Json windows_to_json(const std::vector<OffsetWindow>& windows) {
  Json list = Json::array();
  for (const OffsetWindow& window : windows) {
    Json object{{"t_s", to_millisecond(window.time_s)},
                {"offset_ms", milliseconds_or_null(window.offset_s)},
                {"sigma_ms", milliseconds_or_null(window.sigma_s)},
                {"from_s", to_millisecond(window.begin_s)},
                {"to_s", to_millisecond(window.end_s)}};
    if (!window.offset_s) object["reason"] = window.reason;
    list.push_back(std::move(object));
  }
  return list;
}

double to_ppm(double rate) {
  return std::round(rate * 1e12) / 1e6;
}

void write_over_time(const OffsetOverTime& over_time, Json& document) {
  document["over_time"] = windows_to_json(over_time.windows);
  const auto& course = over_time.course;
  document["middle_s"] = course ? Json(to_millisecond(course->middle_s)) : Json(nullptr);
  document["rate_ppm"] = course ? Json(to_ppm(course->rate)) : Json(nullptr);
  document["rate_sigma_ppm"] = course ? Json(to_ppm(course->rate_sigma)) : Json(nullptr);
  document["scatter"] = course ? Json(course->scatter) : Json(nullptr);
  document["jumps"] = Json::array();
  if (!course) return;
  for (const OffsetJump& jump : course->jumps)
    document["jumps"].push_back({{"from_s", to_millisecond(jump.begin_s)},
                                 {"to_s", to_millisecond(jump.end_s)},
                                 {"jump_ms", written_ms(jump.size_s)},
                                 {"sigma_ms", written_ms(jump.sigma_s)}});
}

std::vector<OffsetWindow> windows_from_json(const Json& list) {
  if (!list.is_array()) throw BadValue("over_time is not a list");
  std::vector<OffsetWindow> windows;
  for (const Json& object : list) {
    const std::string where = fmt::format("over_time[{}].", windows.size());
    if (!object.is_object()) throw BadValue(where + " is not an object");
    OffsetWindow window;
    window.time_s = required<double>(object, "t_s", where);
    window.begin_s = optional_number(object, "from_s", where).value_or(window.time_s);
    window.end_s = optional_number(object, "to_s", where).value_or(window.time_s);
    const auto offset_ms = optional_number(object, "offset_ms", where);
    const auto sigma_ms = optional_number(object, "sigma_ms", where);
    if (offset_ms && sigma_ms) {
      window.offset_s = seconds(*offset_ms, where + "offset_ms");
      window.sigma_s = seconds(*sigma_ms, where + "sigma_ms");
    }
    window.reason = optional_text(object, "reason");
    windows.push_back(std::move(window));
  }
  return windows;
}

std::optional<OffsetOverTime> over_time_from_json(const Json& document) {
  const auto found = document.find("over_time");
  if (found == document.end() || found->is_null()) return std::nullopt;
  OffsetOverTime over_time{windows_from_json(*found), {}};
  const auto offset_ms = optional_number(document, "offset_ms");
  if (!offset_ms || !optional_number(document, "middle_s")) return over_time;
  OffsetCourse course;
  course.middle_s = required<double>(document, "middle_s");
  course.offset_s = seconds(*offset_ms, "offset_ms");
  course.sigma_s = seconds(optional_number(document, "sigma_ms").value_or(0), "sigma_ms");
  course.rate = required<double>(document, "rate_ppm") / 1e6;
  course.rate_sigma = required<double>(document, "rate_sigma_ppm") / 1e6;
  course.scatter = optional_number(document, "scatter").value_or(1);
  const Json& jumps = member(document, "jumps", "");
  if (!jumps.is_array()) throw BadValue("jumps is not a list");
  for (const Json& object : jumps) {
    if (!object.is_object()) throw BadValue("a jump is not an object");
    course.jumps.push_back({required<double>(object, "from_s", "jumps."),
                            required<double>(object, "to_s", "jumps."),
                            seconds(required<double>(object, "jump_ms", "jumps."), "jump_ms"),
                            seconds(required<double>(object, "sigma_ms", "jumps."), "sigma_ms")});
  }
  for (const OffsetWindow& window : over_time.windows) course.windows += window.offset_s ? 1 : 0;
  over_time.course = std::move(course);
  return over_time;
}

Json sample_to_json(const SweepSample& sample) {
  return {{"groups", sample.groups}, {"sweeps", sample.sweeps}, {"of_sweeps", sample.of_sweeps}};
}

std::optional<SweepSample> sample_from_json(const Json& document) {
  const auto found = document.find("sample");
  if (found == document.end() || found->is_null()) return std::nullopt;
  if (!found->is_object()) throw BadValue("sample is not an object");
  return SweepSample{required_count(*found, "groups"), required_count(*found, "sweeps"),
                     required_count(*found, "of_sweeps")};
}

/// "poses": a file, or a topic of odometry or of an IMU.
Json motion_to_json(const UsedMotion& motion) {
  Json object;
  if (motion.kind == UsedMotion::Kind::kPoses) {
    object["file"] = motion.name;
  } else {
    object["topic"] = motion.name;
    object["type"] = motion.kind == UsedMotion::Kind::kOdometry ? "odometry" : "imu";
  }
  object["as"] = motion.trusted ? "truth" : "prior";
  object["time_shift_s"] = seconds_or_null(motion.time_shift_s);
  object["time_shift_sigma_s"] = seconds_or_null(motion.time_shift_sigma_s);
  return object;
}

std::optional<UsedMotion> motion_from_json(const Json& document) {
  const auto found = document.find("poses");
  if (found == document.end() || found->is_null()) return std::nullopt;
  if (!found->is_object()) throw BadValue("poses is not an object");
  UsedMotion motion;
  const std::string type = optional_text(*found, "type");
  if (found->contains("file"))
    motion.name = required<std::string>(*found, "file", "poses.");
  else
    motion.name = required<std::string>(*found, "topic", "poses.");
  if (!type.empty()) motion.kind = type == "imu" ? UsedMotion::Kind::kImu : UsedMotion::Kind::kOdometry;
  motion.trusted = required<std::string>(*found, "as", "poses.") == "truth";
  motion.time_shift_s = optional_number(*found, "time_shift_s", "poses.");
  motion.time_shift_sigma_s = optional_number(*found, "time_shift_sigma_s", "poses.");
  return motion;
}

Json fit_to_json(const FitEvidence& fit) {
  return {{"converged", fit.converged},
          {"iterations", fit.iterations},
          {"features", fit.features},
          {"matches", fit.matches},
          {"residual_m", number(fit.residual_m)},
          {"lever_m", number(fit.lever_m)},
          {"reach_m", number(fit.reach_m)}};
}

std::optional<FitEvidence> fit_from_json(const Json& document) {
  constexpr std::int64_t kMaxIterations = 1'000'000;
  const auto found = document.find("fit");
  if (found == document.end() || found->is_null()) return std::nullopt;
  if (!found->is_object()) throw BadValue("fit is not an object");
  FitEvidence fit;
  fit.converged = required<bool>(*found, "converged", "fit.");
  const auto iterations = whole_number(member(*found, "iterations", "fit."), 0, kMaxIterations);
  if (!iterations) throw BadValue("fit.iterations is not a whole number");
  fit.iterations = static_cast<int>(*iterations);
  fit.features = required_count(*found, "features");
  fit.matches = required_count(*found, "matches");
  fit.residual_m = required<double>(*found, "residual_m", "fit.");
  fit.lever_m = required<double>(*found, "lever_m", "fit.");
  fit.reach_m = required<double>(*found, "reach_m", "fit.");
  return fit;
}

Json number_or_none(const std::optional<double>& value, double scale = 1) {
  return value ? number(*value * scale) : Json(nullptr);
}

/// "recordings", and how they agree.
void write_together(const Together& together, Json& document) {
  document["recordings"] = Json::array();
  for (const RecordingOfRig& recording : together.recordings)
    document["recordings"].push_back(
        {{"recording", recording.recording},
         {"offset_ms", milliseconds_or_null(recording.offset_s)},
         {"sigma_ms", milliseconds_or_null(recording.sigma_s)},
         {"share", number(recording.share)},
         {"turn_sigma_deg", number_or_none(recording.turn_sigma_rad, kDegPerRad)},
         {"shift_sigma_m", number_or_none(recording.shift_sigma_m)},
         {"residual_before_m", number_or_none(recording.residual_before_m)},
         {"residual_after_m", number_or_none(recording.residual_after_m)},
         {"reasons", recording.reasons}});
  document["offsets"] = together.own_offsets ? "each" : "one";
  document["chi_square"] = number(together.chi_square);
  document["degrees_of_freedom"] = together.degrees_of_freedom;
}

std::vector<CriterionOptimum> criteria_from_json(const Json& criteria) {
  if (!criteria.is_object()) throw BadValue("criteria is not an object");
  std::vector<CriterionOptimum> optima;
  for (const auto& [key, object] : criteria.items()) {
    const std::string where = fmt::format("criteria.{}.", key);
    if (!object.is_object()) throw BadValue(where + " is not an object");
    optima.push_back({key, seconds(required<double>(object, "offset_ms", where), where + "offset_ms"),
                      required<double>(object, "value", where)});
  }
  return optima;
}

// Older documents have none.
std::vector<Interval> intervals_from_json(const Json& document, const char* key) {
  if (!document.contains(key)) return {};
  std::vector<Interval> intervals;
  for (const auto& [begin_s, end_s] : required<std::vector<std::array<double, 2>>>(document, key))
    intervals.push_back({begin_s, end_s});
  return intervals;
}

Refusals refusals_from_json(const Json& document) {
  const auto texts = required<std::vector<std::string>>(document, "reasons");
  // Estimates of versions before 0.3 have none.
  const auto codes = document.contains("reason_codes")
                         ? required<std::vector<std::string>>(document, "reason_codes")
                         : std::vector<std::string>();
  Refusals refusals;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const RefusalKind kind = i < codes.size() ? refusal_kind_of(codes[i]) : RefusalKind::kUnknown;
    refusals.push_back({kind, std::nullopt, std::nullopt, texts[i]});
  }
  return refusals;
}

Estimate estimate_from_json(const Json& document) {
  if (!document.is_object()) throw BadValue("it is not a JSON object");
  if (required<std::string>(document, "schema") != kEstimateSchema) {
    throw BadValue(fmt::format("schema is not {}", kEstimateSchema));
  }
  Estimate estimate;
  estimate.recording = required<std::string>(document, "recording");
  estimate.method = named<Method>(required<std::string>(document, "method"), kMethodNames, "method");
  estimate.identifiable = required<bool>(document, "identifiable");
  estimate.offset_s = optional_seconds(document, "offset_ms");
  estimate.sigma_s = optional_seconds(document, "sigma_ms");
  estimate.drift_ppm = optional_number(document, "drift_ppm");
  if (const std::string kind = optional_text(document, "kind"); !kind.empty())
    estimate.kind = named<RigKind>(kind, kKindNames, "kind");
  estimate.kind_reason = optional_text(document, "kind_reason");
  estimate.over_time = over_time_from_json(document);
  estimate.sample = sample_from_json(document);
  if (document.contains("window_s")) {
    const auto [begin_s, end_s] = required<std::array<double, 2>>(document, "window_s");
    estimate.stationary_part = RecordingPart{begin_s, end_s};
  }
  estimate.lost = intervals_from_json(document, "lost_s");
  estimate.motion = motion_from_json(document);
  estimate.fit = fit_from_json(document);
  if (const auto parameters = document.find("parameters"); parameters != document.end())
    if (auto solved = solved_rig_of(*parameters))
      estimate.rig = std::make_shared<const SolvedRig>(std::move(*solved));
  estimate.warnings = required<std::vector<std::string>>(document, "warnings");
  if (document.contains("readings")) estimate.readings = readings_of(document["readings"]);
  estimate.refusals = refusals_from_json(document);
  estimate.criteria = criteria_from_json(member(document, "criteria", ""));
  estimate.curve = curve_from_json(member(document, "curve", ""));
  estimate.sweeps = required_count(document, "sweeps");
  estimate.scans = required_count(document, "scans");
  estimate.cpu_s = optional_number(document, "cpu_s").value_or(0);
  estimate.wall_s = optional_number(document, "wall_s").value_or(0);
  return estimate;
}

}  // namespace

const char* to_text(Method method) {
  return kMethodNames[static_cast<std::size_t>(method)];
}

const char* to_text(RigKind kind) {
  return kKindNames[static_cast<std::size_t>(kind)];
}

std::string estimate_to_json(const Estimate& estimate, Timing timing) {
  Json document;
  document["schema"] = kEstimateSchema;
  document["recording"] = estimate.recording;
  document["method"] = to_text(estimate.method);
  document["equation"] = "t_motor = t_laser + offset";
  document["identifiable"] = estimate.identifiable;
  const bool found = estimate.identifiable;
  document["offset_ms"] = found ? milliseconds_or_null(estimate.offset_s) : Json(nullptr);
  document["sigma_ms"] = found ? milliseconds_or_null(estimate.sigma_s) : Json(nullptr);
  if (found && !estimate.sigma_parts.empty()) document["sigma_parts"] = sigma_parts_to_json(estimate);
  if (estimate.rig_effects) document["rig_effects"] = rig_effects_to_json(*estimate.rig_effects);
  document["drift_ppm"] = number_or_null(estimate.drift_ppm);
  if (estimate.over_time) write_over_time(*estimate.over_time, document);
  document["kind"] = estimate.kind ? Json(to_text(*estimate.kind)) : Json(nullptr);
  document["kind_reason"] = estimate.kind_reason.empty() ? Json(nullptr) : Json(estimate.kind_reason);
  document["lost_s"] = Json::array();
  for (const Interval& lost : estimate.lost)
    document["lost_s"].push_back({to_millisecond(lost.begin_s), to_millisecond(lost.end_s)});
  if (estimate.motion) document["poses"] = motion_to_json(*estimate.motion);
  document["warnings"] = estimate.warnings;
  document["reasons"] = estimate.reasons();
  document["reason_codes"] = Json::array();
  for (const Refusal& refusal : estimate.refusals)
    document["reason_codes"].push_back(entry_of(refusal.kind).code);
  document["readings"] = readings_json(estimate.readings);
  document["criteria"] = Json::object();
  for (const CriterionOptimum& optimum : estimate.criteria) {
    document["criteria"][optimum.name] = {{"offset_ms", written_ms(optimum.offset_s)},
                                          {"value", number(optimum.value)}};
  }
  if (estimate.fit) document["fit"] = fit_to_json(*estimate.fit);
  if (estimate.rig) document["parameters"] = rig_parameters_json(*estimate.rig);
  document["curve"] = curve_to_json(estimate.curve);
  document["sweeps"] = estimate.sweeps;
  document["scans"] = estimate.scans;
  if (estimate.sample) document["sample"] = sample_to_json(*estimate.sample);
  if (estimate.offset_is_gauge()) document["offset_is_gauge"] = true;
  if (const auto& part = estimate.stationary_part) document["window_s"] = {part->begin_s, part->end_s};
  if (estimate.together) write_together(*estimate.together, document);
  document["cpu_s"] = timing == Timing::kWritten ? Json(estimate.cpu_s) : Json(nullptr);
  document["wall_s"] = timing == Timing::kWritten ? Json(estimate.wall_s) : Json(nullptr);
  document["version"] = SWEEPSCOPE_VERSION;
  return json_text(std::move(document));
}

Result<Estimate> parse_estimate_json(std::string_view text, std::string_view name) {
  try {
    return estimate_from_json(Json::parse(text));
  } catch (const Json::parse_error& error) {
    return unreadable(fmt::format("{}: not JSON: invalid at byte {}", name, error.byte));
  } catch (const Json::out_of_range&) {
    return unreadable(fmt::format("{}: not an estimate: a number in it is too large", name));
  } catch (const BadValue& error) {
    return unreadable(fmt::format("{}: not an estimate: {}", name, error.what()));
  }
}

Result<void> write_estimate_json(const std::filesystem::path& path, const Estimate& estimate, Timing timing) {
  return write_file(path, estimate_to_json(estimate, timing));
}

Result<Estimate> read_estimate_json(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  return parse_estimate_json(*text, path.string());
}

std::string curve_to_csv(const Estimate& estimate) {
  std::string text = "offset_ms,d,translation_m,rotation_rad,signed_rotation_rad,n,e_m,capped_cost_m\n";
  for (const CurvePoint& point : estimate.curve) {
    text += fmt::format("{}", written_ms(point.offset_s));
    for (const CurveColumn& column : kCurveColumns) {
      const auto& value = point.*column.value;
      text += value ? fmt::format(",{}", *value) : ",";
    }
    text += '\n';
  }
  return text;
}

std::string over_time_to_csv(const OffsetOverTime& over_time) {
  std::string text = "t_s,offset_ms,sigma_ms,from_s,to_s,fit_ms\n";
  for (const OffsetWindow& window : over_time.windows) {
    const auto ms = [](const std::optional<double>& seconds) {
      return seconds ? fmt::format("{}", written_ms(*seconds)) : std::string();
    };
    const auto fit_s =
        over_time.course ? std::optional(over_time.course->offset_at_s(window.time_s)) : std::nullopt;
    text += fmt::format("{},{},{},{},{},{}\n", to_millisecond(window.time_s), ms(window.offset_s),
                        ms(window.sigma_s), to_millisecond(window.begin_s), to_millisecond(window.end_s),
                        ms(fit_s));
  }
  return text;
}

Result<void> write_curve_csv(const std::filesystem::path& path, const Estimate& estimate) {
  return write_file(path, curve_to_csv(estimate));
}

}  // namespace sweepscope
