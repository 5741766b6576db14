#include "core/offset/estimate_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace sweepscope {
namespace {

tl::unexpected<Error> wrong(const std::string& needed) {
  return failure(ExitCode::kWrongUsage, needed);
}

// So many numbers with colons between them, with or without "ms" at the end.
std::optional<std::vector<double>> numbers_of(std::string text, std::size_t count) {
  if (text.ends_with("ms")) text.resize(text.size() - 2);
  std::vector<double> numbers;
  const char *at = text.data(), *end = text.data() + text.size();
  while (numbers.size() < count) {
    double number = 0;
    if (at < end && *at == '+') ++at;
    const auto [after, error] = std::from_chars(at, end, number);
    const bool last = numbers.size() + 1 == count;
    const bool separated = last ? after == end : after != end && *after == ':';
    if (error != std::errc() || !separated || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
    at = after + (last ? 0 : 1);
  }
  return numbers;
}

Result<void> set_range(EstimateOptions& options, const std::string& text) {
  const auto ms = numbers_of(text, 3);
  if (!ms || !((*ms)[0] <= (*ms)[1]) || !((*ms)[2] > 0))
    return wrong("needs FROM:TO:STEP in milliseconds, with FROM <= TO and STEP > 0");
  options.ranges.push_back({(*ms)[0] * 1e-3, (*ms)[1] * 1e-3, (*ms)[2] * 1e-3});
  return {};
}

Result<void> set_search(EstimateOptions& options, const std::string& text) {
  const auto ms = numbers_of(text, 2);
  if (!ms || !((*ms)[0] < (*ms)[1])) return wrong("needs FROM:TO in milliseconds, with FROM < TO");
  options.search = SearchRange{(*ms)[0] * 1e-3, (*ms)[1] * 1e-3};
  return {};
}

Result<void> set_around(EstimateOptions& options, const std::string& text) {
  constexpr double kMaxSteps = 100'000;  // against typing errors: a day of computing
  const auto ms = numbers_of(text, 3);
  if (!ms || !((*ms)[1] > 0) || !((*ms)[2] >= 0) || (*ms)[2] > kMaxSteps || (*ms)[2] != std::floor((*ms)[2]))
    return wrong(
        "needs INITIAL:ACCURACY:STEPS in milliseconds, with ACCURACY > 0 and a whole number of steps");
  options.around = OffsetsAround{(*ms)[0] * 1e-3, (*ms)[1] * 1e-3, static_cast<int>((*ms)[2])};
  return {};
}

std::vector<std::string_view> parts_of(std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

Result<void> set_solve(EstimateOptions& options, const std::string& text) {
  const auto parts = parts_of(text);
  for (const std::string_view part : parts) {
    if (part == "mount")
      options.solve.mount = true;
    else if (part == "play")
      options.solve.play = true;
    else if (part == "encoder")
      options.solve.encoder = true;
    else if (part != "offset")
      return wrong("takes offset, mount, play and encoder with commas between them");
  }
  return {};
}

Result<void> set_prior(EstimateOptions& options, const std::string& text) {
  constexpr const char* kNeeded =
      "needs NAME=VALUE with a value above 0, such as mount_deg=2,play_deg=0.3; the names are mount_deg, "
      "mount_mm, play_deg and encoder_deg";
  RigSolve& solve = options.solve;
  const std::array<std::pair<std::string_view, double*>, 4> priors{{{"mount_deg", &solve.mount_deg},
                                                                    {"mount_mm", &solve.mount_mm},
                                                                    {"play_deg", &solve.play_deg},
                                                                    {"encoder_deg", &solve.encoder_deg}}};
  for (const std::string_view part : parts_of(text)) {
    const auto equals = std::min(part.find('='), part.size());
    const auto found =
        std::ranges::find(priors, part.substr(0, equals), &std::pair<std::string_view, double*>::first);
    const auto value =
        equals < part.size() ? numbers_of(std::string(part.substr(equals + 1)), 1) : std::nullopt;
    if (found == priors.end() || !value || !((*value)[0] > 0)) return wrong(kNeeded);
    *found->second = (*value)[0];
  }
  return {};
}

Result<void> set_over_time(EstimateOptions& options, const std::string& text) {
  constexpr double kMin_s = 1, kMax_s = 86'400;  // about a sweep; a day
  if (text.empty()) {
    options.over_time_s = 0;
    return {};
  }
  const auto seconds = numbers_of(text, 1);
  if (!seconds || text.ends_with("ms") || !((*seconds)[0] >= kMin_s && (*seconds)[0] <= kMax_s))
    return wrong("needs nothing, or the length of a window in seconds, from 1 to 86400");
  options.over_time_s = (*seconds)[0];
  return {};
}

EstimateOption choice(std::string name, std::string type, std::string help, std::vector<std::string> choices,
                      std::function<void(EstimateOptions&, std::size_t)> take) {
  EstimateOption option{
      std::move(name), std::move(type), std::move(help), std::move(choices), false, false, {}};
  option.set = [choices = option.choices, take = std::move(take)](EstimateOptions& options,
                                                                  const std::string& text) -> Result<void> {
    const auto found = std::find(choices.begin(), choices.end(), text);
    if (found == choices.end()) return wrong(fmt::format("takes {}", fmt::join(choices, ", ")));
    take(options, std::size_t(found - choices.begin()));
    return {};
  };
  return option;
}

using Number = std::optional<double> EstimateOptions::*;

EstimateOption number(std::string name, std::string help, Number value, bool zero_too) {
  EstimateOption option{std::move(name), "FLOAT", std::move(help), {}, false, false, {}};
  option.set = [value, zero_too](EstimateOptions& options, const std::string& text) -> Result<void> {
    const auto numbers = numbers_of(text, 1);
    if (!numbers || !(zero_too ? (*numbers)[0] >= 0 : (*numbers)[0] > 0))
      return wrong(zero_too ? "needs a number of at least 0" : "needs a number above 0");
    options.*value = (*numbers)[0];
    return {};
  };
  return option;
}

// Which method, and what the paper's methods take.
std::vector<EstimateOption> method_options() {
  const std::string gates = fmt::format(" (default: {})", MappingOptions().edge_gate_m);
  return {
      choice("method", "M",
             "direct: the offset as an unknown of a least-squares fit, for stationary and moving rigs; "
             "stationary: the offset at which odometry registers the least motion (d); moving: the offset at "
             "which the map is sharpest (n, e). Default: direct; with an option of the paper's methods, "
             "stationary or moving, as the motion test decides",
             {"stationary", "moving", "direct"},
             [](EstimateOptions& options, std::size_t i) {
               options.method = std::array{Method::kStationary, Method::kMoving, Method::kDirect}[i];
             }),
      choice("fit", "F",
             "none: the best candidate; parabola: the extremum of a parabola through n within 3 units of the "
             "best candidate, or through the squares of d or e within 1 unit. A unit is 1 ms, and more for "
             "slow motors (default: parabola for moving rigs and for slow motors, otherwise none)",
             {"none", "parabola"},
             [](EstimateOptions& options, std::size_t i) {
               options.fit = i == 0 ? Fit::kNone : Fit::kParabola;
             }),
      choice("scoring", "S",
             "two-stage: count matches along the one trajectory that fits the recording best (default); "
             "loam: at LOAM's own poses, tracked at each candidate, as the paper did",
             {"two-stage", "loam"},
             [](EstimateOptions& options, std::size_t i) {
               options.scoring = i == 0 ? Scoring::kTwoStage : Scoring::kLoam;
             }),
      number("weight-c", "c of d = sqrt(t^2 + c theta^2) (default: 1)", &EstimateOptions::weight_c, true),
      number("edge-gate-m", "delta_E: an edge match is nearer than this" + gates,
             &EstimateOptions::edge_gate_m, false),
      number("plane-gate-m", "delta_H: a plane match is nearer than this" + gates,
             &EstimateOptions::plane_gate_m, false)};
}

// Where the offset is searched for.
std::vector<EstimateOption> range_options() {
  return {
      {"search",
       "FROM:TO",
       "Where the offset is searched for, in milliseconds, such as 100:300 (default: about 0, and if it is "
       "not there, all offsets that the motor's motion distinguishes: a quarter of its period to either "
       "side, or more where it starts, stops or changes its speed; info prints how many ms)",
       {},
       false,
       false,
       set_search},
      {"range",
       "FROM:TO:STEP",
       "Candidates in milliseconds, such as 19:29:1; repeatable (default: coarse to fine about 0)",
       {},
       true,
       false,
       set_range},
      {"around",
       "INITIAL:ACCURACY:STEPS",
       "The paper's search in milliseconds: 24:0.1:40 tries 24 and 20 steps of 0.1 to either side",
       {},
       false,
       false,
       set_around}};
}

// What is found beside one constant offset.
std::vector<EstimateOption> rig_options() {
  return {{"solve",
           "offset[,mount][,play][,encoder]",
           "Solve for parts of the rig beside the offset: how the laser is mounted on the motor, the play of "
           "the gear, the encoder's eccentricity. From a walk only the rotation of the laser is found",
           {},
           false,
           false,
           set_solve},
          {"prior",
           "NAME=VALUE[,...]",
           "How far the parts that are solved for may be from the rig file, as standard deviations: "
           "mount_deg (default: 20), mount_mm (500), play_deg (0.5), encoder_deg (1)",
           {},
           false,
           false,
           set_prior},

          {"over-time",
           "SECONDS",
           "The offset in windows of at least this length (default: 10 s, and at least 12 sweeps), and its "
           "course: constant, drifting or with jumps. offset_ms is then the offset at the middle of the "
           "recording",
           {},
           false,
           true,
           set_over_time}};
}

std::vector<EstimateOption> declared() {
  std::vector<EstimateOption> all = method_options();
  for (const auto& more : {range_options(), rig_options()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace

std::span<const EstimateOption> estimate_options() {
  static const std::vector<EstimateOption> options = declared();
  return options;
}

const EstimateOption* find_estimate_option(std::string_view name) {
  const auto options = estimate_options();
  const auto found = std::find_if(options.begin(), options.end(),
                                  [&](const EstimateOption& option) { return option.name == name; });
  return found == options.end() ? nullptr : &*found;
}

}  // namespace sweepscope
