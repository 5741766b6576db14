#pragma once

// The mathematics: docs/algorithms.md, section 9.

#include <cstddef>
#include <vector>

#include "core/offset/prepared/prepared.hpp"

namespace sweepscope {

/// Whether the rig was stationary. A wrong offset turns all sweeps of one direction by the same angle, so for
/// a stationary rig sweeps of the same direction coincide at any offset.
struct MotionTest {
  std::size_t pairs = 0;  // compared, k and k + 2; 0: the recording has no two whole sweeps of one direction
  std::size_t moved = 0;  // of these
  double evidence = 0;    // that these moved, each from 0 to 1, summed: small shifts of many pairs count too
  std::size_t far_pairs = 0;        // compared, from the recording's beginning and its end
  std::size_t far_moved = 0;        // of these: a slow rig hardly moves from one sweep to the next
  double median_translation_m = 0;  // of the pairs k and k + 2
  double median_rotation_rad = 0;
  double median_apart_m = 0;  // by how much the shift takes the points along their surfaces' normals, rms

  // Of a short recording: pairs k and k + 1, of opposite directions.
  std::size_t neighbours = 0, neighbours_moved = 0;
  bool within_sweeps = false;  // scan lines moved against the sweeps next to them, for a fifth of a sweep

  bool answered() const { return pairs > 0 || neighbours > 0; }
  bool moving() const { return pairs_differ() || moved_slowly() || neighbours_differ() || within_sweeps; }
  bool pairs_differ() const { return 4 * evidence > double(pairs); }
  bool neighbours_differ() const { return 4 * neighbours_moved > neighbours; }
  /// A single pair is not enough: people may stand near where others stood before.
  bool moved_slowly() const { return far_pairs >= 2 && 5 * far_moved > 3 * far_pairs; }
};

/// Compares up to 16 pairs spread over the recording, and up to 4 of its ends.
MotionTest test_motion(const PreparedRecording& prepared);

/// A part of a recording in which the rig moved, or was stationary, from one sweep to the next of the same
/// direction. Seconds since the first scan.
struct MotionPart {
  double begin_s = 0, end_s = 0;
  bool moved = false;
};

/// The whole recording in such parts, from its first scan to its last, alternating: up to 64 pairs of sweeps
/// are compared as in the motion test, and each stands for the time until the next. A rig that moves very
/// slowly may seem stationary. Empty where no two sweeps of one direction are whole.
std::vector<MotionPart> motion_over_time(const PreparedRecording& prepared);

}  // namespace sweepscope
