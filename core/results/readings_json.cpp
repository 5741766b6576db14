#include <algorithm>
#include <iterator>

#include "core/results/fields.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

// In the order of BeamReadingKind.
constexpr std::array<const char*, 7> kReadingNames{"recorded",        "reversed", "at_once",        "mirror",
                                                   "mirror_reversed", "period",   "period_reversed"};

std::optional<double> scaled(const Json& json, const char* key, double factor) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  return found->get<double>() * factor;
}

}  // namespace

Json readings_json(const std::vector<BeamReading>& readings) {
  const auto or_null = [](const std::optional<double>& value, double factor) {
    return value ? Json(std::round(*value * factor * 1e9) / 1e9) : Json(nullptr);
  };
  Json all = Json::array();
  for (const BeamReading& reading : readings)
    all.push_back({{"reading", kReadingNames[static_cast<std::size_t>(reading.kind)]},
                   {"time_increment_s", reading.time_increment_s},
                   {"residual_mm", or_null(reading.residual_m, 1e3)},
                   {"offset_ms", or_null(reading.offset_s, 1e3)},
                   {"chosen", reading.chosen}});
  return all;
}

std::vector<BeamReading> readings_of(const Json& json) {
  std::vector<BeamReading> readings;
  for (const Json& one : json) {
    const auto name = one.at("reading").get<std::string>();
    const auto found = std::ranges::find(kReadingNames, name);
    if (found == kReadingNames.end()) continue;
    readings.push_back({static_cast<BeamReadingKind>(found - kReadingNames.begin()),
                        one.at("time_increment_s").get<double>(), scaled(one, "residual_mm", 1e-3),
                        scaled(one, "offset_ms", 1e-3), one.at("chosen").get<bool>()});
  }
  return readings;
}

}  // namespace sweepscope
