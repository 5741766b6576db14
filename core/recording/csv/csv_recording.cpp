#include "core/recording/csv/csv_recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>

#include "core/io/atomic_file.hpp"
#include "core/io/printable_text.hpp"
#include "core/numbers.hpp"
#include "core/recording/csv/csv_beams.hpp"
#include "core/recording/csv/csv_lines.hpp"
#include "core/recording/csv/csv_table.hpp"

namespace sweepscope {
namespace {

std::string stamp_text(std::int64_t ns) {
  if (ns == 0) return "";
  return fmt::format("{}.{:09}", ns / kSecond_ns, ns % kSecond_ns);
}

/// One table of the folder, from its first line to its last.
class TableReader {
 public:
  TableReader(const std::filesystem::path& path, RawRecording& raw, const Job& job)
      : path_(path), raw_(raw), job_(job) {}

  /// Fails where the table cannot be opened, or `check` finds its columns wanting.
  Result<CsvTable> open(Result<void> (&check)(const CsvTable&, const std::string&, RawRecording&));
  /// Calls `take` for every line; it gives what is wrong with the line, or nothing.
  Result<void> read(CsvTable& table, const std::function<std::string()>& take);

 private:
  std::filesystem::path path_;
  RawRecording& raw_;
  const Job& job_;
};

Result<CsvTable> TableReader::open(Result<void> (&check)(const CsvTable&, const std::string&,
                                                         RawRecording&)) {
  auto table = CsvTable::open(path_);
  if (!table) return table;
  if (auto checked = check(*table, path_.filename().string(), raw_); !checked)
    return tl::unexpected(checked.error());
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
    raw_.warnings.push_back(fmt::format("{} is cut short in line {}, which was ignored",
                                        path_.filename().string(), table.line()));
  }
  return {};
}

Result<void> read_scans(const std::filesystem::path& path, const Rig& rig, RawRecording& raw,
                        const Job& job) {
  TableReader reader(path, raw, job);
  auto table = reader.open(check_scan_columns);
  if (!table) return tl::unexpected(std::move(table.error()));
  if (is_beam_table(*table)) {
    BeamLines beams(*table, raw);
    return reader.read(*table, [&] { return beams.take(); }).and_then([&] {
      return beams.finish(path.filename().string());
    });
  }
  ScanLines lines(*table, rig, raw);
  return reader.read(*table, [&] { return lines.take(); });
}

Result<void> read_motor(const std::filesystem::path& path, const Rig& rig, RawRecording& raw,
                        const Job& job) {
  TableReader reader(path, raw, job);
  auto table = reader.open(check_motor_columns);
  if (!table) return tl::unexpected(std::move(table.error()));
  MotorLines lines(*table, rig, raw);
  return reader.read(*table, [&] { return lines.take(); });
}

/// A name as a cell. A table's line is one record, so a line break in a name is escaped.
std::string quoted(const std::string& name) {
  const std::string text = printable_line(name);
  if (text.find_first_of(",\" \t") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell.append(c == '"' ? 2 : 1, c);
  return cell + '"';
}

Result<void> write_scans(const RawLaser& laser, AtomicFile& file, const Job& job) {
  std::string line =
      "stamp_s,receive_s,angle_min_rad,angle_increment_rad,time_increment_s,scan_time_s,range_min_m,range_"
      "max_m,topic,ranges_m,intensities\n";
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

const MessageStamps& stamps_of(const RawScan& scan) {
  return scan.stamps;
}
const MessageStamps& stamps_of(const MessageStamps& stamps) {
  return stamps;
}

/// Why the stamps of a stream cannot be seconds: from scan to scan, or from sample to sample, they advance by
/// as many ms as a scanner's or a motor's do.
template <typename Stream>
Result<void> check_unit(const Stream& stream, const std::filesystem::path& table, std::string_view what) {
  constexpr double kMinStep_s = 2, kMaxStep_s = 2000;
  for (const auto& [of_source, column] :
       {std::pair(&MessageStamps::header_ns, "stamp"), {&MessageStamps::receive_ns, "receive"}}) {
    const auto at_s = [of = of_source](const auto& message) {
      return static_cast<double>(stamps_of(message).*of) * 1e-9;
    };
    const double step_s = median(spacings(stream, at_s));
    if (stream.size() < 10 || step_s < kMinStep_s || step_s > kMaxStep_s) continue;
    return unreadable(
        fmt::format("{}: {}_s advances by {:.4g} s from {} to {}, as if it counted ms; name the "
                    "column {}_ms",
                    table.string(), column, step_s, what, what, column));
  }
  return {};
}

}  // namespace

Result<RawRecording> read_csv_recording(const std::filesystem::path& folder, const Rig& rig, const Job& job) {
  RawRecording raw;
  raw.file = folder.string();
  raw.name = (folder.has_filename() ? folder : folder.parent_path()).filename().string();
  if (auto read = read_scans(folder / kScansCsv, rig, raw, job); !read) return tl::unexpected(read.error());
  if (!rig.motor.profile)
    if (auto read = read_motor(folder / kMotorCsv, rig, raw, job); !read) return tl::unexpected(read.error());
  for (const RawLaser& laser : raw.lasers)
    if (auto checked = check_unit(laser.scans, folder / kScansCsv, "scan"); !checked)
      return tl::unexpected(checked.error());
  for (const RawJoint& joint : raw.joints)
    if (auto checked = check_unit(joint.stamps, folder / kMotorCsv, "sample"); !checked)
      return tl::unexpected(checked.error());
  return raw;
}

Result<void> write_csv_recording(const RawLaser& laser, const RawJoint& joint,
                                 const std::filesystem::path& folder, const Job& job) {
  if (laser.of_clouds) {
    return failure(ExitCode::kWrongUsage,
                   fmt::format("{}: CSV tables cannot hold clouds; write {} as MCAP or ROS 1",
                               folder.string(), laser.topic));
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return failure(ExitCode::kWrongUsage,
                   fmt::format("{}: the folder cannot be created: {}", folder.string(), error.message()));
  }
  auto scans = AtomicFile::create(folder / kScansCsv);
  if (!scans) return tl::unexpected(scans.error());
  auto motor = AtomicFile::create(folder / kMotorCsv);
  if (!motor) return tl::unexpected(motor.error());
  return write_scans(laser, *scans, job)
      .and_then([&] { return write_motor(joint, *motor); })
      .and_then([&] { return scans->flush(); })
      .and_then([&] { return motor->flush(); })
      .and_then([&] { return scans->commit(); })
      .and_then([&] { return motor->commit(); });
}

}  // namespace sweepscope
