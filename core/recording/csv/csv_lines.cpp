#include "core/recording/csv/csv_lines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "core/numbers.hpp"
#include "core/recording/messages/message_collector.hpp"

namespace sweepscope {
namespace {

constexpr std::int64_t kLastSecond = 9'000'000'000;  // what fits into 63 bits of nanoseconds
constexpr const char* kDefaultLaser = "/scan";
constexpr const char* kDefaultMotor = "/joint_states";
constexpr const char* kDefaultJoint = "motor";

/// "12.5" as 12'500'000'000, digit by digit: a double holds no nanoseconds since 1970.
std::optional<std::int64_t> parse_stamp_ns(std::string_view text) {
  std::int64_t seconds = 0;
  const char* const end = text.data() + text.size();
  const auto [after, error] = std::from_chars(text.data(), end, seconds);
  if (error != std::errc() || seconds < 0 || seconds > kLastSecond || text.front() == '-')
    return std::nullopt;
  std::int64_t ns = seconds * kSecond_ns;
  if (after == end) return ns;
  if (*after != '.') return std::nullopt;
  std::int64_t unit_ns = kSecond_ns / 10;
  for (const char* digit = after + 1; digit < end; ++digit, unit_ns /= 10) {
    if (*digit < '0' || *digit > '9') return std::nullopt;
    ns += unit_ns * (*digit - '0');
  }
  return ns;
}

}  // namespace

/// Reads the cells of a line; the first that is wrong is kept as the problem.
class Cells {
 public:
  explicit Cells(const CsvTable& table) : table_(table) {}

  std::int64_t stamp_ns(std::size_t column) {
    const std::string_view text = table_.cell(column);
    if (text.empty()) return 0;
    const auto ns = parse_stamp_ns(text);
    if (!ns) refuse(column, text, "is not a time in decimal seconds (0 or more)");
    return ns.value_or(0);
  }
  /// 0 where the cell is empty.
  template <typename T>
  T number(std::size_t column) {
    const std::string_view text = table_.cell(column);
    T value = 0;
    if (!text.empty() && !parse(text, value)) refuse(column, text, "is not a number");
    return value;
  }
  /// Appends numbers with spaces between them, and gives how many.
  std::size_t list(std::size_t column, std::vector<float>& numbers) {
    std::string_view rest = table_.cell(column);
    const std::size_t before = numbers.size();
    while (!rest.empty()) {
      const std::string_view word = rest.substr(0, rest.find(' '));
      rest.remove_prefix(std::min(rest.size(), word.size() + 1));
      if (word.empty()) continue;
      if (!parse(word, numbers.emplace_back())) {
        refuse(column, word, "is not a number");
        break;
      }
    }
    return numbers.size() - before;
  }
  std::string text(std::size_t column, const char* otherwise) const {
    const std::string_view text = table_.cell(column);
    return text.empty() ? otherwise : std::string(text);
  }
  void refuse(std::size_t column, std::string_view text, std::string_view why) {
    constexpr std::size_t kMaxQuoted = 40;
    if (problem_.empty())
      problem_ = fmt::format("{}: \"{}\" {}", table_.place(column), text.substr(0, kMaxQuoted), why);
  }
  const std::string& problem() const { return problem_; }

 private:
  template <typename T>
  static bool parse(std::string_view text, T& value) {
    const char* const end = text.data() + text.size();
    const auto [after, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && after == end;
  }

  const CsvTable& table_;
  std::string problem_;
};

namespace {

using Names = std::vector<std::string_view>;

Result<void> check_columns(const CsvTable& table, const std::vector<Names>& needed, const Names& known,
                           const std::string& file, RawRecording& raw) {
  const auto has = [&](std::string_view name) { return table.column(name) < table.columns().size(); };
  for (const Names& group : needed) {
    if (std::ranges::any_of(group, has)) continue;
    return unreadable(fmt::format("{} has no column {}; its columns are: {}", table.place(),
                                  fmt::join(group, " or "), fmt::join(table.columns(), ", ")));
  }
  std::vector<std::string> unknown;
  for (const std::string& name : table.columns())
    if (std::ranges::find(known, name) == known.end()) unknown.push_back(name);
  if (!unknown.empty()) {
    raw.warnings.push_back(
        fmt::format("{} has unknown columns, which were ignored: {}", file, fmt::join(unknown, ", ")));
  }
  return {};
}

}  // namespace

Result<void> check_scan_columns(const CsvTable& table, const std::string& file, RawRecording& raw) {
  return check_columns(table,
                       {{"stamp_s", "receive_s"}, {"angle_min_rad"}, {"angle_increment_rad"}, {"ranges_m"}},
                       {"stamp_s", "receive_s", "angle_min_rad", "angle_increment_rad", "time_increment_s",
                        "scan_time_s", "range_min_m", "range_max_m", "ranges_m", "intensities", "topic"},
                       file, raw);
}

Result<void> check_motor_columns(const CsvTable& table, const std::string& file, RawRecording& raw) {
  return check_columns(table, {{"stamp_s", "receive_s"}, {"angle_rad", "angle_deg", "position"}},
                       {"stamp_s", "receive_s", "angle_rad", "angle_deg", "position", "topic", "joint"}, file,
                       raw);
}

ScanLines::ScanLines(const CsvTable& table, const Rig& rig, RawRecording& raw)
    : table_(table), rig_(rig), raw_(raw), stamps_(table) {
  static constexpr const char* kNames[] = {"angle_min_rad", "angle_increment_rad", "time_increment_s",
                                           "scan_time_s",   "range_min_m",         "range_max_m"};
  for (std::size_t i = 0; i < std::size(kNames); ++i) numbers_[i] = table.column(kNames[i]);
  ranges_ = table.column("ranges_m");
  intensities_ = table.column("intensities");
  topic_ = table.column("topic");
}

std::string ScanLines::take() {
  Cells cells(table_);
  RawScan scan;
  scan.stamps = {cells.stamp_ns(stamps_.header), cells.stamp_ns(stamps_.receive)};
  float* const values[] = {&scan.angle_min_rad, &scan.angle_increment_rad, &scan.time_increment_s,
                           &scan.scan_time_s,   &scan.range_min_m,         &scan.range_max_m};
  for (std::size_t i = 0; i < std::size(values); ++i) *values[i] = cells.number<float>(numbers_[i]);
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

std::string ScanLines::take_beams(Cells& cells, RawScan& scan, RawLaser& laser) {
  const std::size_t ranges_before = laser.ranges_m.size(), intensities_before = laser.intensities.size();
  scan.first_range = ranges_before;
  scan.beams = static_cast<std::uint32_t>(cells.list(ranges_, laser.ranges_m));
  const std::size_t intensities = cells.list(intensities_, laser.intensities);
  if (intensities != 0 && intensities != scan.beams) {
    cells.refuse(intensities_, std::to_string(intensities),
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
      joint_(table.column("joint")) {
  for (const char* name : {"angle_rad", "angle_deg", "position"}) {
    position_ = table.column(name);
    degrees_ = name == std::string_view("angle_deg");
    plain_ = name == std::string_view("position");
    if (position_ < table.columns().size()) break;
  }
}

std::string MotorLines::take() {
  Cells cells(table_);
  const MessageStamps stamps{cells.stamp_ns(stamps_.header), cells.stamp_ns(stamps_.receive)};
  double position = cells.number<double>(position_);
  if (table_.cell(position_).empty()) cells.refuse(position_, "", "is not a number");
  if (degrees_) position *= kRadPerDeg;
  if (!cells.problem().empty()) return cells.problem();
  const std::string topic = cells.text(topic_, kDefaultMotor), name = cells.text(joint_, kDefaultJoint);
  const auto [in_topics, new_topic] = topics_.try_emplace(topic, raw_.topics.size());
  if (new_topic) raw_.topics.push_back({topic, "csv/JointState"});
  ++raw_.topics[in_topics->second].messages;
  if (rig_.motor.topic && *rig_.motor.topic != topic) return "";
  const auto [in_joints, new_joint] = joints_.try_emplace({topic, name}, raw_.joints.size());
  if (new_joint) {
    RawJoint& joint = raw_.joints.emplace_back();
    joint.topic = topic;
    joint.joint = name;
    joint.source = plain_ ? JointSource::kNumber : JointSource::kJointState;
  }
  if (rig_.motor.joint && *rig_.motor.joint != name) return "";
  RawJoint& joint = raw_.joints[in_joints->second];
  joint.stamps.push_back(stamps);
  joint.positions.push_back(position);
  const auto more = too_much(raw_.file, 0, ++samples_);
  return more ? more->message : "";
}

}  // namespace sweepscope
