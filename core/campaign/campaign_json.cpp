#include "core/campaign/campaign_json.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/io/printable_text.hpp"
#include "core/results/estimate_json.hpp"
#include "core/results/fields.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "sweepscope.campaign/1";
constexpr std::array kOutcomeNames{"answered", "refused", "unusable", "unreadable"};  // by RowOutcome

Json number_or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

std::optional<double> optional_number(const Json& json, const char* key) {
  const Json& value = json.at(key);
  if (value.is_null()) return std::nullopt;
  const double number = value.get<double>();
  if (!(std::abs(number) <= 1e6)) throw std::runtime_error("beyond 1000 s");
  return number;
}

/// The value of an enum by its name; nothing for null.
template <typename T>
std::optional<T> optional_named(const Json& json, const char* key, std::initializer_list<T> values) {
  if (json.at(key).is_null()) return std::nullopt;
  const auto name = json.at(key).get<std::string>();
  for (const T value : values)
    if (name == to_text(value)) return value;
  throw std::runtime_error("unknown name");
}

RowOutcome outcome_from(const std::string& name) {
  if (name == "within" || name == "outside") return RowOutcome::kAnswered;
  for (std::size_t i = 0; i < kOutcomeNames.size(); ++i)
    if (name == kOutcomeNames[i]) return static_cast<RowOutcome>(i);
  throw std::runtime_error("unknown outcome");
}

std::size_t count_at(const Json& json, const char* key) {
  const auto count = whole_number(json.at(key), 0, 1'000'000'000'000);
  if (!count) throw std::runtime_error("no count");
  return static_cast<std::size_t>(*count);
}

Json counts_to_json(const Campaign& campaign) {
  const CampaignCounts counts = counts_of(campaign);
  return {{"within", counts.within},           {"outside", counts.outside},
          {"answered", counts.answered},       {"refused", counts.refused},
          {"unusable", counts.unusable},       {"unreadable", counts.unreadable},
          {"pending", campaign.pending.size()}};
}

}  // namespace

std::string date_text(std::int64_t recorded_ns) {
  using namespace std::chrono;
  const sys_time<milliseconds> time{floor<milliseconds>(nanoseconds(recorded_ns))};
  const auto day = floor<days>(time);
  const year_month_day date{day};
  const hh_mm_ss clock{time - day};
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     clock.hours().count(), clock.minutes().count(), clock.seconds().count(),
                     clock.subseconds().count());
}

Json row_to_json(const CampaignRow& row) {
  Json json;
  json["recording"] = valid_utf8(row.recording);
  json["outcome"] = kOutcomeNames.at(static_cast<std::size_t>(row.outcome));
  json["offset_ms"] = number_or_null(row.offset_ms);
  json["sigma_ms"] = number_or_null(row.sigma_ms);
  json["recorded"] = row.recorded_ns ? Json(date_text(*row.recorded_ns)) : Json(nullptr);
  json["recorded_ns"] = row.recorded_ns ? Json(*row.recorded_ns) : Json(nullptr);
  json["method"] = row.method ? Json(to_text(*row.method)) : Json(nullptr);
  json["kind"] = row.kind ? Json(to_text(*row.kind)) : Json(nullptr);
  json["sweeps"] = row.sweeps;
  json["scans"] = row.scans;
  json["warnings"] = row.warnings;
  json["reasons"] = row.reasons;
  return json;
}

CampaignRow row_from_json(const Json& json) {
  CampaignRow row;
  row.recording = json.at("recording").get<std::string>();
  row.outcome = outcome_from(json.at("outcome").get<std::string>());
  row.offset_ms = optional_number(json, "offset_ms");
  row.sigma_ms = optional_number(json, "sigma_ms");
  if (row.offset_ms.has_value() != (row.outcome == RowOutcome::kAnswered)) throw std::runtime_error("no row");
  if (!json.at("recorded_ns").is_null()) {
    row.recorded_ns = whole_number(json.at("recorded_ns"), 0, std::numeric_limits<std::int64_t>::max());
    if (!row.recorded_ns) throw std::runtime_error("no date");
  }
  row.method = optional_named(json, "method", {Method::kDirect, Method::kStationary, Method::kMoving});
  row.kind = optional_named(json, "kind", {RigKind::kStationary, RigKind::kMoving});
  row.sweeps = count_at(json, "sweeps");
  row.scans = count_at(json, "scans");
  row.warnings = json.at("warnings").get<std::vector<std::string>>();
  row.reasons = json.at("reasons").get<std::vector<std::string>>();
  return row;
}

std::string campaign_to_json(const Campaign& campaign) {
  Json document;
  document["schema"] = kSchema;
  document["equation"] = "t_motor = t_laser + offset";
  document["expected"] = campaign.expected ? Json{{"offset_ms", campaign.expected->offset_ms},
                                                  {"tolerance_ms", campaign.expected->tolerance_ms}}
                                           : Json(nullptr);
  document["complete"] = campaign.pending.empty();
  document["counts"] = counts_to_json(campaign);
  document["rows"] = Json::array();
  for (const CampaignRow& row : campaign.rows) {
    Json json = row_to_json(row);
    json["outcome"] = outcome_word(row, campaign.expected);
    document["rows"].push_back(std::move(json));
  }
  document["pending"] = campaign.pending;
  document["version"] = SWEEPSCOPE_VERSION;
  return json_text(std::move(document));
}

Result<Campaign> parse_campaign_json(std::string_view text, std::string_view name) {
  Campaign campaign;
  std::size_t number = 0;
  try {
    const Json document = Json::parse(text);
    if (document.at("schema") != kSchema) throw std::runtime_error("another schema");
    const Json& expected = document.at("expected");
    if (!expected.is_null())
      campaign.expected = {expected.at("offset_ms").get<double>(), expected.at("tolerance_ms").get<double>()};
    for (const Json& row : document.at("rows")) {
      ++number;
      campaign.rows.push_back(row_from_json(row));
    }
    campaign.pending = document.at("pending").get<std::vector<std::string>>();
  } catch (const std::exception&) {
    const std::string where = number == 0 ? "" : fmt::format("row {}: ", number);
    return unreadable(
        fmt::format("{}: {}is not a table written by estimate --table as JSON ({})", name, where, kSchema));
  }
  return campaign;
}

}  // namespace sweepscope
