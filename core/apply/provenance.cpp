#include "core/apply/provenance.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kEstimateSchema = "sweepscope.estimate/1";
constexpr double kMs = 1e-3, kPpm = 1e-6;
constexpr double kMaxRate = 0.01;  // larger than any clock error

struct BadEstimate {
  std::string why;
};

/// Absent if there is no such key, or it is null.
std::optional<double> number_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return std::nullopt;
  if (!found->is_number() || !std::isfinite(found->get<double>()))
    throw BadEstimate{fmt::format("{} is not a number", key)};
  return found->get<double>();
}

double needed(const Json& object, const char* key, const char* of) {
  if (!object.is_object()) throw BadEstimate{fmt::format("{} has something else than objects", of)};
  const auto number = number_of(object, key);
  if (!number) throw BadEstimate{fmt::format("{} lacks {}", of, key)};
  return *number;
}

Json list_of(const Json& document, const char* key) {
  const auto found = document.find(key);
  if (found == document.end() || found->is_null()) return Json::array();
  if (!found->is_array()) throw BadEstimate{fmt::format("{} is not a list", key)};
  return *found;
}

AppliedOffset offset_of(const Json& document) {
  AppliedOffset offset;
  offset.offset_s = needed(document, "offset_ms", "it") * kMs;
  if (const auto sigma_ms = number_of(document, "sigma_ms")) offset.sigma_s = *sigma_ms * kMs;
  offset.middle_s = number_of(document, "middle_s");
  offset.rate = number_of(document, "rate_ppm").value_or(0) * kPpm;
  if (std::abs(offset.rate) > kMaxRate) throw BadEstimate{"rate_ppm is larger than any clock error"};
  for (const Json& jump : list_of(document, "jumps"))
    offset.jumps.push_back({(needed(jump, "from_s", "jumps") + needed(jump, "to_s", "jumps")) / 2,
                            needed(jump, "jump_ms", "jumps") * kMs});
  return offset;
}

/// Why the estimate has no offset, in its words.
std::string reasons_of(const Json& document) {
  const auto reasons = document.find("reasons");
  if (reasons == document.end() || !reasons->is_array() || reasons->empty() || !reasons->front().is_string())
    return "no reason is given";
  return reasons->front().get<std::string>();
}

}  // namespace

Result<AppliedOffset> parse_applied_offset(std::string_view json, std::string_view name) {
  const Json document = Json::parse(json, nullptr, false);
  const auto refused = [&](const std::string& why) {
    return unreadable(fmt::format("{}: is not an estimate that can be applied: {}", name, why));
  };
  if (!document.is_object()) return refused("it is not a JSON object");
  const auto schema = document.find("schema");
  if (schema == document.end() || !schema->is_string() || schema->get<std::string>() != kEstimateSchema)
    return refused(fmt::format("schema is not {}", kEstimateSchema));
  const auto offset = document.find("offset_ms");
  if (offset != document.end() && offset->is_null())
    return failure(ExitCode::kNotIdentifiable,
                   fmt::format("{}: the estimate has no offset: {}", name, reasons_of(document)));
  try {
    return offset_of(document);
  } catch (const BadEstimate& bad) {
    return refused(bad.why);
  }
}

std::string to_json(const Provenance& provenance) {
  const AppliedOffset& offset = provenance.offset;
  const auto ms = [](double seconds) { return std::round(seconds * 1e12) / 1e9; };
  Json document;
  document["schema"] = "sweepscope.apply/1";
  document["equation"] = "t_motor = t_laser + offset";
  document["recording"] = provenance.recording;
  document["shifted"] = provenance.shifted == ShiftedStream::kMotor ? "motor" : "laser";
  document["topic"] = provenance.topic;
  if (!provenance.joint.empty()) document["joint"] = provenance.joint;
  document["stamp"] = name_of(provenance.stamp);
  document["messages"] = provenance.messages;
  document["offset_ms"] = ms(offset.offset_s);
  document["sigma_ms"] = offset.sigma_s ? Json(ms(*offset.sigma_s)) : Json();
  if (offset.changes()) {
    document["middle_s"] = offset.middle_s ? Json(*offset.middle_s) : Json();
    document["rate_ppm"] = std::round(offset.rate / kPpm * 1e6) / 1e6;
    document["jumps"] = Json::array();
    for (const AppliedOffset::Jump& jump : offset.jumps)
      document["jumps"].push_back({{"t_s", jump.time_s}, {"jump_ms", ms(jump.size_s)}});
  }
  if (!provenance.added.empty()) document["added"] = provenance.added;
  document["estimate"] = provenance.estimate.empty() ? Json() : Json(provenance.estimate);
  document["version"] = SWEEPSCOPE_VERSION;
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace sweepscope
