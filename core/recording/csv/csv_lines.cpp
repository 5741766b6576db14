#include "core/recording/csv/csv_lines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/numbers.hpp"
#include "core/recording/csv/csv_beams.hpp"
#include "core/recording/csv/csv_cells.hpp"
#include "core/recording/messages/message_collector.hpp"

namespace sweepscope {
namespace {

constexpr const char* kDefaultLaser = "/scan";
constexpr const char* kDefaultMotor = "/joint_states";
constexpr const char* kDefaultJoint = "motor";

using Names = std::vector<std::string_view>;

const Names kStamps{"stamp_s",    "receive_s", "stamp_ms", "receive_ms", "stamp_us", "receive_us", "stamp_ns",
                    "receive_ns", "time_s",    "time_ms",  "time_us",    "time_ns",  "time",       "%time"};

Result<void> check_columns(const CsvTable& table, const std::vector<Names>& needed, const Names& known,
                           const std::string& file, RawRecording& raw) {
  for (const Names& group : needed) {
    if (std::ranges::any_of(group, [&](std::string_view name) { return table.has(name); })) continue;
    const bool stamps = &group == &needed.front();
    return unreadable(
        fmt::format("{} has no column {}; its columns are: {}", table.place(),
                    stamps ? "stamp_s or receive_s" : fmt::format("{}", fmt::join(group, " or ")),
                    fmt::join(table.columns(), ", ")));
  }
  std::vector<std::string> unknown;
  const auto is_known = [&](const std::string& name) {
    return std::ranges::find(known, name) != known.end() ||
           std::ranges::find(kStamps, name) != kStamps.end() ||
           name.starts_with("field.");  // of rostopic, which writes all of a message
  };
  for (const std::string& name : table.columns())
    if (!is_known(name)) unknown.push_back(name);
  if (!unknown.empty()) {
    raw.warnings.push_back(
        fmt::format("{} has unknown columns, which were ignored: {}", file, fmt::join(unknown, ", ")));
  }
  return {};
}

/// The columns of an array as rostopic numbers them: "field.ranges0", "field.ranges1" and so on.
std::vector<std::size_t> numbered(const CsvTable& table, const std::string& name) {
  std::vector<std::size_t> columns;
  std::size_t at = table.column(name + "0");
  for (; at < table.columns().size() && table.columns()[at] == fmt::format("{}{}", name, columns.size());
       ++at)
    columns.push_back(at);
  return columns;
}

}  // namespace

/// The first of these that a table has.
Scaled first_of(const CsvTable& table, std::initializer_list<std::pair<std::string_view, double>> names) {
  for (const auto& [name, factor] : names)
    if (table.has(name)) return {table.column(name), factor};
  return {table.columns().size(), 1};
}

StampColumns::StampColumns(const CsvTable& table) : header(find(table, false)), receive(find(table, true)) {}

StampColumns::Column StampColumns::find(const CsvTable& table, bool receive) {
  constexpr std::int64_t kMs_ns = 1'000'000, kUs_ns = 1'000;
  for (const auto& [unit, ns] : {std::pair("_s", kSecond_ns), {"_ms", kMs_ns}, {"_us", kUs_ns}, {"_ns", 1L}})
    for (const char* kind : {"stamp", "time"})
      if (const std::string name = (receive ? "receive" : kind) + std::string(unit); table.has(name))
        return {table.column(name), ns};
  if (!receive && table.has("time")) return {table.column("time"), kSecond_ns};
  return {table.column(receive ? "%time" : "field.header.stamp"), 1};
}

Result<void> check_scan_columns(const CsvTable& table, const std::string& file, RawRecording& raw) {
  if (is_beam_table(table))
    return check_columns(table, {kStamps},
                         {"angle_rad", "angle_deg", "angle", "range_m", "range_mm", "range", "distance_m",
                          "distance_mm", "distance"},
                         file, raw);
  return check_columns(table,
                       {kStamps,
                        {"angle_min_rad", "angle_min_deg", "field.angle_min"},
                        {"angle_increment_rad", "angle_increment_deg", "field.angle_increment"},
                        {"ranges_m", "ranges_mm", "range_mm", "field.ranges0"}},
                       {"angle_min_rad", "angle_min_deg", "angle_increment_rad", "angle_increment_deg",
                        "time_increment_s", "scan_time_s", "range_min_m", "range_max_m", "ranges_m",
                        "ranges_mm", "range_mm", "intensities", "topic"},
                       file, raw);
}

Result<void> check_motor_columns(const CsvTable& table, const std::string& file, RawRecording& raw) {
  const Names angles{"angle_rad", "angle_deg", "position"};
  Names needed = angles;
  if (table.has("field.position0") || table.has("field.data")) needed = {"field.position0", "field.data"};
  return check_columns(table, {kStamps, needed}, {"angle_rad", "angle_deg", "position", "topic", "joint"},
                       file, raw);
}

ScanLines::ScanLines(const CsvTable& table, const Rig& rig, RawRecording& raw)
    : table_(table), rig_(rig), raw_(raw), stamps_(table) {
  constexpr double kMm_m = 1e-3;
  numbers_ = {first_of(table, {{"angle_min_rad", 1}, {"angle_min_deg", kRadPerDeg}, {"field.angle_min", 1}}),
              first_of(table, {{"angle_increment_rad", 1},
                               {"angle_increment_deg", kRadPerDeg},
                               {"field.angle_increment", 1}}),
              first_of(table, {{"time_increment_s", 1}, {"field.time_increment", 1}}),
              first_of(table, {{"scan_time_s", 1}, {"field.scan_time", 1}}),
              first_of(table, {{"range_min_m", 1}, {"field.range_min", 1}}),
              first_of(table, {{"range_max_m", 1}, {"field.range_max", 1}})};
  ranges_ = first_of(table, {{"ranges_m", 1}, {"ranges_mm", kMm_m}, {"range_mm", kMm_m}});
  intensities_ = {table.column("intensities"), 1};
  range_columns_ = numbered(table, "field.ranges");
  intensity_columns_ = numbered(table, "field.intensities");
  topic_ = table.column("topic");
}

std::string ScanLines::take() {
  CsvCells cells(table_);
  RawScan scan;
  scan.stamps = {cells.stamp_ns(stamps_.header), cells.stamp_ns(stamps_.receive)};
  float* const values[] = {&scan.angle_min_rad, &scan.angle_increment_rad, &scan.time_increment_s,
                           &scan.scan_time_s,   &scan.range_min_m,         &scan.range_max_m};
  for (std::size_t i = 0; i < numbers_.size(); ++i) *values[i] = cells.number<float>(numbers_[i]);
  const std::string name = cells.text(topic_, kDefaultLaser);
  const auto [found, is_new] = topics_.try_emplace(name, raw_.topics.size(), raw_.lasers.size());
  const auto [topic, laser] = found->second;
  if (is_new) {
    raw_.topics.push_back({name, "csv/LaserScan"});
    raw_.lasers.emplace_back().topic = name;
  }
  ++raw_.topics[topic].messages;
  if (rig_.laser.topic && *rig_.laser.topic != name) return cells.problem();
  return take_beams(cells, scan, raw_.lasers[laser]);
}

std::string ScanLines::take_beams(CsvCells& cells, RawScan& scan, RawLaser& laser) {
  const std::size_t ranges_before = laser.ranges_m.size(), intensities_before = laser.intensities.size();
  scan.first_range = ranges_before;
  scan.beams = static_cast<std::uint32_t>(cells.list(ranges_, range_columns_, laser.ranges_m));
  const std::size_t intensities = cells.list(intensities_, intensity_columns_, laser.intensities);
  if (intensities != 0 && intensities != scan.beams) {
    cells.refuse(intensities_.at, std::to_string(intensities),
                 fmt::format("values, but ranges_m has {}", scan.beams));
  }
  if (!cells.problem().empty()) {
    laser.ranges_m.resize(ranges_before);
    laser.intensities.resize(intensities_before);
    return cells.problem();
  }
  laser.has_intensities = laser.has_intensities && intensities == scan.beams;
  if (!laser.has_intensities) std::vector<float>().swap(laser.intensities);
  scan.angle_max_rad = last_beam_angle_rad(scan);
  laser.scans.push_back(scan);
  beams_ += scan.beams;
  const auto more = too_much(raw_.file, beams_, 0);
  return more ? more->message : "";
}

MotorLines::MotorLines(const CsvTable& table, const Rig& rig, RawRecording& raw)
    : table_(table),
      rig_(rig),
      raw_(raw),
      stamps_(table),
      topic_(table.column("topic")),
      joint_(table.column("joint")),
      plain_(!table.has("angle_rad") && !table.has("angle_deg") && !table.has("field.position0")),
      position_(
          first_of(table, {{"angle_rad", 1}, {"angle_deg", kRadPerDeg}, {"position", 1}, {"field.data", 1}})),
      position_columns_(numbered(table, "field.position")),
      name_columns_(numbered(table, "field.name")) {}

std::string MotorLines::take() {
  CsvCells cells(table_);
  const MessageStamps stamps{cells.stamp_ns(stamps_.header), cells.stamp_ns(stamps_.receive)};
  const std::string topic = cells.text(topic_, kDefaultMotor);
  const auto [in_topics, new_topic] = topics_.try_emplace(topic, raw_.topics.size());
  if (position_columns_.empty()) {
    const double position = cells.number<double>(position_);
    if (table_.cell(position_.at).empty()) cells.refuse(position_.at, "", "is not a number");
    if (cells.problem().empty()) add(topic, cells.text(joint_, kDefaultJoint), stamps, position);
  }
  for (std::size_t i = 0; i < position_columns_.size(); ++i) {
    if (table_.cell(position_columns_[i]).empty()) continue;
    const double position = cells.number<double>(position_columns_[i]);
    const std::string name =
        i < name_columns_.size() ? cells.text(name_columns_[i], kDefaultJoint) : fmt::format("position{}", i);
    if (cells.problem().empty()) add(topic, name, stamps, position);
  }
  if (new_topic && cells.problem().empty()) raw_.topics.push_back({topic, "csv/JointState"});
  if (!cells.problem().empty()) {
    if (new_topic) topics_.erase(in_topics);
    return cells.problem();
  }
  ++raw_.topics[in_topics->second].messages;
  const auto more = too_much(raw_.file, 0, samples_);
  return more ? more->message : "";
}

void MotorLines::add(const std::string& topic, const std::string& name, const MessageStamps& stamps,
                     double position) {
  if (rig_.motor.topic && *rig_.motor.topic != topic) return;
  const auto [in_joints, new_joint] = joints_.try_emplace({topic, name}, raw_.joints.size());
  if (new_joint) {
    RawJoint& joint = raw_.joints.emplace_back();
    joint.topic = topic;
    joint.joint = name;
    joint.source = plain_ ? JointSource::kNumber : JointSource::kJointState;
  }
  if (rig_.motor.joint && *rig_.motor.joint != name) return;
  RawJoint& joint = raw_.joints[in_joints->second];
  joint.stamps.push_back(stamps);
  joint.positions.push_back(position);
  ++samples_;
}

}  // namespace sweepscope
