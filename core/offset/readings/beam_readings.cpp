#include "core/offset/readings/beam_readings.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
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

// The placed points if the motor turns about an axis.
std::vector<Eigen::Vector3d> placed_points_m(const StationarySearch& search, const Eigen::Vector3d& axis,
                                             double offset_s) {
  const PreparedRecording prepared = turned_about(axis, search.prepared);
  const OffsetProblem problem = problem_for(prepared, offset_s, offset_s);
  const StationaryPoints points =
      place_stationary(stationary_grid(problem), offset_s, StationaryDetail::kPoints);
  std::vector<Eigen::Vector3d> placed_m;
  for (std::size_t i = 0; i < points.placed.size(); ++i)
    if (points.placed[i]) placed_m.push_back(points.p_m[i]);
  return placed_m;
}

// The standard deviations of points along their principal directions, ascending.
Eigen::Vector3d deviations_m(std::span<const std::pair<std::array<int, 3>, Eigen::Vector3d>> points_m) {
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares_m2 = Eigen::Matrix3d::Zero();
  for (const auto& [cube, p_m] : points_m) mean_m += p_m / double(points_m.size());
  for (const auto& [cube, p_m] : points_m)
    squares_m2 += (p_m - mean_m) * (p_m - mean_m).transpose() / double(points_m.size());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(squares_m2, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().cwiseMax(0).cwiseSqrt();
}

// How thick the surfaces are in cubes: the median over their points. About a wrong axis walls are bent.
double thickness_m(const StationarySearch& search, const Eigen::Vector3d& axis, double offset_s) {
  // Of 141 recordings of tests/benchmark/random_readings 12000:12160, the right axis has the smaller product
  // with the residual in all, with cubes of 1 m in 132.
  constexpr double kCube_m = 0.4, kMinWidth = 1. / 12;  // of a cube: wider than a line
  constexpr std::size_t kMinPoints = 20;
  std::vector<std::pair<std::array<int, 3>, Eigen::Vector3d>> in_cubes;
  for (const Eigen::Vector3d& p_m : placed_points_m(search, axis, offset_s)) {
    const Eigen::Vector3i cube = (p_m / kCube_m).array().floor().cast<int>();
    in_cubes.push_back({{cube.x(), cube.y(), cube.z()}, p_m});
  }
  std::ranges::stable_sort(in_cubes, {}, [](const auto& point) { return point.first; });
  std::vector<double> of_points_m;
  for (auto first = in_cubes.begin(); first != in_cubes.end();) {
    const auto end =
        std::find_if(first, in_cubes.end(), [&](const auto& point) { return point.first != first->first; });
    const std::span in_cube(first, end);
    first = end;
    if (in_cube.size() < kMinPoints) continue;
    const Eigen::Vector3d along_m = deviations_m(in_cube);
    if (along_m[1] > kMinWidth * kCube_m) of_points_m.insert(of_points_m.end(), in_cube.size(), along_m[0]);
  }
  return median(std::move(of_points_m));
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

// The time from the first to the last beam that the surfaces show, which were placed by the recorded reading.
double shown_scan_time_s(const Recording& recording, const BeamReading& recorded, double beams,
                         const StationaryDirect& found) {
  const double in_array = recording.report.fired_backwards ? -1 : 1;
  return scan_time_s(recorded, beams) + in_array * found.scan_time_error_s;
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
// tests/benchmark/random_readings 0:300, that of others usually more. Its deviation is that of eight sectors:
// beyond 4 is one of 200 by chance, beyond 8 one of 10,000.
constexpr double kMaxScanTimeSigmas = 4, kMaxSigmasOfShortest = 8;

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

// The chosen one, or, where nothing is decided, the one that fits best.
const BeamReading* best_of(const std::vector<BeamReading>& readings) {
  if (const BeamReading* chosen = chosen_of(readings)) return chosen;
  const BeamReading* best = nullptr;
  for (const BeamReading& reading : readings)
    if (reading.offset_s && (best == nullptr || *reading.residual_m < *best->residual_m)) best = &reading;
  return best;
}

// The readings about one axis, and what is left in doubt.
struct RankedBeams {
  std::vector<BeamReading> readings;
  double offset_doubt_s = 0;
  double min_m = std::numeric_limits<double>::infinity();  // residual, of readings that do not fit as well
  bool explained = false;  // by the recorded reading, so that no other one is in question
};

// Those that fit and that nothing contradicts: their own second unknown, or another one that fits clearly
// better.
std::vector<std::size_t> uncontradicted(const std::vector<StationaryFit>& fits) {
  std::vector<std::size_t> left;
  const auto shortest = std::ranges::min_element(fits, {}, [](const StationaryFit& fit) {
    return fit.fits ? fit.direct.residual_m : std::numeric_limits<double>::infinity();
  });
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const bool longer = std::ranges::any_of(fits, [&](const StationaryFit& other) {
      return other.fits && clearly_shorter(other.direct, fits[i].direct);
    });
    const double max_sigmas = &fits[i] == &*shortest ? kMaxSigmasOfShortest : kMaxScanTimeSigmas;
    if (fits[i].fits && !longer && scan_time_sigmas(fits[i].direct) < max_sigmas) left.push_back(i);
  }
  return left;
}

// Whether one that is contradicted fits better: then none explains the recording. Of 126 true readings of
// tests/benchmark/random_readings 12000:12200 that were compared with others, no other one was.
bool another_is_shorter(const std::vector<StationaryFit>& fits, const StationaryFit& taken) {
  constexpr double kShorter = 0.9;
  return std::ranges::any_of(fits, [&](const StationaryFit& other) {
    return other.fits && other.direct.residual_m < kShorter * taken.direct.residual_m;
  });
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

// The first sweeps of a recording by each reading about each axis. A reading is searched once: only the least
// squares depends on the axis.
class Trials {
 public:
  Trials(const Recording& first, std::vector<Eigen::Vector3d> axes)
      : first_(first),
        beams_(median_beams(first)),
        readings_(possible_readings(first)),
        axes_(std::move(axes)),
        fits_(axes_.size()) {
    if (first.rig.laser.time_increment_s) readings_.resize(1);  // stated, and not overruled
  }

  /// The next reading; false if there is none.
  bool try_next(const Job& job) {
    if (searches_.size() == readings_.size() || job.cancelled()) return false;
    const double increment_s = readings_[searches_.size()].time_increment_s;
    const bool recorded = searches_.empty();
    FeatureOptions all;
    all.axis_sine = 0;  // beams along one of the axes say something about the other
    const auto& search = searches_.emplace_back(search_stationary(
        recorded ? borrowed(first_) : std::make_shared<const Recording>(read_as(first_, increment_s)), all,
        job));
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      StationaryFit fit = search ? fit_about(axes_[axis], *search, job) : StationaryFit();
      fit.fits = fit.fits && fit.direct.residual_m < kMaxResidual_m;
      fits_[axis].push_back(std::move(fit));
    }
    return true;
  }

  /// By what was tried.
  RankedBeams about(std::size_t axis) const {
    const std::vector<StationaryFit>& fits = fits_[axis];
    RankedBeams ranked;
    for (std::size_t i = 0; i < fits.size(); ++i) {
      BeamReading& reading = ranked.readings.emplace_back(readings_[i]);
      if (fits[i].direct.matches > 0) {
        reading.residual_m = fits[i].direct.residual_m;
        ranked.min_m = std::min(ranked.min_m, *reading.residual_m);
      }
      if (fits[i].fits) reading.offset_s = fits[i].direct.offset_s;
    }
    ranked.explained = is_explained_about(axis);
    if (std::ranges::none_of(fits, &StationaryFit::fits)) return {{}, 0, ranked.min_m, false};
    std::vector<std::size_t> left = uncontradicted(fits);
    if (!left.empty() && another_is_shorter(fits, fits[left.front()])) left.clear();
    const bool stated = first_.report.beam_time_doubt_s == 0;  // by the messages
    if (left.size() == 1 || (!left.empty() && left.front() == 0 && stated))
      ranked.readings[left.front()].chosen = true;
    else
      ranked.offset_doubt_s = range_of_offsets_s(fits, left);
    return ranked;
  }

  /// Of a reading that was tried and fits.
  const StationarySearch& search_of(BeamReadingKind kind) const {
    return *searches_[std::size_t(std::ranges::find(readings_, kind, &BeamReading::kind) -
                                  readings_.begin())];
  }
  const std::vector<Eigen::Vector3d>& axes() const { return axes_; }

 private:
  // Where the ranges themselves show no clear valley, as those of sparse sweeps, wrong readings fit about as
  // well: they have to be compared.
  bool is_explained_about(std::size_t axis) const {
    const StationaryFit& fit = fits_[axis].front();
    return fits_[axis].size() == 1 && fit.fits && fit.direct.residual_m <= kSmallResidual_m &&
           is_nearest(fit.direct, readings_, 0, beams_) &&
           scan_time_sigmas(fit.direct) < kMaxScanTimeSigmas && excludes_others(fit.direct) &&
           has_clear_valley(searches_.front()->window.coarse);
  }

  // Of times that are guessed, one nearby may be the right one.
  bool excludes_others(const StationaryDirect& found) const {
    if (first_.report.beam_time_doubt_s == 0) return true;
    const double shown_s = shown_scan_time_s(first_, readings_.front(), beams_, found);
    return std::all_of(readings_.begin() + 1, readings_.end(), [&](const BeamReading& other) {
      return std::abs(scan_time_s(other, beams_) - shown_s) > kMaxScanTimeSigmas * found.scan_time_sigma_s;
    });
  }

  const Recording& first_;
  double beams_;
  std::vector<BeamReading> readings_;
  std::vector<Eigen::Vector3d> axes_;
  std::vector<std::optional<StationarySearch>> searches_;  // of the readings tried
  std::vector<std::vector<StationaryFit>> fits_;           // of each axis and reading
};

// Whether one axis explains the recording where the other one has no fit. Neither does on a walk, about the
// wrong axis with distances half as long at best.
bool fits_alone(const RankedBeams& one, const RankedBeams& other) {
  constexpr double kMuchShorter = 0.4;
  const BeamReading* chosen = chosen_of(one.readings);
  return chosen != nullptr && *chosen->residual_m < kMuchShorter * other.min_m;
}

// Whether the second axis explains the recording better than the first: about the wrong one walls are bent,
// so that distances between the directions grow, and surfaces become thick.
bool second_fits_better(const Trials& trials, const RankedBeams& one, const RankedBeams& other) {
  const BeamReading *const of_one = best_of(one.readings), *const of_other = best_of(other.readings);
  if (of_other == nullptr) return false;
  if (of_one == nullptr) return fits_alone(other, one);
  const BeamReading& best = *of_one->residual_m < *of_other->residual_m ? *of_one : *of_other;
  const auto about_m = [&](std::size_t axis) {
    return thickness_m(trials.search_of(best.kind), trials.axes()[axis], *best.offset_s);
  };
  return *of_other->residual_m * about_m(1) < *of_one->residual_m * about_m(0);
}

// Of a rig that moves no reading fits, and the one that fits least badly says nothing. Sweeps of the same
// direction of a stationary rig are alike about any axis; but sparse ones are registered badly, so that of
// them distances as short as the range noise allows say more. Of tests/benchmark/random_readings 13400:14022
// those of motors in radians are at most 0.46 of the noise, and usually 0.3; on three walks of a scanner with
// 15 Hz they are 0.5 to 1.
bool moves(const Trials& trials, const RankedReadings& ranked) {
  constexpr double kMaxNoises = 0.4;
  const BeamReading* best = best_of(ranked.beams);
  if (best == nullptr || !best->offset_s) return false;
  const PreparedRecording& searched = trials.search_of(best->kind).prepared;
  if (has_sparse_sweeps(*searched.recording, searched.motor) &&
      *best->residual_m < kMaxNoises * estimate_range_noise_m(*searched.recording))
    return false;
  const double offset_s = *best->offset_s;
  return std::ranges::any_of(trials.axes(), [&](const Eigen::Vector3d& axis) {
    const PreparedRecording prepared = turned_about(axis, searched);
    return test_motion(stationary_grid(problem_for(prepared, offset_s, offset_s)), offset_s).moving();
  });
}

// What the readings that were tried so far show, and whether the others are in question.
std::pair<RankedReadings, bool> ranked_of(const Trials& trials) {
  RankedBeams beams = trials.about(0);
  std::size_t axis = 0;
  if (trials.axes().size() > 1) {
    RankedBeams others = trials.about(1);
    if (second_fits_better(trials, beams, others)) {
      beams = std::move(others);
      axis = 1;
    }
  }
  return {{std::move(beams.readings), trials.axes()[axis], axis > 0, beams.offset_doubt_s}, !beams.explained};
}

}  // namespace

RankedReadings rank_readings(const Recording& recording, const Job& job) {
  RankedReadings as_read;
  as_read.axis = recording.rig.mount.axis;
  if (!recording.directions.empty() || recording.scans.empty() || recording.ranges_m.empty()) return as_read;
  const Recording first = first_sweeps(recording);
  std::vector<Eigen::Vector3d> axes{first.rig.mount.axis};
  if (!first.rig.states_mount()) axes.push_back(Eigen::Vector3d::UnitY());
  Trials trials(first, std::move(axes));
  if (!trials.try_next(job)) return as_read;
  auto [ranked, in_question] = ranked_of(trials);
  if (in_question && trials.try_next(job)) {
    while (trials.try_next(job)) continue;
    ranked = ranked_of(trials).first;
  }
  return job.cancelled() || moves(trials, ranked) ? as_read : ranked;
}

std::optional<BeamReading> better_reading(const Recording& recording, const StationaryDirect& found) {
  if (!recording.directions.empty() || recording.scans.empty()) return std::nullopt;
  if (scan_time_sigmas(found) < kMaxScanTimeSigmas) return std::nullopt;
  const double beams = median_beams(recording);
  const std::vector<BeamReading> readings = possible_readings(recording);
  const double shown_s = shown_scan_time_s(recording, readings.front(), beams, found);
  const auto nearest = std::ranges::min_element(readings, {}, [&](const BeamReading& reading) {
    return std::abs(scan_time_s(reading, beams) - shown_s);
  });
  if (nearest == readings.begin()) return std::nullopt;
  return *nearest;
}

}  // namespace sweepscope
