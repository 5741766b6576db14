#include "core/recording/csv_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>
#include <numbers>

#include "core/io/atomic_file.hpp"
#include "core/recording/csv_table.hpp"
#include "core/recording/message_collector.hpp"

namespace sweepscope {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
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
  std::int64_t ns = seconds * kNanosecondsPerSecond;
  if (after == end) return ns;
  if (*after != '.') return std::nullopt;
  std::int64_t unit_ns = kNanosecondsPerSecond / 10;
  for (const char* digit = after + 1; digit < end; ++digit, unit_ns /= 10) {
    if (*digit < '0' || *digit > '9') return std::nullopt;
    ns += unit_ns * (*digit - '0');
  }
  return ns;
}

std::string stamp_text(std::int64_t ns) {
  if (ns == 0) return "";
  return fmt::format("{}.{:09}", ns / kNanosecondsPerSecond, ns % kNanosecondsPerSecond);
}

/// Reads the cells of a line; the first that is wrong is kept as the problem.
class Cells {
 public:
  explicit Cells(const CsvTable& table) : table_(table) {}

  std::int64_t stamp_ns(std::size_t column) {
    const std::string_view text = table_.cell(column);
    if (text.empty()) return 0;
    const auto ns = parse_stamp_ns(text);
    if (!ns) refuse(column, text, "is no time in decimal seconds from 0 on");
    return ns.value_or(0);
  }
  /// 0 where the cell is empty.
  template <typename T>
  T number(std::size_t column) {
    const std::string_view text = table_.cell(column);
    T value = 0;
    if (!text.empty() && !parse(text, value)) refuse(column, text, "is no number");
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
        refuse(column, word, "is no number");
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
    constexpr std::size_t kMostQuoted = 40;
    if (problem_.empty())
      problem_ = fmt::format("{}: \"{}\" {}", table_.place(column), text.substr(0, kMostQuoted), why);
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

/// Where one of the two tables' columns are; those that are not there are beyond the last.
struct StampColumns {
  std::size_t header, receive;

  explicit StampColumns(const CsvTable& table)
      : header(table.column("stamp_s")), receive(table.column("receive_s")) {}
};

/// One table of the folder, from its first line to its last.
class TableReader {
 public:
  TableReader(const std::filesystem::path& path, RawRecording& raw, const Job& job)
      : path_(path), raw_(raw), job_(job) {}

  /// Fails where the table cannot be opened, or has neither of the stamps, or not one of each group of names.
  Result<CsvTable> open(const std::vector<std::vector<std::string_view>>& needed,
                        const std::vector<std::string_view>& known);
  /// Calls `take` for every line; it gives what is wrong with the line, or nothing.
  Result<void> read(CsvTable& table, const std::function<std::string()>& take);

 private:
  std::filesystem::path path_;
  RawRecording& raw_;
  const Job& job_;
};

Result<CsvTable> TableReader::open(const std::vector<std::vector<std::string_view>>& needed,
                                   const std::vector<std::string_view>& known) {
  auto table = CsvTable::open(path_);
  if (!table) return table;
  const auto has = [&](std::string_view name) { return table->column(name) < table->columns().size(); };
  for (const auto& group : needed) {
    if (std::ranges::any_of(group, has)) continue;
    return unreadable(fmt::format("{}: line 1 names no column {}; it names: {}", path_.string(),
                                  fmt::join(group, " or "), fmt::join(table->columns(), ", ")));
  }
  std::vector<std::string> unknown;
  for (const std::string& name : table->columns())
    if (std::ranges::find(known, name) == known.end()) unknown.push_back(name);
  if (!unknown.empty()) {
    raw_.warnings.push_back(fmt::format("{} has columns that are not known and were left aside: {}",
                                        path_.filename().string(), fmt::join(unknown, ", ")));
  }
  return table;
}

Result<void> TableReader::read(CsvTable& table, const std::function<std::string()>& take) {
  constexpr std::size_t kLinesPerReport = 256;
  bool cut = false;
  while (true) {
    const auto more = table.next();
    if (!more) return tl::unexpected(more.error());
    if (!*more) break;
    const std::string problem = take();
    if (!problem.empty() && !table.at_unended_line()) return unreadable(problem);
    cut = !problem.empty();
    if (table.line() % kLinesPerReport != 0) continue;
    job_.report("reading", table.fraction_read());
    if (job_.cancelled())
      return failure(ExitCode::kInterrupted, fmt::format("{}: reading was interrupted", path_.string()));
  }
  if (cut || table.cut_short()) {
    raw_.warnings.push_back(fmt::format("{} is cut short in line {}, which was left aside",
                                        path_.filename().string(), table.line()));
  }
  return {};
}

/// The lasers of scans.csv.
class ScanLines {
 public:
  ScanLines(const CsvTable& table, const Rig& rig, RawRecording& raw)
      : table_(table), rig_(rig), raw_(raw), stamps_(table) {
    static constexpr const char* kNames[] = {"angle_min_rad", "angle_increment_rad", "time_increment_s",
                                             "scan_time_s",   "range_min_m",         "range_max_m"};
    for (std::size_t i = 0; i < std::size(kNames); ++i) numbers_[i] = table.column(kNames[i]);
    ranges_ = table.column("ranges_m");
    intensities_ = table.column("intensities");
    topic_ = table.column("topic");
  }

  std::string take();
  std::size_t beams() const { return beams_; }

 private:
  std::size_t laser_of(const std::string& topic);
  std::string take_beams(Cells& cells, RawScan& scan, RawLaser& laser);

  const CsvTable& table_;
  const Rig& rig_;
  RawRecording& raw_;
  StampColumns stamps_;
  std::size_t numbers_[6], ranges_, intensities_, topic_;
  std::map<std::string, std::pair<std::size_t, std::size_t>> topics_;  // in topics and in lasers
  std::size_t beams_ = 0;
};

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
                 fmt::format("values stand beside {} in ranges_m", scan.beams));
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

/// The joints of motor.csv.
class MotorLines {
 public:
  MotorLines(const CsvTable& table, const Rig& rig, RawRecording& raw)
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

  std::string take();

 private:
  const CsvTable& table_;
  const Rig& rig_;
  RawRecording& raw_;
  StampColumns stamps_;
  std::size_t topic_, joint_, position_ = 0;
  bool degrees_ = false, plain_ = false;
  std::map<std::string, std::size_t> topics_;
  std::map<std::pair<std::string, std::string>, std::size_t> joints_;
  std::size_t samples_ = 0;
};

std::string MotorLines::take() {
  Cells cells(table_);
  const MessageStamps stamps{cells.stamp_ns(stamps_.header), cells.stamp_ns(stamps_.receive)};
  double position = cells.number<double>(position_);
  if (table_.cell(position_).empty()) cells.refuse(position_, "", "is no number");
  if (degrees_) position *= std::numbers::pi / 180;
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

Result<void> read_scans(const std::filesystem::path& path, const Rig& rig, RawRecording& raw,
                        const Job& job) {
  TableReader reader(path, raw, job);
  auto table =
      reader.open({{"stamp_s", "receive_s"}, {"angle_min_rad"}, {"angle_increment_rad"}, {"ranges_m"}},
                  {"stamp_s", "receive_s", "angle_min_rad", "angle_increment_rad", "time_increment_s",
                   "scan_time_s", "range_min_m", "range_max_m", "ranges_m", "intensities", "topic"});
  if (!table) return tl::unexpected(std::move(table.error()));
  ScanLines lines(*table, rig, raw);
  return reader.read(*table, [&] { return lines.take(); });
}

Result<void> read_motor(const std::filesystem::path& path, const Rig& rig, RawRecording& raw,
                        const Job& job) {
  TableReader reader(path, raw, job);
  auto table = reader.open({{"stamp_s", "receive_s"}, {"angle_rad", "angle_deg", "position"}},
                           {"stamp_s", "receive_s", "angle_rad", "angle_deg", "position", "topic", "joint"});
  if (!table) return tl::unexpected(std::move(table.error()));
  MotorLines lines(*table, rig, raw);
  return reader.read(*table, [&] { return lines.take(); });
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\" \t") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell.append(c == '"' ? 2 : 1, c);
  return cell + '"';
}

Result<void> write_scans(const RawLaser& laser, AtomicFile& file, const Job& job) {
  std::string line =
      "stamp_s,receive_s,angle_min_rad,angle_increment_rad,time_increment_s,scan_time_s,range_min_m,"
      "range_max_m,topic,ranges_m,intensities\n";
  for (std::size_t i = 0; i < laser.scans.size(); ++i) {
    const RawScan& scan = laser.scans[i];
    line += fmt::format("{},{},{},{},{},{},{},{},{},", stamp_text(scan.stamps.header_ns),
                        stamp_text(scan.stamps.receive_ns), scan.angle_min_rad, scan.angle_increment_rad,
                        scan.time_increment_s, scan.scan_time_s, scan.range_min_m, scan.range_max_m,
                        quoted(laser.topic));
    const auto beams = std::span(laser.ranges_m).subspan(scan.first_range, scan.beams);
    line += fmt::format("{},", fmt::join(beams, " "));
    if (laser.has_intensities)
      line += fmt::format("{}",
                          fmt::join(std::span(laser.intensities).subspan(scan.first_range, scan.beams), " "));
    line += '\n';
    if (auto written = file.write(line); !written) return written;
    line.clear();
    job.report("writing", static_cast<double>(i + 1) / static_cast<double>(laser.scans.size()));
    if (job.cancelled()) return failure(ExitCode::kInterrupted, "interrupted");
  }
  return {};
}

Result<void> write_motor(const RawJoint& joint, AtomicFile& file) {
  const bool plain = joint.source == JointSource::kNumber;
  std::string lines = fmt::format("stamp_s,receive_s,{},topic,joint\n", plain ? "position" : "angle_rad");
  for (std::size_t i = 0; i < joint.stamps.size(); ++i) {
    lines += fmt::format("{},{},{},{},{}\n", stamp_text(joint.stamps[i].header_ns),
                         stamp_text(joint.stamps[i].receive_ns), joint.positions[i], quoted(joint.topic),
                         quoted(joint.joint));
  }
  return file.write(lines);
}

}  // namespace

Result<RawRecording> read_csv_recording(const std::filesystem::path& folder, const Rig& rig, const Job& job) {
  RawRecording raw;
  raw.file = folder.string();
  raw.name = (folder.has_filename() ? folder : folder.parent_path()).filename().string();
  if (auto read = read_scans(folder / kScansCsv, rig, raw, job); !read) return tl::unexpected(read.error());
  if (auto read = read_motor(folder / kMotorCsv, rig, raw, job); !read) return tl::unexpected(read.error());
  return raw;
}

Result<void> write_csv_recording(const RawLaser& laser, const RawJoint& joint,
                                 const std::filesystem::path& folder, const Job& job) {
  if (laser.of_clouds) {
    return failure(ExitCode::kWrongUsage,
                   fmt::format("{}: the tables have no place for clouds; write {} as MCAP or ROS 1",
                               folder.string(), laser.topic));
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return failure(ExitCode::kWrongUsage,
                   fmt::format("{}: cannot be made a folder: {}", folder.string(), error.message()));
  }
  auto scans = AtomicFile::create(folder / kScansCsv);
  if (!scans) return tl::unexpected(scans.error());
  auto motor = AtomicFile::create(folder / kMotorCsv);
  if (!motor) return tl::unexpected(motor.error());
  return write_scans(laser, *scans, job)
      .and_then([&] { return write_motor(joint, *motor); })
      .and_then([&] { return scans->commit(); })
      .and_then([&] { return motor->commit(); });
}

}  // namespace sweepscope
