#include "core/results/info_json.hpp"

#include <nlohmann/json.hpp>
#include <optional>

#include "core/io/printable_text.hpp"
#include "core/recording/rig.hpp"
#include "core/results/fields.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json stream_json(const StreamSummary& stream) {
  return {{"topic", stream.topic},
          {"stamp", name_of(stream.stamp)},
          {"used", stream.used},
          {"rate_hz", stream.rate_hz()},
          {"median_period_s", stream.median_period_s},
          {"duration_s", stream.duration_s},
          {"gaps", stream.gaps},
          {"longest_gap_s", stream.longest_gap_s},
          {"out_of_order", stream.out_of_order},
          {"doubled", stream.duplicates},
          {"dropped", stream.dropped},
          {"receive_minus_header_s", or_null(stream.receive_minus_header_s)},
          {"receive_jitter_s", or_null(stream.receive_jitter_s)}};
}

Json laser_json(const LaserSummary& laser) {
  Json json = stream_json(laser);
  json.update(Json{{"stamp_at", name_of(laser.stamp_at)},
                   {"fewest_beams", laser.min_beams},
                   {"most_beams", laser.max_beams},
                   {"first_beam_deg", laser.first_beam_deg},
                   {"last_beam_deg", laser.last_beam_deg},
                   {"scan_s", laser.scan_s},
                   {"beams", laser.beams},
                   {"usable_beams", laser.usable_beams},
                   {"nan_ranges", laser.nan},
                   {"infinite_ranges", laser.infinite},
                   {"zero_ranges", laser.zero},
                   {"out_of_range_ranges", laser.out_of_range},
                   {"median_range_m", laser.median_range_m},
                   {"scans_without_motor", laser.scans_without_motor},
                   {"intensities", laser.intensities},
                   {"rings", laser.rings},
                   {"readings", readings_json(laser.readings)}});
  return json;
}

Json motor_json(const MotorSummary& motor) {
  Json json = stream_json(motor);
  json.update(Json{{"joint", motor.joint},
                   {"least_deg", motor.min_deg},
                   {"most_deg", motor.max_deg},
                   {"median_speed_deg_s", motor.median_speed_deg_s},
                   {"deg_per_ms", motor.deg_per_ms()},
                   {"turns", motor.turns},
                   {"one_way", motor.one_way},
                   {"unwrapped", motor.unwrapped},
                   {"repeated", motor.repeated},
                   {"of_other_publishers", motor.of_others},
                   {"reversals", motor.reversals},
                   {"whole_sweeps", motor.whole_sweeps()},
                   {"median_sweep_s", motor.median_sweep_s}});
  return json;
}

Json part_json(const std::optional<RecordingPart>& part) {
  return part ? Json{part->begin_s, part->end_s} : Json(nullptr);
}

}  // namespace

std::string info_to_json(const RecordingSummary& summary) {
  Json topics = Json::array();
  for (const RecordedTopic& topic : summary.topics) {
    topics.push_back({{"name", topic.name},
                      {"type", topic.type},
                      {"messages", topic.messages},
                      {"malformed", topic.malformed}});
  }
  const Json json = {
      {"schema", "sweepscope.info/1"},        {"recording", summary.name},
      {"warnings", summary.warnings},         {"topics", topics},
      {"laser", laser_json(summary.laser)},   {"motor", motor_json(summary.motor)},
      {"motion", or_null(summary.motion)},    {"stationary_part_s", part_json(summary.stationary_part)},
      {"expectations", summary.expectations}, {"version", SWEEPSCOPE_VERSION}};
  return json_text(json);
}

}  // namespace sweepscope
