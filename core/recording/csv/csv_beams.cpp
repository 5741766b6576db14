#include "core/recording/csv/csv_beams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numbers.hpp"
#include "core/recording/csv/csv_cells.hpp"
#include "core/recording/messages/message_collector.hpp"

namespace sweepscope {
namespace {

constexpr double kMm_m = 1e-3;

Scaled angle_column(const CsvTable& table) {
  return first_of(table, {{"angle_rad", 1}, {"angle_deg", kRadPerDeg}, {"angle", 1}});
}

Scaled range_column(const CsvTable& table) {
  return first_of(table, {{"range_m", 1},
                          {"distance_m", 1},
                          {"range_mm", kMm_m},
                          {"distance_mm", kMm_m},
                          {"range", 1},
                          {"distance", 1}});
}

}  // namespace

bool is_beam_table(const CsvTable& table) {
  const std::size_t none = table.columns().size();
  return angle_column(table).at < none && range_column(table).at < none;
}

BeamLines::BeamLines(const CsvTable& table, RawRecording& raw)
    : table_(table),
      raw_(raw),
      stamps_(table),
      angle_(angle_column(table)),
      range_(range_column(table)),
      angle_unit_(table.columns()[angle_.at] != "angle"),
      range_unit_(table.columns()[range_.at] != "range" && table.columns()[range_.at] != "distance") {}

std::string BeamLines::take() {
  CsvCells cells(table_);
  Beam beam{{cells.stamp_ns(stamps_.header), cells.stamp_ns(stamps_.receive)},
            cells.number<double>(angle_),
            cells.number<double>(range_),
            table_.line()};
  if (table_.cell(angle_.at).empty()) cells.refuse(angle_.at, "", "is not a number");
  if (!cells.problem().empty()) return cells.problem();
  beams_.push_back(beam);
  const auto more = too_much(raw_.file, beams_.size(), 0);
  return more ? more->message : "";
}

/// What was assumed, in a sentence; empty where both units are stated.
std::string BeamLines::units_by_size(const std::string& file) {
  constexpr double kMaxAngle_rad = 7, kMaxRange_m = 200;
  double max_angle = 0;
  std::vector<double> ranges;
  for (const Beam& beam : beams_) {
    max_angle = std::max(max_angle, std::abs(beam.angle));
    if (std::isfinite(beam.range)) ranges.push_back(beam.range);
  }
  const bool degrees = !angle_unit_ && max_angle > kMaxAngle_rad;
  const bool mm = !range_unit_ && median(std::move(ranges)) > kMaxRange_m;
  for (Beam& beam : beams_) {
    if (degrees) beam.angle *= kRadPerDeg;
    if (mm) beam.range *= kMm_m;
  }
  if (angle_unit_ && range_unit_) return "";
  return fmt::format(
      "{}: by their sizes, angles are read as {} and ranges as {}; state it in the columns' names "
      "(angle_{}, range_{})",
      file, degrees || table_.has("angle_deg") ? "degrees" : "radians",
      mm || range_.factor == kMm_m ? "mm" : "m", degrees || table_.has("angle_deg") ? "deg" : "rad",
      mm || range_.factor == kMm_m ? "mm" : "m");
}

/// Places beams on a grid of even angles; false where they are not on one.
bool BeamLines::add_scan(std::size_t begin, std::size_t end, RawLaser& laser) {
  constexpr std::size_t kMinBeams = 3;
  constexpr double kMaxUneven = 0.25, kMaxUnevenPart = 0.1;
  if (end - begin < kMinBeams) return true;
  const std::span<const Beam> beams = std::span(beams_).subspan(begin, end - begin);
  const double step_rad = median(spacings(beams, &Beam::angle)), first_rad = beams.front().angle;
  const double last = std::round((beams.back().angle - first_rad) / step_rad);
  if (!(last >= 1) || last >= kMaxBeamsAScan) return false;
  RawScan scan;
  scan.stamps = beams.front().stamps;
  scan.angle_min_rad = static_cast<float>(first_rad);
  scan.angle_increment_rad = static_cast<float>((beams.back().angle - first_rad) / last);
  const MessageStamps &from = beams.front().stamps, &to = beams.back().stamps;
  const std::int64_t lasted_ns =
      from.header_ns != 0 ? to.header_ns - from.header_ns : to.receive_ns - from.receive_ns;
  scan.time_increment_s = static_cast<float>(static_cast<double>(lasted_ns) * 1e-9 / last);
  scan.first_range = laser.ranges_m.size();
  scan.beams = static_cast<std::uint32_t>(last) + 1;
  laser.ranges_m.resize(scan.first_range + scan.beams, std::numeric_limits<float>::quiet_NaN());
  std::size_t uneven = 0;
  for (const Beam& beam : beams) {
    const double at = (beam.angle - first_rad) / double{scan.angle_increment_rad};
    uneven += std::abs(at - std::round(at)) > kMaxUneven ? 1 : 0;
    const double number = std::clamp(std::round(at), 0.0, last);
    laser.ranges_m[scan.first_range + static_cast<std::size_t>(number)] = static_cast<float>(beam.range);
  }
  scan.angle_max_rad = last_beam_angle_rad(scan);
  laser.scans.push_back(scan);
  return static_cast<double>(uneven) <= kMaxUnevenPart * static_cast<double>(beams.size());
}

Result<void> BeamLines::finish(const std::string& file) {
  if (std::string assumed = units_by_size(file); !assumed.empty())
    raw_.warnings.push_back(std::move(assumed));
  RawLaser laser;
  laser.topic = "/scan";
  laser.has_intensities = false;
  std::size_t begin = 0;
  double direction = 0;
  for (std::size_t i = 1; i <= beams_.size(); ++i) {
    const double step = i < beams_.size() ? beams_[i].angle - beams_[i - 1].angle : 0;
    if (direction == 0 && i < beams_.size()) direction = step;
    if (i < beams_.size() && step * direction > 0) continue;
    if (!add_scan(begin, i, laser))
      return unreadable(fmt::format(
          "{}: lines {} to {} are one scan, and its angles are not evenly spaced; write a scan per "
          "line (angle_min_rad, angle_increment_rad, ranges_m)",
          table_.name(), beams_[begin].line, beams_[i - 1].line));
    begin = i;
    direction = 0;
  }
  raw_.topics.push_back({laser.topic, "csv/LaserScan", laser.scans.size()});
  raw_.lasers.push_back(std::move(laser));
  return {};
}

}  // namespace sweepscope
