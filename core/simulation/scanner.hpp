#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace sweepscope::simulation {

/// When the beams of a scan are fired. `angle` ascends along a message's array in all of them.
enum class BeamTimes {
  kSpread,    // beam i at stamp + i * time_increment
  kInstant,   // all at the stamp; time_increment is 0
  kReversed,  // beam i of n at stamp + (n - 1 - i) * time_increment: the last of the array is the first fired
};

/// Those of that name, as --beam-times spells it; absent: there are none.
std::optional<BeamTimes> beam_times(std::string_view name);
/// As --beam-times spells them.
std::string_view name_of(BeamTimes times);
/// All of them.
std::vector<std::string_view> beam_times_names();

/// A scanner as its driver writes it. The sources are named in docs/recordings.md. The default is the
/// UTM-30LX of the paper, used over 180 deg.
struct Scanner {
  std::string_view name = "utm30lx-180";                   // as --scanner spells it
  std::uint32_t beams = 721;                               // of one turn of the mirror
  double angle_min_deg = -90, angle_increment_deg = 0.25;  // of the first beam, and from beam to beam
  double scan_period_s = 0.025;                            // one turn of the mirror
  double time_increment_s = 1.736e-5;                      // rounded to a float where it is used
  double range_min_m = 0.1, range_max_m = 30;              // beyond them there is no return
  double noise_m = 0.010, noise_per_m = 0;    // standard deviation: noise_m + noise_per_m * range
  BeamTimes beam_times = BeamTimes::kSpread;  // when they are fired
  /// Of a 3D scanner, `beams` and what is said of them are of one ring. A ring's beams lie on a cone about
  /// the scanner's z axis; rings are numbered from the lowest one.
  std::uint32_t rings = 1;
  double lowest_ring_deg = 0, ring_step_deg = 0;  // elevation of ring 0, and from ring to ring
  /// The rings of a beam are fired one after the other, after this time, every second one first: 0, 8, 1, 9
  /// and so on of 16.
  double ring_interval_s = 0;

  /// Has more than one ring.
  bool is_3d() const { return rings > 1; }
  /// All beams of one turn of the mirror.
  std::uint32_t rays() const { return beams * rings; }
  /// As a message keeps it.
  double increment_s() const { return static_cast<float>(time_increment_s); }
};

/// The scanner of that name; absent: there is none.
std::optional<Scanner> scanner(std::string_view name);
/// All of them.
std::vector<std::string_view> scanner_names();

}  // namespace sweepscope::simulation
