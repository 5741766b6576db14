#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/rig_solve/rig_solve.hpp"

namespace sweepscope {

/// A parameter of a rig that was solved for, as a row of a table.
struct RigParameter {
  enum class State {
    kFound,
    kGauge,         // has no effect on a map: the rig file's value is kept
    kNotDetermined  // the recording does not determine it
  };
  std::string part;                    // "mount", "play" or "encoder"
  std::string name;                    // "mount pitch"
  std::string unit;                    // "deg" or "mm"
  double given = 0;                    // by the rig file
  double found = 0;                    // `given` where it is not determined
  std::optional<double> sigma, prior;  // standard deviations; absent where there is none
  State state = State::kFound;
};

/// The parameters of the parts that were solved for, in a fixed order.
std::vector<RigParameter> rig_parameters(const SolvedRig& solved);

/// The value in words: "3.002 ± 0.004°", "0.00 mm, kept" or "not determined".
std::string in_words(const RigParameter& parameter);

/// How well the points fit before and after: a sentence.
std::string residual_text(const SolvedRig& solved);

/// Why parts of the rig are not determined: a sentence for each.
std::vector<std::string> reasons_of(const SolvedRig& solved);

}  // namespace sweepscope
