#include "core/offset/readings/beam_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/numbers.hpp"
#include "core/offset/kind/stationary_motion.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "core/offset/search/stationary_fit.hpp"
#include "core/rig_solve/plane_cells.hpp"

namespace sweepscope {
namespace {

// Of a reading that explains the recording: little more than range noise.
constexpr double kMaxResidual_m = 0.03;
constexpr double kSmallResidual_m = 0.005;

double median_increment_s(const Recording& recording) {
  std::vector<double> increments_s;
  for (const LaserScan& scan : recording.scans) increments_s.push_back(scan.time_increment_s);
  return median(std::move(increments_s));
}

double median_beams(const Recording& recording) {
  std::vector<double> beams;
  for (const LaserScan& scan : recording.scans) beams.push_back(scan.beams);
  return median(std::move(beams));
}

// Time from the first to the last beam.
double scan_time_s(const BeamReading& reading, double beams) {
  return reading.time_increment_s * (beams - 1);
}

// A fit of the first sweeps by one reading.
StationaryFit fit_by(const Recording& recording, const Job& job) {
  StationaryFit fit = fit_stationary(recording, job);
  fit.fits = fit.fits && fit.direct.residual_m < kMaxResidual_m;
  return fit;
}

// The mean width of flat surfaces if the motor turns about an axis: what bends walls makes them narrow.
double flat_width_m(PreparedRecording prepared, const Eigen::Vector3d& axis, double offset_s) {
  constexpr std::size_t kMaxPoints = 20'000;
  Recording about = *prepared.recording;
  about.rig.mount.axis = axis;
  prepared.recording = borrowed(about);
  const OffsetProblem problem = problem_for(prepared, offset_s, offset_s);
  const StationaryPoints points =
      place_stationary(stationary_grid(problem), offset_s, StationaryDetail::kPoints);
  std::vector<Eigen::Vector3d> placed_m, some_m;
  for (std::size_t i = 0; i < points.placed.size(); ++i)
    if (points.placed[i]) placed_m.push_back(points.p_m[i]);
  for (std::size_t i = 0; i < placed_m.size(); i += placed_m.size() / kMaxPoints + 1)
    some_m.push_back(placed_m[i]);
  double sum_m = 0;
  for (const PlaneCell& cell : plane_cells(some_m, PlaneCellOptions{}))
    sum_m += double(cell.points.size()) * std::sqrt(cell.along_m.col(0).norm() * cell.along_m.col(1).norm());
  return some_m.empty() ? 0 : sum_m / double(some_m.size());
}

// Whether no other reading lies nearer to what the surfaces say of the time from the first to the last beam
// than the one that they were placed by.
bool is_nearest(const StationaryDirect& found, const std::vector<BeamReading>& readings,
                std::size_t placed_by, double beams) {
  const double own_s = scan_time_s(readings[placed_by], beams);
  return std::ranges::all_of(readings, [&](const BeamReading& other) {
    return &other == &readings[placed_by] ||
           std::abs(found.scan_time_error_s) < std::abs(scan_time_s(other, beams) - own_s) / 4;
  });
}

// Enough sweeps to see surfaces from both directions several times.
Recording first_sweeps(const Recording& recording) {
  constexpr std::size_t kSweeps = 8;
  const MotorMotion motor = find_sweeps(recording.motor);
  const double begin_s = recording.scans.front().first_beam_s;
  std::size_t sweeps = 0;
  for (const Sweep& sweep : motor.sweeps)
    if (sweep.begin_s > begin_s && ++sweeps == kSweeps) return window(recording, 0, sweep.end_s - begin_s);
  return recording;
}

// Of a rig that moves no reading fits, and the one that fits least badly says nothing.
bool moves(const Recording& first, const RankedReadings& ranked, const Job& job) {
  const BeamReading* chosen = chosen_of(ranked.beams);
  if (chosen == nullptr || !chosen->offset_s) return false;
  Recording read =
      chosen->kind == BeamReadingKind::kRecorded ? first : read_as(first, chosen->time_increment_s);
  read.rig.mount.axis = ranked.axis;
  const auto prepared = prepare(borrowed(read), FeatureOptions(), job);
  if (!prepared) return false;
  const double offset_s = *chosen->offset_s;
  return test_motion(stationary_grid(problem_for(*prepared, offset_s, offset_s)), offset_s).moving();
}

}  // namespace

std::span<const BeamReadingEntry> beam_reading_entries() {
  using enum BeamReadingKind;
  static constexpr std::array kEntries{
      BeamReadingEntry{kRecorded, "recorded", "the beams are timed as recorded"},
      BeamReadingEntry{kReversed, "reversed", "the last beam of a message was fired first"},
      BeamReadingEntry{kAtOnce, "at_once", "all beams of a message were fired at once"},
      BeamReadingEntry{kMirror, "mirror", "the mirror turns once from scan to scan"},
      BeamReadingEntry{
          kMirrorReversed, "mirror_reversed",
          "the mirror turns once from scan to scan, and the last beam of a message was fired first"},
      BeamReadingEntry{kPeriod, "period", "a scan takes all of the time from scan to scan"},
      BeamReadingEntry{
          kPeriodReversed, "period_reversed",
          "a scan takes all of the time from scan to scan, and the last beam of a message was fired first"}};
  return kEntries;
}

const BeamReadingEntry& entry_of(BeamReadingKind kind) {
  return beam_reading_entries()[static_cast<std::size_t>(kind)];
}

const BeamReading* chosen_of(const std::vector<BeamReading>& readings) {
  const auto found = std::ranges::find_if(readings, &BeamReading::chosen);
  return found == readings.end() ? nullptr : &*found;
}

std::string reading_in_words(const std::vector<BeamReading>& readings) {
  const BeamReading* chosen = chosen_of(readings);
  if (chosen == nullptr || !chosen->residual_m) return "";
  std::string others;
  for (const BeamReading& reading : readings) {
    if (reading.chosen || !reading.residual_m) continue;
    std::string name = entry_of(reading.kind).name;
    std::ranges::replace(name, '_', ' ');
    others +=
        fmt::format("{} {} {:.1f} mm", others.empty() ? "; others:" : ",", name, *reading.residual_m * 1e3);
  }
  return fmt::format("{}: surfaces fit to {:.1f} mm{}", entry_of(chosen->kind).description,
                     *chosen->residual_m * 1e3, others);
}

std::vector<BeamReading> possible_readings(const Recording& recording) {
  constexpr double kAlike = 0.1;  // of the longer of two
  const LaserScan& scan = recording.scans.front();
  const double increment_s = median_increment_s(recording),
               period_s = recording.report.laser_stamps.median_period_s,
               of_mirror_s = period_s * std::abs(scan.angle_increment_rad) / (2 * std::numbers::pi),
               of_period_s = period_s / median_beams(recording);
  const double in_array = recording.report.fired_backwards ? -1 : 1;  // from the order of time
  std::vector<BeamReading> readings;
  // A negative increment in the messages states the order of their beams.
  if (recording.report.fired_backwards && !recording.rig.laser.time_increment_s)
    return {{BeamReadingKind::kRecorded, -increment_s, {}, {}, false}};
  for (const auto& [kind, time_increment_s] : {std::pair{BeamReadingKind::kRecorded, increment_s},
                                               {BeamReadingKind::kReversed, -increment_s},
                                               {BeamReadingKind::kAtOnce, 0.0},
                                               {BeamReadingKind::kMirror, of_mirror_s},
                                               {BeamReadingKind::kMirrorReversed, -of_mirror_s},
                                               {BeamReadingKind::kPeriod, of_period_s},
                                               {BeamReadingKind::kPeriodReversed, -of_period_s}}) {
    const bool listed = std::ranges::any_of(readings, [&](const BeamReading& other) {
      const double longer_s = std::max(std::abs(other.time_increment_s), std::abs(time_increment_s));
      return std::abs(other.time_increment_s - time_increment_s) <= kAlike * longer_s;
    });
    if (!listed) readings.push_back({kind, time_increment_s, {}, {}, false});
  }
  for (BeamReading& reading : readings) reading.time_increment_s *= in_array;
  return readings;
}

Recording read_as(const Recording& recording, double time_increment_s) {
  Recording read = recording;
  const bool reversed = time_increment_s != 0 && (time_increment_s < 0) != recording.report.fired_backwards,
             first = recording.rig.laser.stamp_at == StampAt::kFirstBeam;
  for (LaserScan& scan : read.scans) {
    const double stamp_s = first ? scan.first_beam_s : scan.last_beam_s();
    scan.time_increment_s = std::abs(time_increment_s);
    const double duration_s = scan.last_beam_s() - scan.first_beam_s;
    scan.first_beam_s = first ? stamp_s : stamp_s - duration_s;
    if (!reversed) continue;
    const auto ranges = read.ranges_m.begin() + std::ptrdiff_t(scan.first_range);
    std::reverse(ranges, ranges + scan.beams);
    scan.angle_min_rad = scan.beam_angle_rad(scan.beams - 1.0);
    scan.angle_increment_rad = -scan.angle_increment_rad;
  }
  read.intensities.clear();
  return read;
}

namespace {

// By one axis, of the first sweeps of a recording.
std::vector<BeamReading> rank_beams(const Recording& first, const Job& job) {
  std::vector<BeamReading> readings = possible_readings(first);
  if (first.rig.laser.time_increment_s) readings.resize(1);  // stated, and not overruled
  const double beams = median_beams(first);
  std::vector<StationaryFit> fits;
  for (BeamReading& reading : readings) {
    const bool recorded = &reading == &readings.front();
    fits.push_back(fit_by(recorded ? first : read_as(first, reading.time_increment_s), job));
    if (job.cancelled()) return {};
    const StationaryFit& fit = fits.back();
    if (fit.direct.matches > 0) reading.residual_m = fit.direct.residual_m;
    if (fit.fits) reading.offset_s = fit.direct.offset_s;
    const bool explains = fit.fits && is_nearest(fit.direct, readings, fits.size() - 1, beams);
    if (!recorded || !explains || fit.direct.residual_m > kSmallResidual_m) continue;
    readings.front().chosen = true;
    readings.resize(1);
    return readings;
  }
  const auto residual_m = [&](std::size_t i) {
    return fits[i].fits ? fits[i].direct.residual_m : kMaxResidual_m / kClearlyBetter;
  };
  std::size_t best = 0, next = 0;
  for (std::size_t i = 1; i < fits.size(); ++i)
    if (residual_m(i) < residual_m(best)) best = i;
  for (std::size_t i = 0; i < fits.size(); ++i)
    if (i != best && (next == best || residual_m(i) < residual_m(next))) next = i;
  if (!fits[best].fits) return {};
  const auto agrees = [&](std::size_t i) {
    return fits[i].fits && is_nearest(fits[i].direct, readings, i, beams);
  };
  const auto as_good = [&](std::size_t i) { return residual_m(best) > kClearlyBetter * residual_m(i); };
  // Of readings that fit about as well, one alone may agree with what its own distances say of the scan's
  // time; otherwise what is recorded holds if it does.
  std::size_t agreeing = 0;
  for (std::size_t i = 0; i < fits.size(); ++i) agreeing += as_good(i) && agrees(i) ? 1 : 0;
  if (!agrees(best) || agreeing > 1) {
    if (agrees(0) && as_good(0))
      best = 0;
    else if (as_good(next))
      return readings;
  }
  readings[best].chosen = true;
  return readings;
}

RankedReadings rank_as_stationary(const Recording& first, const Job& job) {
  // A sparse cloud's surfaces have widths by chance, so that much nearer sweeps overrule them.
  constexpr double kClearlyWider = 1.15, kNearer = 0.7, kMuchNearer = 0.5;
  RankedReadings ranked;
  ranked.axis = first.rig.mount.axis;
  ranked.beams = rank_beams(first, job);
  if (first.rig.states_mount() || job.cancelled()) return ranked;
  Recording about_y = first;
  about_y.rig.mount.axis = Eigen::Vector3d::UnitY();
  const BeamReading* best = chosen_of(ranked.beams);
  std::vector<BeamReading> of_y;
  if (best == nullptr) {
    of_y = rank_beams(about_y, job);
    best = chosen_of(of_y);
  }
  if (best == nullptr || job.cancelled()) return ranked;
  const bool recorded = best->kind == BeamReadingKind::kRecorded;
  const auto prepared =
      prepare(std::make_shared<const Recording>(recorded ? first : read_as(first, best->time_increment_s)),
              FeatureOptions(), job);
  if (!prepared) return ranked;
  const double of_x_m = flat_width_m(*prepared, first.rig.mount.axis, *best->offset_s),
               of_y_m = flat_width_m(*prepared, about_y.rig.mount.axis, *best->offset_s);
  const BeamReading* const best_x = chosen_of(ranked.beams);
  const bool explained = best_x != nullptr && *best_x->residual_m < kSmallResidual_m;
  if (of_y_m < of_x_m && explained) return ranked;
  if (of_y.empty()) of_y = rank_beams(about_y, job);
  const BeamReading* const best_y = chosen_of(of_y);
  const auto nearer_by = [&](double factor) {
    return best_y != nullptr && (best_x == nullptr || *best_y->residual_m < factor * *best_x->residual_m);
  };
  const bool about_y_axis =
      of_y_m < of_x_m ? nearer_by(kMuchNearer) : nearer_by(kNearer) || of_y_m >= kClearlyWider * of_x_m;
  if (!about_y_axis) return ranked;
  ranked.beams = std::move(of_y);
  ranked.axis = about_y.rig.mount.axis;
  ranked.axis_is_found = true;
  return ranked;
}

}  // namespace

RankedReadings rank_readings(const Recording& recording, const Job& job) {
  RankedReadings as_read;
  as_read.axis = recording.rig.mount.axis;
  if (!recording.directions.empty() || recording.scans.empty() || recording.ranges_m.empty()) return as_read;
  const Recording first = first_sweeps(recording);
  RankedReadings ranked = rank_as_stationary(first, job);
  return moves(first, ranked, job) ? as_read : ranked;
}

std::optional<BeamReading> better_reading(const Recording& recording, const StationaryDirect& found) {
  constexpr double kMinFormalSigmas = 10;
  if (!recording.directions.empty() || recording.scans.empty()) return std::nullopt;
  if (std::abs(found.scan_time_error_s) < kMinFormalSigmas * found.scan_time_formal_sigma_s)
    return std::nullopt;
  const double beams = median_beams(recording);
  const std::vector<BeamReading> readings = possible_readings(recording);
  const double in_array = recording.report.fired_backwards ? -1 : 1;
  const double shown_s = scan_time_s(readings.front(), beams) + in_array * found.scan_time_error_s;
  const auto nearest = std::ranges::min_element(readings, {}, [&](const BeamReading& reading) {
    return std::abs(scan_time_s(reading, beams) - shown_s);
  });
  if (nearest == readings.begin()) return std::nullopt;
  return *nearest;
}

}  // namespace sweepscope
