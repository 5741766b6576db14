#pragma once

// The mathematics: docs/algorithms.md, section 8.

#include <optional>
#include <vector>

#include "core/job.hpp"
#include "core/offset/judgement/limits.hpp"
#include "core/offset/stationary/stationary_points.hpp"
#include "core/uncertainty.hpp"

namespace sweepscope {

/// What is solved again to see how certain the answer is: everything, parts of the sweeps alone, at half the
/// cost, or nothing.
enum class Resampling { kAll, kParts, kNone };

/// The offset of a stationary rig as the only unknown of a least squares.
///
/// A point p on a line of one direction lies at distance r = n . (p - c) from a patch (c, n) of the other's.
/// A growing offset turns the point by omega_p and the patch by omega_c about the motor's axis a, so
///   dr / d offset = (omega_p - omega_c) n . (a x p),
/// and Gauss-Newton's step is - sum w r J / sum w J^2, with Cauchy weights w. Halved or doubled, the widths
/// change the answers in two simulated rooms by at most 0.002 ms (sweepscope_option_changes of
/// tests/benchmark).
struct StationaryDirectOptions {
  int max_iterations = 60;          // rooms take 3 or 4, real surfaces up to 25, sparse sweeps up to 50
  int undamped_iterations = 10;     // from then on a step that goes back is half as long
  double step_tolerance_s = 1e-6;   // a thousandth of the unit of most motors, see search_scale
  double first_loss_width_m = 0.1;  // later: `loss_widths` times the residuals' robust deviation
  double loss_widths = 2.5;         // near 2.385, where Cauchy's loss is 95 % efficient on normal noise
  double min_loss_width_m = 0.004;  // twice the least range noise, see estimate_range_noise_m
  std::size_t min_matches = kLimits.min_matches;
  Resampling resampling = Resampling::kAll;
};

/// The offset of the scan lines of a sector of the motor's angle alone.
struct SectorOffset {
  double angle_rad = 0;  // of the sector's middle line
  double offset_s = 0;
  double formal_sigma_s = 0;  // as if all matches erred independently
  double share = 0;           // of the information
};

/// The answer and its evidence.
struct StationaryDirect {
  bool converged = false;
  double offset_s = 0;
  double step_s = 0;  // the last one, of Gauss and Newton
  int iterations = 0;
  std::size_t features = 0, matches = 0;
  double middle_s =
      0;  // laser clock, mean time of the matches by their weight: where a drifting offset is right
  double residual_m = 0;  // robust deviation of the distances
  // Weighted rms of the distances in each sector of the motor's angle, ascending; 0 where matches are few.
  std::vector<double> sector_residual_m;
  // What the distances say of the time from a scan's first to its last beam, beyond the recording's: a step
  // of a second unknown, tau (b - mean b), of beams b from 0 to 1; and its deviation, by the scatter of the
  // sectors and at least as if all matches erred independently.
  double scan_time_error_s = 0, scan_time_sigma_s = 0;
  double lever_m =
      0;  // rms of n . (a x p): the distance by which a turn of 1 rad moves the points off the patches
  double reach_m = 0;  // rms of |a x p|: its upper bound
  // Resampling: the recording is cut into parts, blocks of sweeps in the order of time. Where sweeps are few,
  // or sparse and less certain by it, the parts are views: sectors of the motor's angle by sections of beams.
  std::vector<WithoutPart> without_part;  // the offset without each part
  std::vector<WithoutPart> without_comb;  // the same for combs of lines, every so many-th one
  std::vector<SectorOffset> sectors;      // of the motor's angle, ascending
  bool depends_on_angle = false;          // the sectors' offsets differ clearly
  // Blocks of sweeps: middle, own offset and its deviation by the block's few lines alone.
  std::vector<double> block_s, block_offset_s, block_sigma_s;
  double lever_m_s = 0;  // rms of dr / d offset
};

/// The trend of blocks over time. Its sigma is at least what their own deviations leave: of a few blocks the
/// scatter about the trend may be small by chance.
std::optional<Trend> trend_of_blocks(const std::vector<double>& times_s, const std::vector<double>& offsets_s,
                                     const std::vector<double>& sigmas_s);

StationaryDirect solve_stationary(const StationaryGrid& grid, double first_offset_s,
                                  const StationaryDirectOptions& options, const Job& job);

/// The uncertainty of the answer from resampling and from the recording's stamps: the largest of the values
/// from parts, combs, `stamps_sigma_s` and, where the offset depends on the motor's angle, sectors. Absent if
/// the parts are too few.
std::optional<double> sigma_of(const StationaryDirect& found, const Recording& recording);

}  // namespace sweepscope
