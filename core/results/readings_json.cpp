#include <algorithm>
#include <iterator>

#include "core/offset/readings/beam_readings.hpp"
#include "core/results/fields.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

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
    all.push_back({{"reading", entry_of(reading.kind).name},
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
    const auto entries = beam_reading_entries();
    const auto found = std::ranges::find(entries, name, &BeamReadingEntry::name);
    if (found == entries.end()) continue;
    readings.push_back({found->kind, one.at("time_increment_s").get<double>(),
                        scaled(one, "residual_mm", 1e-3), scaled(one, "offset_ms", 1e-3),
                        one.at("chosen").get<bool>()});
  }
  return readings;
}

}  // namespace sweepscope
