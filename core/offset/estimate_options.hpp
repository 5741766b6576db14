#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/loam/mapping.hpp"
#include "core/loam/odometry.hpp"
#include "core/offset/candidates.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/given_poses.hpp"
#include "core/rig_solve/rig_solve.hpp"

namespace sweepscope {

enum class Fit { kNone, kParabola };
enum class Scoring { kTwoStage, kLoam };

/// How an offset is searched for. Empty members are decided from the recording.
struct EstimateOptions {
  std::optional<Method> method;     // none: see method_of
  std::optional<RigKind> assume;    // instead of the motion test
  std::vector<OffsetRange> ranges;  // none, and no `around`: coarse to fine over the default window
  std::optional<OffsetsAround> around;
  std::optional<Fit> fit;  // none: a parabola for moving rigs and slow motors, else the least candidate
  std::optional<Scoring> scoring;      // none: two-stage
  std::optional<double> weight_c;      // c of equation 3; none: 1
  std::optional<double> edge_gate_m;   // delta_E of equation 4; none: that of `mapping`
  std::optional<double> plane_gate_m;  // delta_H of equation 5; none: that of `mapping`
  RigSolve solve;                      // of the rig, beside the offset
  FeatureOptions features;
  OdometryOptions odometry;
  MappingOptions mapping;
  std::optional<double> over_time_s;  // the offset in windows of at least this length; 0: default_window_s
  std::optional<GivenPoses> poses;    // of a moving rig, for the direct method
  /// The trajectory that an estimate of the same recording was judged by: criteria along it cost no tracking.
  std::shared_ptr<const SolvedWalk> walk;
};

/// The method that an estimate uses, the same for every part of the program: the requested one; otherwise, if
/// an option of the paper's criteria is set or candidates are kept in a file, the paper's method for that
/// kind of rig; otherwise the direct method.
Method method_of(const EstimateOptions& options, RigKind kind, bool keeps_candidates = false);

/// How the map is searched, with the gates of the criteria.
MappingOptions mapping_of(const EstimateOptions& options);

/// One option of an estimate, declared once: the command line's `--name VALUE`, a recipe's `name: value` and
/// the explorer's choices come from it.
struct EstimateOption {
  std::string name;                  // "weight-c"
  std::string type;                  // what a value looks like: "FROM:TO:STEP"
  std::string help;                  // a sentence
  std::vector<std::string> choices;  // all valid values; empty: see `type`
  bool repeats = false;
  bool value_optional = false;  // then `set` takes an empty text as well
  /// Sets the option from text. An invalid value is ExitCode::kWrongUsage; the message says what is needed.
  std::function<Result<void>(EstimateOptions&, const std::string&)> set;
};

std::span<const EstimateOption> estimate_options();
/// The option of that name, or null.
const EstimateOption* find_estimate_option(std::string_view name);

}  // namespace sweepscope
