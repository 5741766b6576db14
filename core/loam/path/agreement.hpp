#pragma once

// The mathematics: docs/algorithms.md, section 10.

#include <span>
#include <string>
#include <vector>

#include "core/loam/path/sweep_pose.hpp"

namespace sweepscope {

/// For each sweep whether two tracks of the same sweeps, each on a map of its own, found the same motion:
/// over at least 2 s that the sweep is within, to within some centimetres and degrees. Tracks that began at
/// different places err in different places.
std::vector<char> agreeing(std::span<const SweepPose> a, std::span<const SweepPose> b);

/// How far two motions over the same part lie apart where they end.
struct Apart {
  double shift_m = 0, turn_rad = 0;
  /// A turn moves all that follows: one of half a rad counts as a shift of 1 m.
  double together_m() const { return shift_m + 2 * turn_rad; }
};
Apart ends_apart(const Pose& a, const Pose& b);
/// For the least of several, and for the most.
bool nearer(const Apart& a, const Apart& b);

/// A part of a walk that its tracks do not agree about.
struct Contradiction {
  double begin_s = 0, end_s = 0;  // on the clock of the laser
  Apart apart;                    // where the nearest of the other tracks ends, from where this one does
};
/// A sentence, with times since `first_s`.
std::string in_words(const Contradiction& tracks, double first_s);

/// A track, and of each sweep whether a further track found the same motion.
struct JudgedTrack {
  std::span<const SweepPose> poses;
  std::span<const char> agreed;
  bool earlier = false;  // of the same sweeps as they were placed at another offset
};

/// A track whose motion is taken from others where it is alone.
struct MendedTrack {
  std::vector<SweepPose> poses;
  std::vector<char> agreed;
  std::vector<Contradiction> contradictions;  // what no track of this offset confirms
};

/// Looks at the parts that no other track agrees with and that all others leave by more than a metre. Where
/// one of them, itself confirmed, found another motion, that is taken; what follows is moved along.
MendedTrack mended(std::vector<SweepPose> poses, std::vector<char> agreed,
                   const std::vector<JudgedTrack>& others);

}  // namespace sweepscope
