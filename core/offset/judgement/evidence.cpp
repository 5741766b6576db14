#include "core/offset/judgement/evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numbers.hpp"
#include "core/offset/judgement/limits.hpp"

namespace sweepscope {
namespace {

using enum RefusalKind;

double mean_of(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += values[i];
  return sum / double(end - begin);
}

double squares_about(const std::vector<double>& values, std::size_t begin, std::size_t end, double mean) {
  double squares = 0;
  for (std::size_t i = begin; i < end; ++i) squares += (values[i] - mean) * (values[i] - mean);
  return squares;
}

/// Levels before `before_end` and from `after_begin` on.
OffsetStep step_at(const std::vector<double>& times_s, const std::vector<double>& offsets_s,
                   std::size_t before_end, std::size_t after_begin) {
  OffsetStep step{times_s[before_end - 1], times_s[after_begin], mean_of(offsets_s, 0, before_end),
                  mean_of(offsets_s, after_begin, offsets_s.size()), 0};
  step.squares_s2 = squares_about(offsets_s, 0, before_end, step.before_s) +
                    squares_about(offsets_s, after_begin, offsets_s.size(), step.after_s);
  return step;
}

/// What a straight line leaves of the series.
double squares_about_line(const std::vector<double>& times_s, const std::vector<double>& offsets_s,
                          double slope) {
  const double time_s = mean_of(times_s, 0, times_s.size()),
               offset_s = mean_of(offsets_s, 0, offsets_s.size());
  double squares = 0;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const double left_s = offsets_s[i] - offset_s - slope * (times_s[i] - time_s);
    squares += left_s * left_s;
  }
  return squares;
}

void widen(Verdict& verdict, const char* name, double by_s) {
  if (!verdict.sigma_s || !(by_s > 0)) return;
  verdict.sigma_s = std::hypot(*verdict.sigma_s, by_s);
  verdict.widened.emplace_back(name, by_s);
}

/// A fit that did not converge has no answer; of a walk, whose matches change between the iterations, it may
/// be off by as much as the last step.
void judge_steps(const OffsetEvidence& evidence, Verdict& verdict) {
  const double step_s = std::abs(evidence.last_step_s);
  if (!evidence.converged) {
    Refusal refused = refusal(kNotConverged, evidence.last_step_s * 1e3);
    if (!evidence.steps_may_alternate || !(step_s < verdict.sigma_s.value_or(0)))
      verdict.refusals.push_back(std::move(refused));
    else
      verdict.warnings.push_back(std::move(refused.text));
  }
  widen(verdict, "steps", step_s);
}

/// Residuals beyond the noise are errors that whole surfaces share: they do not average out.
void judge_residuals(const OffsetEvidence& evidence, Verdict& verdict) {
  if (!(evidence.range_noise_m > 0)) return;
  const double noises = evidence.residual_m / evidence.range_noise_m;
  if (noises > kLimits.max_residual_noises) {
    verdict.refusals.push_back(
        refusal(kLargeResiduals, noises, evidence.residual_m * 1e3, evidence.range_noise_m * 1e3));
  } else if (noises > kLimits.usual_residual_noises && evidence.lever_m_s > 0) {
    const double usual_m = kLimits.usual_residual_noises * evidence.range_noise_m;
    widen(verdict, "residuals",
          std::sqrt(evidence.residual_m * evidence.residual_m - usual_m * usual_m) / evidence.lever_m_s);
    verdict.warnings.push_back(fmt::format(
        "At the best offset the points lie {:.0f} mm from the surfaces that the other direction measured, and "
        "the ranges scatter by {:.0f} mm: the beams may be read in another order or at other times than they "
        "were fired. The uncertainty covers this.",
        evidence.residual_m * 1e3, evidence.range_noise_m * 1e3));
  }
}

struct Series {
  std::vector<double> times_s, offsets_s, sigmas_s;
};

/// Of the difference of the means before and behind two places, by the parts' own deviations.
double sigma_of_difference_s(const Series& series, std::size_t before_end, std::size_t after_begin) {
  const auto squares_s2 = [&](std::size_t begin, std::size_t end) {
    double sum_s2 = 0;
    for (std::size_t i = begin; i < end; ++i) sum_s2 += series.sigmas_s[i] * series.sigmas_s[i];
    return sum_s2 / double((end - begin) * (end - begin));
  };
  return std::sqrt(squares_s2(0, before_end) + squares_s2(after_begin, series.sigmas_s.size()));
}

Series series_of(const OffsetEvidence& evidence) {
  Series series;
  for (const PartOffset& part : evidence.parts) {
    series.times_s.push_back(part.time_s);
    series.offsets_s.push_back(part.offset_s);
    series.sigmas_s.push_back(part.sigma_s);
  }
  return series;
}

Refusal jump_refusal(const OffsetEvidence& evidence, const OffsetStep& step) {
  const double middle_s = (step.begin_s + step.end_s) / 2;
  return refusal(kOffsetJumps, step.size_s() * 1e3, step.size_s() * 1e3, step.begin_s, step.end_s,
                 advice_on_change(evidence, middle_s));
}

/// A step of more than 1 ms that the parts show far beyond their own scatter: two on either side, since a
/// single one at an end may be badly determined.
bool is_clear(const OffsetStep& step, const Series& series, double sigma_s) {
  const std::vector<double>&offsets_s = series.offsets_s, &times_s = series.times_s;
  constexpr std::size_t kMinParts = 4;
  constexpr double kMinRatio = 25;  // of the variances: five sigma of the scatter about the step
  const double n = double(offsets_s.size());
  if (offsets_s.size() < kMinParts || step.begin_s < times_s[1] || step.end_s > times_s[times_s.size() - 2] ||
      std::abs(step.size_s()) < kLimits.max_change_s ||
      std::abs(step.size_s()) < kLimits.min_change_sigmas * sigma_s)
    return false;
  const auto place = [&](double time_s) {
    return std::size_t(std::ranges::find(times_s, time_s) - times_s.begin());
  };
  const double chance_s = sigma_of_difference_s(series, place(step.begin_s) + 1, place(step.end_s));
  if (std::abs(step.size_s()) < kLimits.min_change_sigmas * chance_s) return false;
  const double constant_s2 =
      squares_about(offsets_s, 0, offsets_s.size(), mean_of(offsets_s, 0, offsets_s.size()));
  return (constant_s2 - step.squares_s2) * (n - 2) > kMinRatio * step.squares_s2;
}

/// The clocks drift apart, or the offset jumps: what fits the parts better.
MaybeRefusal change_of(const OffsetEvidence& evidence, const Series& series, double sigma_s) {
  MaybeRefusal drift;
  if (evidence.trend)
    drift = drift_refusal(*evidence.trend, evidence.duration_s, sigma_s,
                          advice_on_change(evidence, std::nullopt));
  const auto step = best_step(series.times_s, series.offsets_s);
  if (!step || series.times_s.size() < 4) return drift;
  const double slope = evidence.trend ? evidence.trend->slope : 0;
  const bool steps_more = step->squares_s2 < squares_about_line(series.times_s, series.offsets_s, slope);
  if (drift) return steps_more ? jump_refusal(evidence, *step) : *drift;
  if (steps_more && is_clear(*step, series, sigma_s)) return jump_refusal(evidence, *step);
  return std::nullopt;
}

/// Without parts of little information, whose lines hardly meet: their offsets are some by chance, and a
/// change of a millisecond could not be seen in them.
Series certain_parts(const Series& series) {
  constexpr double kMuchMore = 3;  // than the median part's
  const double max_sigma_s =
      std::max(kMuchMore * median(series.sigmas_s), kLimits.max_change_s / kLimits.min_change_sigmas);
  Series certain;
  for (std::size_t i = 0; i < series.sigmas_s.size(); ++i) {
    if (series.sigmas_s[i] > max_sigma_s) continue;
    certain.times_s.push_back(series.times_s[i]);
    certain.offsets_s.push_back(series.offsets_s[i]);
    certain.sigmas_s.push_back(series.sigmas_s[i]);
  }
  return certain;
}

/// Where neighbours in time err together, their scatter hides it, and the halves disagree.
void judge_halves(const OffsetEvidence& evidence, const Series& series, Verdict& verdict) {
  constexpr std::size_t kMinParts = 4;  // of fewer, the halves themselves are too uncertain to widen sigma
  const std::size_t parts = series.offsets_s.size(), middle = parts / 2;
  if (!verdict.sigma_s || parts < 2) return;
  double halves_s[2] = {0, 0};
  for (std::size_t i = 0; i < parts; ++i)
    halves_s[i < middle ? 0 : 1] += series.offsets_s[i] / double(i < middle ? middle : parts - middle);
  const double half_apart_s = std::abs(halves_s[1] - halves_s[0]) / 2;
  const double chance_s = sigma_of_difference_s(series, middle, middle) / 2;
  if (half_apart_s < kLimits.min_change_sigmas * *verdict.sigma_s) return;
  const double middle_s = (series.times_s[middle - 1] + series.times_s[middle]) / 2;
  const bool changes = 2 * half_apart_s > kLimits.max_change_s,
             by_chance = half_apart_s < kLimits.min_change_sigmas * chance_s;
  if (parts < kMinParts && changes && !by_chance) {
    verdict.refusals.push_back(refusal(kOffsetChanges, (halves_s[1] - halves_s[0]) * 1e3, halves_s[0] * 1e3,
                                       series.times_s.front(), halves_s[1] * 1e3,
                                       advice_on_change(evidence, middle_s)));
    return;
  }
  if (parts < kMinParts && !changes) return;
  verdict.sigma_s = half_apart_s;
  verdict.widened.emplace_back("halves", half_apart_s);
  verdict.warnings.push_back(fmt::format("The halves of the recording disagree: {:.3f} ms and {:.3f} ms.",
                                         halves_s[0] * 1e3, halves_s[1] * 1e3));
}

}  // namespace

std::optional<OffsetStep> best_step(const std::vector<double>& times_s,
                                    const std::vector<double>& offsets_s) {
  constexpr std::size_t kMinForMixed = 4;
  constexpr double kMuchLess = 0.25;  // of the squares, for a value that counts on neither side
  const std::size_t n = offsets_s.size();
  std::optional<OffsetStep> best, mixed;
  for (std::size_t i = 1; i < n; ++i) {
    const OffsetStep step = step_at(times_s, offsets_s, i, i);
    if (!best || step.squares_s2 < best->squares_s2) best = step;
    if (i + 1 >= n || n < kMinForMixed) continue;
    const OffsetStep across = step_at(times_s, offsets_s, i, i + 1);
    const bool between = (offsets_s[i] - across.before_s) * (offsets_s[i] - across.after_s) < 0;
    if (between && (!mixed || across.squares_s2 < mixed->squares_s2)) mixed = across;
  }
  return mixed && mixed->squares_s2 < kMuchLess * best->squares_s2 ? mixed : best;
}

std::string advice_on_change(const OffsetEvidence& evidence, std::optional<double> jump_s) {
  constexpr double kMinWindows = 4, kMinBeside = 2;
  const double duration_s = evidence.duration_s, window_s = evidence.min_window_s;
  if (!jump_s && duration_s < kMinWindows * window_s)
    return fmt::format(
        "Record at least {:.0f} s, and search over time for the offset and its rate (estimate --over-time).",
        std::ceil(kMinWindows * window_s));
  if (jump_s && std::min(*jump_s, duration_s - *jump_s) < kMinBeside * window_s)
    return "Estimate the time before it and the time after it each by itself (--window FROM:TO).";
  return std::string(kSearchOverTime);
}

Verdict judge_constant(const OffsetEvidence& evidence, std::optional<double> sigma_s) {
  Verdict verdict{sigma_s, {}, {}, {}};
  judge_steps(evidence, verdict);
  judge_residuals(evidence, verdict);
  const Series series = series_of(evidence);
  if (auto change = change_of(evidence, series, verdict.sigma_s.value_or(0)))
    verdict.refusals.push_back(std::move(*change));
  else
    judge_halves(evidence, certain_parts(series), verdict);
  return verdict;
}

bool is_off_course(const PartOffset& part) {
  return std::abs(part.offset_s - part.expected_s) > kLimits.min_window_sigmas * part.sigma_s;
}

Verdict judge_course(const OffsetEvidence& evidence, double sigma_s) {
  Verdict verdict{sigma_s, {}, {}, {}};
  judge_steps(evidence, verdict);
  const PartOffset* worst = nullptr;
  const auto off_s = [](const PartOffset& part) { return std::abs(part.offset_s - part.expected_s); };
  for (const PartOffset& part : evidence.parts)
    if (is_off_course(part) && (worst == nullptr || off_s(part) > off_s(*worst))) worst = &part;
  if (worst == nullptr) return verdict;
  if (off_s(*worst) > kLimits.max_change_s)
    verdict.refusals.push_back(refusal(kNoCourse, (worst->offset_s - worst->expected_s) * 1e3, worst->time_s,
                                       worst->offset_s * 1e3, worst->expected_s * 1e3));
  else
    widen(verdict, "windows", off_s(*worst) / kLimits.min_change_sigmas);
  return verdict;
}

}  // namespace sweepscope
