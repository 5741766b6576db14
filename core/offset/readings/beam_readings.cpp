#include "core/offset/readings/beam_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "core/numbers.hpp"
#include "core/offset/judgement/unseen_sigma.hpp"
#include "core/offset/kind/stationary_motion.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "core/offset/search/stationary_fit.hpp"
#include "core/rig_solve/plane_cells.hpp"
#include "core/uncertainty.hpp"

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

// See beam_times.hpp.
bool is_of_mirror(double increment_s, double of_mirror_s) {
  constexpr double kAlike = 1.25;
  return increment_s < kAlike * of_mirror_s && of_mirror_s < kAlike * increment_s;
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
  // Of the longer of two; a guess may be wrong by some percent, which shift the offset by half a millisecond.
  const bool guessed = recording.report.beam_time_doubt_s > 0;
  const double alike = guessed ? 0.02 : 0.1;
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
  const auto list = [&](BeamReadingKind kind, double time_increment_s) {
    const bool listed = std::ranges::any_of(readings, [&](const BeamReading& other) {
      const double longer_s = std::max(std::abs(other.time_increment_s), std::abs(time_increment_s));
      return std::abs(other.time_increment_s - time_increment_s) <= alike * longer_s;
    });
    if (!listed) readings.push_back({kind, time_increment_s, {}, {}, false});
  };
  list(BeamReadingKind::kRecorded, increment_s);
  list(BeamReadingKind::kReversed, -increment_s);
  list(BeamReadingKind::kAtOnce, 0);
  if (guessed || !is_of_mirror(increment_s, of_mirror_s)) {
    list(BeamReadingKind::kMirror, of_mirror_s);
    list(BeamReadingKind::kMirrorReversed, -of_mirror_s);
    list(BeamReadingKind::kPeriod, of_period_s);
    list(BeamReadingKind::kPeriodReversed, -of_period_s);
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

// The second unknown of the true reading was at most 3.5 of its deviations in 173 recordings of
// tests/benchmark/random_readings 0:300, that of others usually more.
constexpr double kMaxScanTimeSigmas = 4;

double scan_time_sigmas(const StationaryDirect& found) {
  const double sigma_s = found.scan_time_sigma_s;
  return sigma_s > 0 ? std::abs(found.scan_time_error_s) / sigma_s : 0;
}

// Whether the sectors of the motor's angle agree that one reading's distances are shorter than another's. How
// rough the surfaces are cancels; where their roughness decides, the sectors disagree.
bool clearly_shorter(const StationaryDirect& one, const StationaryDirect& other) {
  constexpr double kSigmas =
      3;                       // 0.01 of sectors that differ by chance; of 173 true readings, none is longer
  std::vector<double> ratios;  // logarithms
  double sum = 0;
  for (std::size_t i = 0; i < std::min(one.sector_residual_m.size(), other.sector_residual_m.size()); ++i) {
    if (!(one.sector_residual_m[i] > 0) || !(other.sector_residual_m[i] > 0)) continue;
    sum += ratios.emplace_back(std::log(other.sector_residual_m[i] / one.sector_residual_m[i]));
  }
  const auto sigma = block_sigma(ratios, 1, ratios.size());
  return sigma && sum / double(ratios.size()) > kSigmas * *sigma;
}

// By one axis: the readings, and what is left in doubt.
struct RankedBeams {
  std::vector<BeamReading> readings;
  double offset_doubt_s = 0;
  double least_m = std::numeric_limits<double>::infinity();  // residual, of readings that do not fit as well

  // The chosen one, or, where nothing is decided, the one that fits best.
  const BeamReading* best() const {
    if (const BeamReading* chosen = chosen_of(readings)) return chosen;
    const BeamReading* best = nullptr;
    for (const BeamReading& reading : readings)
      if (reading.offset_s && (best == nullptr || *reading.residual_m < *best->residual_m)) best = &reading;
    return best;
  }
};

// Those that fit and that nothing contradicts: their own second unknown, or another one that fits clearly
// better.
std::vector<std::size_t> uncontradicted(const std::vector<StationaryFit>& fits) {
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const bool longer = std::ranges::any_of(fits, [&](const StationaryFit& other) {
      return other.fits && clearly_shorter(other.direct, fits[i].direct);
    });
    if (fits[i].fits && !longer && scan_time_sigmas(fits[i].direct) < kMaxScanTimeSigmas) left.push_back(i);
  }
  return left;
}

// Of the readings that nothing contradicts, or where there are none of all that fit.
double range_of_offsets_s(const std::vector<StationaryFit>& fits, const std::vector<std::size_t>& left) {
  std::vector<double> offsets_s;
  for (const std::size_t i : left) offsets_s.push_back(fits[i].direct.offset_s);
  if (left.empty())
    for (const StationaryFit& fit : fits)
      if (fit.fits) offsets_s.push_back(fit.direct.offset_s);
  const auto [min, max] = std::ranges::minmax(offsets_s);
  return max - min;
}

RankedBeams rank_beams(const Recording& first, const Job& job) {
  RankedBeams ranked{possible_readings(first)};
  std::vector<BeamReading>& readings = ranked.readings;
  if (first.rig.laser.time_increment_s) readings.resize(1);  // stated, and not overruled
  const double beams = median_beams(first);
  // Sparse sweeps fit about as well by a wrong reading, but clearly better by the right one.
  const bool sparse = has_sparse_sweeps(first, find_sweeps(first.motor));
  std::vector<StationaryFit> fits;
  for (BeamReading& reading : readings) {
    const bool recorded = &reading == &readings.front();
    fits.push_back(fit_by(recorded ? first : read_as(first, reading.time_increment_s), job));
    if (job.cancelled()) return {};
    const StationaryFit& fit = fits.back();
    if (fit.direct.matches > 0) {
      reading.residual_m = fit.direct.residual_m;
      ranked.least_m = std::min(ranked.least_m, fit.direct.residual_m);
    }
    if (fit.fits) reading.offset_s = fit.direct.offset_s;
    const bool explains = fit.fits && is_nearest(fit.direct, readings, fits.size() - 1, beams) &&
                          scan_time_sigmas(fit.direct) < kMaxScanTimeSigmas;
    if (!recorded || !explains || sparse || fit.direct.residual_m > kSmallResidual_m) continue;
    readings.front().chosen = true;
    readings.resize(1);
    return ranked;
  }
  if (std::ranges::none_of(fits, &StationaryFit::fits)) return {{}, 0, ranked.least_m};
  const std::vector<std::size_t> left = uncontradicted(fits);
  const bool stated = first.report.beam_time_doubt_s == 0;  // by the messages
  if (left.size() == 1 || (!left.empty() && left.front() == 0 && stated))
    readings[left.front()].chosen = true;
  else
    ranked.offset_doubt_s = range_of_offsets_s(fits, left);
  return ranked;
}

// Whether one axis explains the recording where the other one has no fit. Neither does on a walk, about the
// wrong axis with distances half as long at best.
bool fits_alone(const RankedBeams& one, const RankedBeams& other) {
  constexpr double kMuchShorter = 0.4;
  const BeamReading* chosen = chosen_of(one.readings);
  return chosen != nullptr && *chosen->residual_m < kMuchShorter * other.least_m;
}

// Which of the laser's axes the motor turns about: distances grow with the bends that walls have about the
// wrong one, and flat surfaces become narrow.
RankedReadings rank_as_stationary(const Recording& first, const Job& job) {
  RankedReadings ranked;
  ranked.axis = first.rig.mount.axis;
  const auto take = [&](RankedBeams&& beams) {
    ranked.beams = std::move(beams.readings);
    ranked.offset_doubt_s = beams.offset_doubt_s;
  };
  RankedBeams of_x = rank_beams(first, job);
  if (first.rig.states_mount() || job.cancelled()) return take(std::move(of_x)), ranked;
  Recording about_y = first;
  about_y.rig.mount.axis = Eigen::Vector3d::UnitY();
  RankedBeams of_y = rank_beams(about_y, job);
  const BeamReading *const best_x = of_x.best(), *const best_y = of_y.best();
  bool is_y = best_y != nullptr && (best_x != nullptr || fits_alone(of_y, of_x));
  if (best_x != nullptr && best_y != nullptr && !job.cancelled()) {
    const BeamReading& best = *best_x->residual_m < *best_y->residual_m ? *best_x : *best_y;
    const bool recorded = best.kind == BeamReadingKind::kRecorded;
    const auto prepared =
        prepare(std::make_shared<const Recording>(recorded ? first : read_as(first, best.time_increment_s)),
                FeatureOptions(), job);
    is_y =
        prepared && *best_y->residual_m * flat_width_m(*prepared, first.rig.mount.axis, *best.offset_s) <
                        *best_x->residual_m * flat_width_m(*prepared, about_y.rig.mount.axis, *best.offset_s);
  }
  if (!is_y) return take(std::move(of_x)), ranked;
  take(std::move(of_y));
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
  if (!recording.directions.empty() || recording.scans.empty()) return std::nullopt;
  if (scan_time_sigmas(found) < kMaxScanTimeSigmas) return std::nullopt;
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
