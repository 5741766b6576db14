#pragma once

// The mathematics: docs/algorithms.md, section 18.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/job.hpp"
#include "core/offset/stationary/direct_stationary.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// A reading's name in JSON, and what it means: "the last beam of a message was fired first".
struct BeamReadingEntry {
  BeamReadingKind kind;
  const char* name;
  const char* description;
};
/// All readings, in the order of BeamReadingKind.
std::span<const BeamReadingEntry> beam_reading_entries();
const BeamReadingEntry& entry_of(BeamReadingKind kind);

/// The reading in use; null where nothing is decided.
const BeamReading* chosen_of(const std::vector<BeamReading>& readings);

/// The reading in use and how well it fits, then the others: "the beams are timed as recorded: surfaces fit
/// to 2.6 mm; others: reversed 14.1 mm". Empty where nothing is decided.
std::string reading_in_words(const std::vector<BeamReading>& readings);

/// How the beams of a 2D scanner's message may follow each other in time: as recorded, in the opposite order,
/// all at once, or in the time that a mirror takes that turns once a scan, or that passes from scan to scan.
/// Readings that hardly differ are listed once; the recorded one is the first. Where that is the time of such
/// a mirror, only the order is in question.
std::vector<BeamReading> possible_readings(const Recording& recording);

/// The recording as another reading has it: times of beams, and their order, change. `time_increment_s` is as
/// in BeamReading: of the message's array.
Recording read_as(const Recording& recording, double time_increment_s);

/// How a recording is to be read.
struct RankedReadings {
  std::vector<BeamReading> beams;  // empty if nothing is decided: 3D scanner, moving rig, too few sweeps
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  // that the motor turns about
  bool axis_is_found = false;                       // another than the rig's
  double offset_doubt_s = 0;                        // between the readings of which none is chosen
};

/// Ranks the readings of a recording by how well sweeps of opposite directions fit each other: for a
/// stationary rig, a wrong reading leaves distances that no offset removes. Each costs a coarse search and a
/// small least squares on the first sweeps; the recorded one alone is tried where it fits. The one to be used
/// is `chosen`: the only one left after those that the sectors of the motor's angle contradict. Unless the
/// rig states its mount, the laser's y axis is tried beside its x axis: the wrong one bends walls.
RankedReadings rank_readings(const Recording& recording, const Job& job);

/// The possible reading that is nearest to what the surfaces say of the time from a scan's first to its last
/// beam, if this is another one than the recording's and they say it clearly.
std::optional<BeamReading> better_reading(const Recording& recording, const StationaryDirect& found);

}  // namespace sweepscope
