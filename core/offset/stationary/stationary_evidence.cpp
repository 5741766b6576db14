#include "core/offset/stationary/stationary_evidence.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/loam/path/least_squares.hpp"
#include "core/numbers.hpp"
#include "core/offset/judgement/unseen_sigma.hpp"

namespace sweepscope {
namespace {

// The lines that have matches, in the order of the motor's angle.
std::vector<std::pair<double, std::size_t>> lines_by_angle(const StationaryPoints& points,
                                                           const std::vector<LineResiduals>& lines) {
  const std::size_t middle = points.bins / 2;
  std::vector<std::pair<double, std::size_t>> by_angle;
  for (std::size_t line = 0; line < points.lines(); ++line)
    if (points.sweep[line] != kNoSweep && !lines[line].residuals.empty())
      by_angle.push_back({points.angle_rad[line * points.bins + middle], line});
  std::sort(by_angle.begin(), by_angle.end());
  return by_angle;
}

// A sector of the motor's angle, 11 to 23 deg of usual swings: gear play holds over such. A point lies beside
// its patch in angle, so sectors share no matches.
struct SectorLines {
  double angle_rad = 0;  // of the middle line
  std::vector<const LineResiduals*> lines;
};

std::vector<SectorLines> sectors_of(const StationaryPoints& points, const std::vector<LineResiduals>& lines) {
  constexpr std::size_t kSectors = 8;
  const auto by_angle = lines_by_angle(points, lines);
  std::vector<SectorLines> sectors(kSectors);
  for (std::size_t sector = 0; sector < kSectors; ++sector) {
    const std::size_t first = sector * by_angle.size() / kSectors,
                      end = (sector + 1) * by_angle.size() / kSectors;
    if (first == end) continue;
    sectors[sector].angle_rad = by_angle[(first + end) / 2].first;
    for (std::size_t i = first; i < end; ++i) sectors[sector].lines.push_back(&lines[by_angle[i].second]);
  }
  return sectors;
}

// The offset and the scan's time as two unknowns; weighted. The patches of a cell are of its own bin, so that
// both move alike with the scan's time.
struct ScanTimeEquation {
  std::size_t matches = 0;
  double weights = 0, rr = 0;
  Eigen::Matrix2d jj = Eigen::Matrix2d::Zero();  // of the offset and the scan's time
  Eigen::Vector2d jr = Eigen::Vector2d::Zero();

  void add(const LineResiduals& line, std::size_t bins, double loss_width_m) {
    matches += line.residuals.size();
    for (std::size_t i = 0; i < line.residuals.size(); ++i) {
      const double distance_m = line.residuals[i].distance_m;
      const double beam = double(line.cells[i] % bins) / double(bins - 1);
      const Eigen::Vector2d jacobian_m_s = line.residuals[i].jacobian_m_s * Eigen::Vector2d(1, beam);
      const double weight = cauchy_weight(distance_m, loss_width_m);
      weights += weight;
      rr += weight * distance_m * distance_m;
      jj += weight * jacobian_m_s * jacobian_m_s.transpose();
      jr += weight * distance_m * jacobian_m_s;
    }
  }
  void add(const ScanTimeEquation& other) {
    matches += other.matches;
    weights += other.weights;
    rr += other.rr;
    jj += other.jj;
    jr += other.jr;
  }
  // Of the scan's time, with the offset free.
  double information() const { return jj(0, 0) > 0 ? jj(1, 1) - jj(0, 1) * jj(0, 1) / jj(0, 0) : 0; }
  double step_s() const { return -(jr(1) - jr(0) * jj(0, 1) / jj(0, 0)) / information(); }
};

// Which block of sweeps each line belongs to, kNoSweep where none.
struct Blocks {
  std::vector<std::size_t> of_line;
  std::size_t count = 0;
};

Blocks blocks_of_sweeps(const StationaryPoints& points, std::size_t most) {
  std::vector<std::size_t> sweeps;
  for (const std::size_t sweep : points.sweep)
    if (sweep != kNoSweep && (sweeps.empty() || sweeps.back() != sweep)) sweeps.push_back(sweep);
  Blocks blocks{std::vector<std::size_t>(points.lines(), kNoSweep), std::min(most, sweeps.size())};
  for (std::size_t line = 0; line < points.lines(); ++line) {
    if (points.sweep[line] == kNoSweep) continue;
    const auto place = std::lower_bound(sweeps.begin(), sweeps.end(), points.sweep[line]) - sweeps.begin();
    blocks.of_line[line] = std::size_t(place) * blocks.count / sweeps.size();
  }
  return blocks;
}

CellParts parts_of(const Blocks& blocks, std::size_t bins) {
  CellParts parts{{}, blocks.count};
  for (const std::size_t block : blocks.of_line) parts.of_cell.insert(parts.of_cell.end(), bins, block);
  return parts;
}

// Every so many-th line, of each direction: what errs with the scan, as its stamp does.
CellParts combs(const StationaryPoints& points, std::size_t count) {
  CellParts parts{{}, count};
  std::array<std::size_t, 2> lines{};
  for (std::size_t line = 0; line < points.lines(); ++line) {
    const std::size_t part =
        points.sweep[line] == kNoSweep ? kNoSweep : lines[points.direction[line] > 0]++ % count;
    parts.of_cell.insert(parts.of_cell.end(), points.bins, part);
  }
  return parts;
}

// Sectors of the motor's angle, both directions', times sections of the beams: what was seen of the scene.
CellParts views(const StationaryPoints& points, std::size_t sectors, std::size_t sections) {
  const std::size_t middle = points.bins / 2;
  std::vector<double> angles_rad;
  for (std::size_t line = 0; line < points.lines(); ++line)
    if (points.sweep[line] != kNoSweep) angles_rad.push_back(points.angle_rad[line * points.bins + middle]);
  std::sort(angles_rad.begin(), angles_rad.end());
  CellParts parts{std::vector<std::size_t>(points.placed.size(), kNoSweep), sectors * sections};
  for (std::size_t line = 0; line < points.lines(); ++line) {
    if (points.sweep[line] == kNoSweep) continue;
    const auto place = std::lower_bound(angles_rad.begin(), angles_rad.end(),
                                        points.angle_rad[line * points.bins + middle]) -
                       angles_rad.begin();
    const std::size_t sector = std::size_t(place) * sectors / angles_rad.size();
    for (std::size_t bin = 0; bin < points.bins; ++bin)
      parts.of_cell[line * points.bins + bin] = sector * sections + bin * sections / points.bins;
  }
  return parts;
}

// The offset without each part, a step from the answer.
std::vector<WithoutPart> offsets_without(const StationaryLinearisation& at,
                                         const std::vector<LineResiduals>& lines, const CellParts& parts,
                                         double loss_width_m) {
  const double whole_jj = offset_equation(lines, loss_width_m).jj;
  const PartsOfPatches of_patches = at.parts_of_patches(parts);
  StationaryLinearisation rest = at;
  std::vector<WithoutPart> without;
  for (std::size_t part = 0; part < parts.count; ++part) {
    rest.leave_out(parts, part, at);
    const OffsetEquation sums =
        offset_equation(rest.residuals_without(part, of_patches, lines), loss_width_m);
    if (sums.jj > 0) without.push_back({at.points().offset_s + sums.step_s(), 1 - sums.jj / whole_jj});
  }
  return without;
}

// The step of some lines alone, and their information: iterated, since lines whose own offset differs from
// that of the rest lie in the tails of the loss.
std::pair<double, double> own_step(const std::vector<const LineResiduals*>& lines, double loss_width_m) {
  constexpr int kMaxIterations = 20;
  constexpr double kTolerance_s = 1e-5;
  OffsetEquation sums;
  double step_s = 0;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    sums = {};
    for (const LineResiduals* line : lines) sums.add(*line, loss_width_m, step_s);
    if (!(sums.jj > 0)) break;
    step_s += sums.step_s();
    if (std::abs(sums.step_s()) < kTolerance_s) break;
  }
  return {step_s, sums.jj};
}

// Whether the sectors' offsets differ clearly, as those of a rig do whose play depends on the angle.
bool sectors_differ(const StationaryDirect& found, const StationaryGrid& grid) {
  // Of 322 simulated rooms (sweepscope_calibration --lines) four go beyond all of these: two with 30 mm of
  // noise, two whose stamps jitter by 1 ms.
  constexpr double kMinTurn_rad = 0.5 * kRadPerDeg, kMinFormalSigmas = 8;
  constexpr double kMinSamples = 8;  // of the motor per sweep: of fewer, 13.3 has the uncertainty
  double squares_s2 = 0, formal_s2 = 0;
  for (const SectorOffset& sector : found.sectors) {
    const double off_s = sector.offset_s - found.offset_s;
    squares_s2 += sector.share * off_s * off_s;
    formal_s2 += sector.share * sector.formal_sigma_s * sector.formal_sigma_s;
  }
  const MotorMotion& motor = grid.problem->motor;
  return 2 * motor.lever_speed_rad_s() * std::sqrt(squares_s2) > kMinTurn_rad &&
         squares_s2 > kMinFormalSigmas * kMinFormalSigmas * formal_s2 &&
         samples_per_sweep(grid.problem->recording->motor, motor) >= kMinSamples;
}

// The offset of each sector of the motor's angle alone.
void fill_sectors(const StationaryGrid& grid, const StationaryPoints& points,
                  const std::vector<LineResiduals>& lines, double loss_width_m, StationaryDirect& result) {
  const double whole_jj = offset_equation(lines, loss_width_m).jj;
  for (const SectorLines& sector : sectors_of(points, lines)) {
    const auto [step_s, jj] = own_step(sector.lines, loss_width_m);
    if (jj > 0)
      result.sectors.push_back(
          {sector.angle_rad, points.offset_s + step_s, result.residual_m / std::sqrt(jj), jj / whole_jj});
  }
  result.depends_on_angle = sectors_differ(result, grid);
}

// By how much more the sectors' offsets scatter than independent matches would: matches of one surface err
// together, the more so the fewer lines it has. More than by chance they scatter where the offset changes, or
// depends on the angle.
double scatter_of_sectors(const StationaryDirect& found) {
  constexpr double kMaxByChance = 3;  // 2.7 suffices for tests/benchmark/random_readings 0:1000
  double squares = 0;
  for (const SectorOffset& sector : found.sectors) {
    const double sigmas = (sector.offset_s - found.offset_s) / sector.formal_sigma_s;
    squares += sigmas * sigmas;
  }
  const std::size_t n = found.sectors.size();
  return n < 2 ? 1 : std::clamp(std::sqrt(squares / double(n - 1)), 1.0, kMaxByChance);
}

// The offset of each block of at least two sweeps alone.
void fill_blocks(const StationaryLinearisation& at, const StationaryGrid& grid, double loss_width_m,
                 StationaryDirect& result) {
  constexpr std::size_t kMaxBlocks = 10;  // a trend over time needs no more, and each requires several sweeps
  const Blocks sweeps = blocks_of_sweeps(at.points(), std::size_t(-1));
  const Blocks blocks =
      blocks_of_sweeps(at.points(), std::clamp<std::size_t>(sweeps.count / 2, 1, kMaxBlocks));
  const std::vector<LineResiduals> lines = at.residuals_within(blocks.of_line, blocks.count);
  std::vector<OffsetEquation> sums(blocks.count);
  std::vector<double> time_s(blocks.count, 0.0), count(blocks.count, 0.0);
  for (std::size_t line = 0; line < lines.size(); ++line) {
    const std::size_t block = blocks.of_line[line];
    if (block == kNoSweep) continue;
    sums[block].add(lines[line], loss_width_m);
    time_s[block] += grid.time_s[line * at.points().bins];
    count[block] += 1;
  }
  const double scatter = scatter_of_sectors(result);
  for (std::size_t block = 0; block < blocks.count; ++block) {
    if (!(sums[block].jj > 0)) continue;
    result.block_s.push_back(time_s[block] / count[block]);
    result.block_offset_s.push_back(result.offset_s + sums[block].step_s());
    result.block_sigma_s.push_back(scatter * result.residual_m / std::sqrt(sums[block].jj));
  }
}

void fill_levers(const std::vector<LineResiduals>& lines, StationaryDirect& result) {
  double lever_m2 = 0, reach_m2 = 0, lever_m2_s2 = 0;
  for (const LineResiduals& line : lines) {
    for (const PatchDistance& residual : line.residuals) {
      lever_m2 += double(residual.lever_m) * residual.lever_m;
      reach_m2 += double(residual.reach_m) * residual.reach_m;
      lever_m2_s2 += residual.jacobian_m_s * residual.jacobian_m_s;
    }
  }
  const double n = std::max(1.0, double(result.matches));
  result.lever_m = std::sqrt(lever_m2 / n);
  result.reach_m = std::sqrt(reach_m2 / n);
  result.lever_m_s = std::sqrt(lever_m2_s2 / n);
}

double middle_of_matches_s(const StationaryGrid& grid, const std::vector<LineResiduals>& lines,
                           double loss_width_m) {
  double weights = 0, sum_s = 0;
  for (std::size_t line = 0; line < lines.size(); ++line) {
    OffsetEquation of_line;
    of_line.add(lines[line], loss_width_m);
    weights += of_line.jj;
    sum_s += of_line.jj * grid.time_s[line * grid.bins + grid.bins / 2];
  }
  return weights > 0 ? sum_s / weights : 0;
}

// By the offsets without each sector, whose matches are its own.
double sigma_of_sectors_s(const StationaryDirect& found) {
  std::vector<WithoutPart> without;
  for (const SectorOffset& sector : found.sectors)
    if (sector.share < 1)
      without.push_back(
          {(found.offset_s - sector.share * sector.offset_s) / (1 - sector.share), sector.share});
  return jackknife_sigma(found.offset_s, without).value_or(0);
}

}  // namespace

void fill_scan_time(const StationaryPoints& points, const std::vector<LineResiduals>& lines,
                    double loss_width_m, StationaryDirect& result) {
  constexpr std::size_t kMinSectorMatches = 20;  // for a residual known to 16 %
  if (points.bins < 2) return;
  std::vector<ScanTimeEquation> sectors;
  ScanTimeEquation whole;
  for (const SectorLines& sector : sectors_of(points, lines)) {
    ScanTimeEquation& sums = sectors.emplace_back();
    for (const LineResiduals* line : sector.lines) sums.add(*line, points.bins, loss_width_m);
    result.sector_residual_m.push_back(sums.matches < kMinSectorMatches ? 0
                                                                        : std::sqrt(sums.rr / sums.weights));
    whole.add(sums);
  }
  if (!(whole.information() > 0)) return;
  result.scan_time_error_s = whole.step_s();
  std::vector<WithoutPart> without;
  for (std::size_t left_out = 0; left_out < sectors.size(); ++left_out) {
    ScanTimeEquation rest;
    for (std::size_t i = 0; i < sectors.size(); ++i)
      if (i != left_out) rest.add(sectors[i]);
    if (rest.information() > 0)
      without.push_back({rest.step_s(), 1 - rest.information() / whole.information()});
  }
  result.scan_time_sigma_s = std::max(result.residual_m / std::sqrt(whole.information()),
                                      jackknife_sigma(whole.step_s(), without).value_or(0));
}

void resample(const StationaryGrid& grid, const StationaryLinearisation& at,
              const std::vector<LineResiduals>& lines, double loss_width_m, Resampling resampling,
              StationaryDirect& result) {
  // The sigma of a jackknife of n parts is itself uncertain by 1 / sqrt(2 (n - 1)): by 24 % of 10 parts, 32 %
  // of 6, 15 % of 24 views and 21 % of 12 combs. A part
  // costs as many patches as have points of it.
  constexpr std::size_t kMaxParts = 10, kMinBlocks = 6, kSectors = 8, kSections = 3, kCombs = 12;
  static_assert(std::max({kMaxParts, kSectors * kSections, kCombs}) <= CellParts::kMost);
  const Blocks blocks = blocks_of_sweeps(at.points(), kMaxParts);
  const auto without = [&](const CellParts& parts) {
    return offsets_without(at, lines, parts, loss_width_m);
  };
  const auto without_views = [&] { return without(views(at.points(), kSectors, kSections)); };
  const auto sigma_by_s = [&](const std::vector<WithoutPart>& parts) {
    return jackknife_sigma(result.offset_s, parts).value_or(0);
  };
  // Sweeps are the parts where there are enough of them.
  const bool few = blocks.count < kMinBlocks;
  result.without_part = few ? without_views() : without(parts_of(blocks, at.points().bins));
  // Sparse sweeps often measure the same lines again: then all blocks have the error of their few surfaces.
  if (!few && has_sparse_sweeps(*grid.problem->recording, grid.problem->motor))
    if (auto by_views = without_views(); sigma_by_s(by_views) > sigma_by_s(result.without_part))
      result.without_part = std::move(by_views);
  result.middle_s = middle_of_matches_s(grid, lines, loss_width_m);
  fill_levers(lines, result);
  fill_sectors(grid, at.points(), lines, loss_width_m, result);
  if (resampling == Resampling::kParts) return;
  result.without_comb = without(combs(at.points(), kCombs));
  fill_blocks(at, grid, loss_width_m, result);
}

std::optional<Trend> trend_of_blocks(const std::vector<double>& times_s, const std::vector<double>& offsets_s,
                                     const std::vector<double>& sigmas_s) {
  std::optional<Trend> trend = trend_of(times_s, offsets_s);
  if (trend) trend->sigma = std::max(trend->sigma, sigma_of_trend(times_s, sigmas_s));
  return trend;
}

std::optional<double> sigma_of(const StationaryDirect& found, const Recording& recording) {
  const auto of_parts_s = jackknife_sigma(found.offset_s, found.without_part);
  if (!of_parts_s) return std::nullopt;
  const double of_combs_s = jackknife_sigma(found.offset_s, found.without_comb).value_or(0),
               of_sectors_s = found.depends_on_angle ? sigma_of_sectors_s(found) : 0;
  return std::max({*of_parts_s, of_combs_s, of_sectors_s, stamps_sigma_s(recording)});
}

}  // namespace sweepscope
