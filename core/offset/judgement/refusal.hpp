#pragma once

// docs/algorithms.md, section 14.

#include <fmt/format.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sweepscope {

/// Why an offset is not given. The codes that JSON shows and the sentences are in refusal.cpp.
enum class RefusalKind {
  // The streams.
  kFewMotorSamples,
  kMotorDoesNotMove,
  kTwoMotorSources,
  kHardlyRadians,
  kOneWayAtOneSpeed,
  kOneWayMotorAndCriteria,
  kOneWayMotorAndMovingRig,
  kUnevenScanTimes,
  kSparseMotorSamples,
  kMotorGaps,
  kFewSweeps,
  kFewScanLines,
  kBeamTimesUnknown,
  // The coarse search.
  kFewSharedSurfaces,
  kScanLinesDoNotRepeat,
  kEdgeOfSearch,
  kFlatCost,
  kLinesTooFarApart,
  kSweepsFitNowhere,
  kTwoOffsetsFit,
  // The kind of rig.
  kRigMoved,
  kShortWalk,
  kMovedTooFar,
  kCalibrationMoved,
  // The least squares.
  kFewMatches,
  kNotConverged,
  kLargeResiduals,
  kSmallLever,
  // A walk.
  kLongSweeps,
  kSmoothMotor,
  kTrackLost,
  kPosesCoverFewSweeps,
  kNoMatchesAtOffset,
  kMapNotSharpest,
  // The paper's criteria.
  kSweepsNotRegistered,
  kCriteriaDisagree,
  kRollDoesNotFollow,
  kSweepsApart,
  // The answer.
  kBeyondSearch,
  kSigmaUnknown,
  kSigmaTooLarge,
  kClocksDrift,
  kOffsetJumps,
  kOffsetChanges,
  kNoCourse,
  kNoWindow,
  // Several recordings.
  kRecordingsDiffer,
  // No recording's fault.
  kListeningEnded,
  kInterrupted,
  kUnknown,  // read from a file without codes
};

/// A kind as it is declared once. `limit` is of Limits, in `unit`; `text` is fmt's format of the sentence.
struct RefusalEntry {
  RefusalKind kind;             // what it declares
  const char* code;             // in JSON
  std::optional<double> limit;  // absent: it has no number
  const char* unit;             // of value and limit
  const char* text;             // with places for what is shown
};
/// All kinds, in their order.
std::span<const RefusalEntry> refusal_entries();
/// The declaration of a kind.
const RefusalEntry& entry_of(RefusalKind kind);
/// kUnknown for a code that is not known.
RefusalKind refusal_kind_of(std::string_view code);

/// Why an offset is not given, as data: what was measured, in the unit of its kind, and what it would have to
/// keep to. Both are absent where the kind has no number.
struct Refusal {
  RefusalKind kind = RefusalKind::kUnknown;  // its code is that of entry_of
  std::optional<double> value, limit;        // what was measured, and what it had to keep to
  std::string text;                          // a sentence
};
/// In the order in which they were found.
using Refusals = std::vector<Refusal>;

/// A refusal of a kind whose limit is the entry's; `shown` are what its sentence shows.
template <typename... Shown>
Refusal refusal(RefusalKind kind, std::optional<double> value, const Shown&... shown) {
  const RefusalEntry& entry = entry_of(kind);
  return {kind, value, entry.limit, fmt::format(fmt::runtime(entry.text), shown...)};
}

/// Appends what there is to append.
inline void add(Refusals& to, std::optional<Refusal> one) {
  if (one) to.push_back(std::move(*one));
}
/// The same for a remark.
inline void add(std::vector<std::string>& to, const std::optional<std::string>& remark) {
  if (remark) to.push_back(*remark);
}

/// Their sentences.
std::vector<std::string> texts_of(const Refusals& refusals);

}  // namespace sweepscope
