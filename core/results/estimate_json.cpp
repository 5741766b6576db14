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
#include "core/results/json_values.hpp"
#include "core/results/over_time_json.hpp"
#include "core/results/rig_json.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kEstimateSchema = "sweepscope.estimate/1";

Json curve_to_json(const std::vector<CurvePoint>& curve) {
  Json points = Json::array();
  for (const CurvePoint& point : curve) {
    Json object;
    object["offset_ms"] = written_ms(point.offset_s);
    for (const CurveColumn& column : kCurveColumns)
      object[column.key] = json::number_or_null(point.*column.value);
    points.push_back(std::move(object));
  }
  return points;
}

constexpr std::array kMethodNames{"direct", "stationary", "moving"};  // by Method
constexpr std::array kKindNames{"stationary", "moving"};              // by RigKind

/// The value of an enum whose names are these.
template <typename T>
T named(const std::string& name, const auto& names, const char* key) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw json::BadValue(fmt::format("{} is not one of {}", key, fmt::join(names, ", ")));
  return static_cast<T>(found - names.begin());
}

std::vector<CurvePoint> curve_from_json(const Json& curve) {
  if (!curve.is_array()) throw json::BadValue("curve is not a list");
  std::vector<CurvePoint> points;
  for (const Json& object : curve) {
    const std::string where = fmt::format("curve[{}].", points.size());
    CurvePoint point;
    if (!object.is_object()) throw json::BadValue(where + " is not an object");
    point.offset_s = json::seconds(json::required<double>(object, "offset_ms", where), where + "offset_ms");
    for (const CurveColumn& column : kCurveColumns)
      point.*column.value = json::optional_number(object, column.key, where);
    points.push_back(point);
  }
  return points;
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

Json sample_to_json(const SweepSample& sample) {
  return {{"groups", sample.groups}, {"sweeps", sample.sweeps}, {"of_sweeps", sample.of_sweeps}};
}

std::optional<SweepSample> sample_from_json(const Json& document) {
  const auto found = document.find("sample");
  if (found == document.end() || found->is_null()) return std::nullopt;
  if (!found->is_object()) throw json::BadValue("sample is not an object");
  return SweepSample{json::required_count(*found, "groups"), json::required_count(*found, "sweeps"),
                     json::required_count(*found, "of_sweeps")};
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
  object["time_shift_s"] = json::seconds_or_null(motion.time_shift_s);
  object["time_shift_sigma_s"] = json::seconds_or_null(motion.time_shift_sigma_s);
  return object;
}

std::optional<UsedMotion> motion_from_json(const Json& document) {
  const auto found = document.find("poses");
  if (found == document.end() || found->is_null()) return std::nullopt;
  if (!found->is_object()) throw json::BadValue("poses is not an object");
  UsedMotion motion;
  const std::string type = json::optional_text(*found, "type");
  if (found->contains("file"))
    motion.name = json::required<std::string>(*found, "file", "poses.");
  else
    motion.name = json::required<std::string>(*found, "topic", "poses.");
  if (!type.empty()) motion.kind = type == "imu" ? UsedMotion::Kind::kImu : UsedMotion::Kind::kOdometry;
  motion.trusted = json::required<std::string>(*found, "as", "poses.") == "truth";
  motion.time_shift_s = json::optional_number(*found, "time_shift_s", "poses.");
  motion.time_shift_sigma_s = json::optional_number(*found, "time_shift_sigma_s", "poses.");
  return motion;
}

Json fit_to_json(const FitEvidence& fit) {
  return {{"converged", fit.converged},
          {"iterations", fit.iterations},
          {"features", fit.features},
          {"matches", fit.matches},
          {"residual_m", json::number(fit.residual_m)},
          {"lever_m", json::number(fit.lever_m)},
          {"reach_m", json::number(fit.reach_m)}};
}

std::optional<FitEvidence> fit_from_json(const Json& document) {
  constexpr std::int64_t kMaxIterations = 1'000'000;
  const auto found = document.find("fit");
  if (found == document.end() || found->is_null()) return std::nullopt;
  if (!found->is_object()) throw json::BadValue("fit is not an object");
  FitEvidence fit;
  fit.converged = json::required<bool>(*found, "converged", "fit.");
  const auto iterations = whole_number(json::member(*found, "iterations", "fit."), 0, kMaxIterations);
  if (!iterations) throw json::BadValue("fit.iterations is not a whole number");
  fit.iterations = static_cast<int>(*iterations);
  fit.features = json::required_count(*found, "features");
  fit.matches = json::required_count(*found, "matches");
  fit.residual_m = json::required<double>(*found, "residual_m", "fit.");
  fit.lever_m = json::required<double>(*found, "lever_m", "fit.");
  fit.reach_m = json::required<double>(*found, "reach_m", "fit.");
  return fit;
}

/// "recordings", and how they agree.
void write_together(const Together& together, Json& document) {
  document["recordings"] = Json::array();
  for (const RecordingOfRig& recording : together.recordings)
    document["recordings"].push_back(
        {{"recording", recording.recording},
         {"offset_ms", json::milliseconds_or_null(recording.offset_s)},
         {"sigma_ms", json::milliseconds_or_null(recording.sigma_s)},
         {"share", json::number(recording.share)},
         {"turn_sigma_deg", json::number_or_null(recording.turn_sigma_rad, kDegPerRad)},
         {"shift_sigma_m", json::number_or_null(recording.shift_sigma_m)},
         {"residual_before_m", json::number_or_null(recording.residual_before_m)},
         {"residual_after_m", json::number_or_null(recording.residual_after_m)},
         {"reasons", recording.reasons}});
  document["offsets"] = together.own_offsets ? "each" : "one";
  document["chi_square"] = json::number(together.chi_square);
  document["degrees_of_freedom"] = together.degrees_of_freedom;
}

RecordingOfRig recording_of_rig(const Json& object) {
  if (!object.is_object()) throw json::BadValue("an entry of recordings is not an object");
  RecordingOfRig recording;
  recording.recording = json::required<std::string>(object, "recording", "recordings.");
  recording.offset_s = json::optional_seconds(object, "offset_ms");
  recording.sigma_s = json::optional_seconds(object, "sigma_ms");
  recording.share = json::required<double>(object, "share", "recordings.");
  if (const auto deg = json::optional_number(object, "turn_sigma_deg"))
    recording.turn_sigma_rad = *deg / kDegPerRad;
  recording.shift_sigma_m = json::optional_number(object, "shift_sigma_m");
  recording.residual_before_m = json::optional_number(object, "residual_before_m");
  recording.residual_after_m = json::optional_number(object, "residual_after_m");
  recording.reasons = json::required<std::vector<std::string>>(object, "reasons", "recordings.");
  return recording;
}

std::optional<Together> together_from_json(const Json& document) {
  const auto recordings = document.find("recordings");
  if (recordings == document.end()) return std::nullopt;
  if (!recordings->is_array()) throw json::BadValue("recordings is not an array");
  Together together;
  for (const Json& object : *recordings) together.recordings.push_back(recording_of_rig(object));
  together.own_offsets = json::required<std::string>(document, "offsets") == "each";
  together.chi_square = json::required<double>(document, "chi_square");
  together.degrees_of_freedom = static_cast<int>(json::required_count(document, "degrees_of_freedom"));
  return together;
}

std::vector<CriterionOptimum> criteria_from_json(const Json& criteria) {
  if (!criteria.is_object()) throw json::BadValue("criteria is not an object");
  std::vector<CriterionOptimum> optima;
  for (const auto& [key, object] : criteria.items()) {
    const std::string where = fmt::format("criteria.{}.", key);
    if (!object.is_object()) throw json::BadValue(where + " is not an object");
    optima.push_back({key,
                      json::seconds(json::required<double>(object, "offset_ms", where), where + "offset_ms"),
                      json::required<double>(object, "value", where)});
  }
  return optima;
}

// Older documents have none.
std::vector<Interval> intervals_from_json(const Json& document, const char* key) {
  if (!document.contains(key)) return {};
  std::vector<Interval> intervals;
  for (const auto& [begin_s, end_s] : json::required<std::vector<std::array<double, 2>>>(document, key))
    intervals.push_back({begin_s, end_s});
  return intervals;
}

Refusals refusals_from_json(const Json& document) {
  const auto texts = json::required<std::vector<std::string>>(document, "reasons");
  // Estimates of versions before 0.3 have none.
  const auto codes = document.contains("reason_codes")
                         ? json::required<std::vector<std::string>>(document, "reason_codes")
                         : std::vector<std::string>();
  Refusals refusals;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const RefusalKind kind = i < codes.size() ? refusal_kind_of(codes[i]) : RefusalKind::kUnknown;
    refusals.push_back({kind, std::nullopt, std::nullopt, texts[i]});
  }
  return refusals;
}

Estimate estimate_from_json(const Json& document) {
  if (!document.is_object()) throw json::BadValue("it is not a JSON object");
  if (json::required<std::string>(document, "schema") != kEstimateSchema) {
    throw json::BadValue(fmt::format("schema is not {}", kEstimateSchema));
  }
  Estimate estimate;
  estimate.recording = json::required<std::string>(document, "recording");
  estimate.method = named<Method>(json::required<std::string>(document, "method"), kMethodNames, "method");
  estimate.identifiable = json::required<bool>(document, "identifiable");
  estimate.offset_s = json::optional_seconds(document, "offset_ms");
  estimate.sigma_s = json::optional_seconds(document, "sigma_ms");
  estimate.drift_ppm = json::optional_number(document, "drift_ppm");
  if (const std::string kind = json::optional_text(document, "kind"); !kind.empty())
    estimate.kind = named<RigKind>(kind, kKindNames, "kind");
  estimate.kind_reason = json::optional_text(document, "kind_reason");
  estimate.over_time = over_time_from_json(document);
  estimate.sample = sample_from_json(document);
  if (document.contains("window_s")) {
    const auto [begin_s, end_s] = json::required<std::array<double, 2>>(document, "window_s");
    estimate.stationary_part = RecordingPart{begin_s, end_s};
  }
  estimate.lost = intervals_from_json(document, "lost_s");
  estimate.motion = motion_from_json(document);
  estimate.fit = fit_from_json(document);
  if (const auto parameters = document.find("parameters"); parameters != document.end())
    if (auto solved = solved_rig_of(*parameters))
      estimate.rig = std::make_shared<const SolvedRig>(std::move(*solved));
  estimate.warnings = json::required<std::vector<std::string>>(document, "warnings");
  if (document.contains("readings")) estimate.readings = readings_of(document["readings"]);
  estimate.refusals = refusals_from_json(document);
  estimate.together = together_from_json(document);
  estimate.criteria = criteria_from_json(json::member(document, "criteria", ""));
  estimate.curve = curve_from_json(json::member(document, "curve", ""));
  estimate.sweeps = json::required_count(document, "sweeps");
  estimate.scans = json::required_count(document, "scans");
  estimate.cpu_s = json::optional_number(document, "cpu_s").value_or(0);
  estimate.wall_s = json::optional_number(document, "wall_s").value_or(0);
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
  document["offset_ms"] = found ? json::milliseconds_or_null(estimate.offset_s) : Json(nullptr);
  document["sigma_ms"] = found ? json::milliseconds_or_null(estimate.sigma_s) : Json(nullptr);
  if (found && !estimate.sigma_parts.empty()) document["sigma_parts"] = sigma_parts_to_json(estimate);
  if (estimate.rig_effects) document["rig_effects"] = rig_effects_to_json(*estimate.rig_effects);
  document["drift_ppm"] = json::number_or_null(estimate.drift_ppm);
  if (estimate.over_time) write_over_time(*estimate.over_time, document);
  document["kind"] = estimate.kind ? Json(to_text(*estimate.kind)) : Json(nullptr);
  document["kind_reason"] = estimate.kind_reason.empty() ? Json(nullptr) : Json(estimate.kind_reason);
  document["lost_s"] = Json::array();
  for (const Interval& lost : estimate.lost)
    document["lost_s"].push_back({json::to_millisecond(lost.begin_s), json::to_millisecond(lost.end_s)});
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
                                          {"value", json::number(optimum.value)}};
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
  } catch (const json::BadValue& error) {
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

}  // namespace sweepscope
