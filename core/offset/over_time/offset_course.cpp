#include "core/offset/over_time/offset_course.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kMinWindows = 2;  // between jumps, and before the first and after the last
constexpr std::size_t kMinForLine = 4;  // windows
constexpr std::size_t kMaxJumps = 20;   // a bound on the time; a clock that jumps more often has no course
constexpr double kLossWidth = 3;        // Cauchy, in sigmas
// Parameters that a jump counts as, since its time is fitted too (Zhang and Siegmund 2007). A rate counts as
// many, so that one in a thousand constant offsets is mistaken for a drifting one.
constexpr double kPenalty = 3;
constexpr double kMinCounted = 30;  // windows, as BIC counts them: of few, chance would pass for a change

// The windows with an offset, ordered by time, their sigmas multiplied by the scatter.
struct WindowSeries {
  std::vector<double> time_s, offset_s, sigma_s;
  double middle_s = 0;

  std::size_t size() const { return time_s.size(); }
};

// Each jump lies before the window of this number; ascending.
struct Model {
  bool line = false;
  std::vector<std::size_t> jumps;
};

// The windows between two jumps.
struct Segment {
  std::size_t begin = 0, end = 0;
  double information = 0;           // the inverse of its mean's variance
  double time_s = 0, offset_s = 0;  // weighted means, the time from the middle
};

// The segments' offsets have one slope in common, and each its own level.
struct Fitted {
  Model model;
  std::vector<Segment> segments;
  double slope = 0, slope_variance = 0;
  double cost = std::numeric_limits<double>::infinity();
  double score = std::numeric_limits<double>::infinity();

  // At the middle, as if the segment reached there.
  double level_s(const Segment& segment) const { return segment.offset_s - slope * segment.time_s; }
};

// One standard deviation as a multiple of the median of sizes of which the two largest are left out, as those
// beside a jump; of many sizes they count for nothing.
double scatter_of_smaller(std::vector<double> sizes) {
  constexpr std::size_t kFew = 10;
  if (sizes.size() >= kFew) return kSigmaPerMedianDeviation * median(std::move(sizes));
  const double part = 0.5 * double(sizes.size() - 2) / double(sizes.size());
  std::ranges::sort(sizes);
  sizes.resize(sizes.size() - 2);
  // The quantile of a normal distribution's sizes, by the first terms of its series: to 1 % up to a half.
  const double quantile = std::sqrt(std::numbers::pi / 2) * part * (1 + std::numbers::pi / 12 * part * part);
  return median(std::move(sizes)) / quantile;
}

// The scatter of the windows in units of their sigmas, from the distance of each from the mean of its
// neighbours: insensitive to a drift and to a few jumps.
double scatter_of(const WindowSeries& series) {
  constexpr std::size_t kMin = 6;  // of fewer windows the median is mostly noise
  if (series.size() < kMin) return 1;
  std::vector<double> sizes;
  for (std::size_t i = 1; i + 1 < series.size(); ++i) {
    const double u =
        (series.time_s[i] - series.time_s[i - 1]) / (series.time_s[i + 1] - series.time_s[i - 1]);
    const double between_s = std::lerp(series.offset_s[i - 1], series.offset_s[i + 1], u);
    const double sigma_s =
        std::hypot(series.sigma_s[i], (1 - u) * series.sigma_s[i - 1], u * series.sigma_s[i + 1]);
    sizes.push_back(std::abs(series.offset_s[i] - between_s) / sigma_s);
  }
  return std::max(1.0, scatter_of_smaller(std::move(sizes)));
}

WindowSeries series_of(const std::vector<OffsetWindow>& windows, double middle_s) {
  WindowSeries series;
  series.middle_s = middle_s;
  for (const OffsetWindow& window : windows) {
    if (!window.offset_s || !window.sigma_s || !(*window.sigma_s > 0)) continue;
    series.time_s.push_back(window.time_s);
    series.offset_s.push_back(*window.offset_s);
    series.sigma_s.push_back(*window.sigma_s);
  }
  return series;
}

double jump_time_s(const WindowSeries& series, std::size_t jump) {
  return (series.time_s[jump - 1] + series.time_s[jump]) / 2;
}

std::vector<Segment> segments_of(const WindowSeries& series, const Model& model) {
  std::vector<Segment> segments;
  std::size_t begin = 0;
  for (const std::size_t jump : model.jumps) {
    segments.push_back({begin, jump});
    begin = jump;
  }
  segments.push_back({begin, series.size()});
  return segments;
}

// Weighted least squares for the levels and the slope. About their means the segments have no level, which
// leaves one equation for the slope.
void solve(const WindowSeries& series, const std::vector<double>& weights, Fitted& fit) {
  double times_s2 = 0, products_s2 = 0;
  for (Segment& segment : fit.segments) {
    const auto time_s = [&](std::size_t i) { return series.time_s[i] - series.middle_s; };
    const auto information = [&](std::size_t i) {
      return weights[i] / (series.sigma_s[i] * series.sigma_s[i]);
    };
    segment = {segment.begin, segment.end};
    for (std::size_t i = segment.begin; i < segment.end; ++i) {
      segment.information += information(i);
      segment.time_s += information(i) * time_s(i);
      segment.offset_s += information(i) * series.offset_s[i];
    }
    segment.time_s /= segment.information;
    segment.offset_s /= segment.information;
    if (!fit.model.line) continue;
    for (std::size_t i = segment.begin; i < segment.end; ++i) {
      const double from_mean_s = time_s(i) - segment.time_s;
      times_s2 += information(i) * from_mean_s * from_mean_s;
      products_s2 += information(i) * from_mean_s * (series.offset_s[i] - segment.offset_s);
    }
  }
  fit.slope = times_s2 > 0 ? products_s2 / times_s2 : 0;
  fit.slope_variance = times_s2 > 0 ? 1 / times_s2 : 0;
}

// The distance of each window from the fit, in units of the loss's width.
std::vector<double> residuals_of(const WindowSeries& series, const Fitted& fit) {
  std::vector<double> residuals(series.size());
  for (const Segment& segment : fit.segments) {
    const double level_s = fit.level_s(segment);
    for (std::size_t i = segment.begin; i < segment.end; ++i)
      residuals[i] = (series.offset_s[i] - level_s - fit.slope * (series.time_s[i] - series.middle_s)) /
                     (kLossWidth * series.sigma_s[i]);
  }
  return residuals;
}

// Iteratively reweighted least squares (Cauchy), beginning with even weights.
Fitted fitted(const WindowSeries& series, const Model& model, int iterations) {
  Fitted fit;
  fit.model = model;
  fit.segments = segments_of(series, model);
  std::vector<double> weights(series.size(), 1.0), residuals;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    solve(series, weights, fit);
    residuals = residuals_of(series, fit);
    for (std::size_t i = 0; i < series.size(); ++i) weights[i] = 1 / (1 + residuals[i] * residuals[i]);
  }
  fit.cost = 0;
  for (const double residual : residuals)
    fit.cost += kLossWidth * kLossWidth * std::log1p(residual * residual);
  const double parameters = 1 + kPenalty * (double(model.line ? 1 : 0) + double(model.jumps.size()));
  fit.score = fit.cost + parameters * std::log(std::max(kMinCounted, double(series.size())));
  return fit;
}

Fitted fitted(const WindowSeries& series, const Model& model) {
  constexpr int kIterations = 12;  // of the weights
  return fitted(series, model, kIterations);
}

bool apart(const std::vector<std::size_t>& jumps, std::size_t jump, std::size_t windows) {
  if (jump < kMinWindows || jump + kMinWindows > windows) return false;
  return std::ranges::all_of(
      jumps, [&](std::size_t other) { return std::max(other, jump) - std::min(other, jump) >= kMinWindows; });
}

Model with_jump(Model model, std::size_t jump) {
  model.jumps.insert(std::ranges::upper_bound(model.jumps, jump), jump);
  return model;
}

Model without_jump(Model model, std::size_t place) {
  model.jumps.erase(model.jumps.begin() + std::ptrdiff_t(place));
  return model;
}

// With one more jump, at the place that lowers the cost most; the score is infinite if there is no place.
Fitted with_best_jump(const WindowSeries& series, const Model& model) {
  constexpr int kRoughIterations = 2;  // enough to rank the places; the best one is fitted again
  Fitted best;
  for (std::size_t jump = kMinWindows; jump + kMinWindows <= series.size(); ++jump) {
    if (!apart(model.jumps, jump, series.size())) continue;
    Fitted candidate = fitted(series, with_jump(model, jump), kRoughIterations);
    if (candidate.cost < best.cost) best = std::move(candidate);
  }
  return best.model.jumps.empty() ? best : fitted(series, best.model);
}

// Moves each jump to its best place given the others, until none moves.
Fitted settled(const WindowSeries& series, Fitted fit) {
  constexpr int kMaxRounds = 5;  // against jumps that swap places without end
  bool moved = true;
  for (int round = 0; moved && round < kMaxRounds; ++round) {
    moved = false;
    for (std::size_t place = 0; place < fit.model.jumps.size(); ++place) {
      const std::size_t before = fit.model.jumps[place];
      Fitted other = with_best_jump(series, without_jump(fit.model, place));
      if (!(other.score < fit.score) || std::ranges::count(other.model.jumps, before) > 0) continue;
      fit = std::move(other);
      moved = true;
    }
  }
  return fit;
}

Fitted without_needless_jumps(const WindowSeries& series, Fitted fit) {
  for (std::size_t place = 0; place < fit.model.jumps.size();) {
    Fitted other = fitted(series, without_jump(fit.model, place));
    if (other.score < fit.score) {
      fit = std::move(other);
      place = 0;
    } else {
      ++place;
    }
  }
  return fit;
}

// Adds jumps one by one, looking a few ahead: of a step up and one down, the first alone gains little.
Fitted best_with_jumps(const WindowSeries& series, bool line) {
  constexpr int kPatience = 2;  // jumps that may bring no gain, before one that does
  Fitted best = fitted(series, Model{line, {}}), last = best;
  for (int idle = 0; idle <= kPatience && last.model.jumps.size() < kMaxJumps;) {
    last = settled(series, with_best_jump(series, last.model));
    if (!std::isfinite(last.score)) break;
    idle = last.score < best.score ? 0 : idle + 1;
    if (last.score < best.score) best = last;
  }
  return without_needless_jumps(series, std::move(best));
}

// From the last window before a jump to the first one after it; a window that lies on neither side is where
// the offset jumps.
std::pair<double, double> jump_interval_s(const WindowSeries& series, const Fitted& fit,
                                          const Segment& before, const Segment& after) {
  constexpr double kOfJump = 0.25, kSigmas = 5;
  const double size_s = std::abs(fit.level_s(after) - fit.level_s(before));
  const double sigma_s = median(series.sigma_s);
  const auto lies_off = [&](std::size_t i, const Segment& segment) {
    const double off_s =
        series.offset_s[i] - fit.level_s(segment) - fit.slope * (series.time_s[i] - series.middle_s);
    return std::abs(off_s) > std::max(kOfJump * size_s, kSigmas * sigma_s);
  };
  std::size_t last = before.end - 1, first = after.begin;
  if (last > before.begin && lies_off(last, before)) --last;
  if (first + 1 < after.end && lies_off(first, after)) ++first;
  return {series.time_s[last], series.time_s[first]};
}

OffsetCourse course_from(const WindowSeries& series, const Fitted& fit, double scatter) {
  OffsetCourse course;
  course.middle_s = series.middle_s;
  course.windows = series.size();
  course.scatter = scatter;
  course.rate = fit.slope;
  course.rate_sigma = std::sqrt(fit.slope_variance);
  const auto& segments = fit.segments;
  std::size_t at_middle = 0;
  for (std::size_t i = 0; i + 1 < segments.size(); ++i) {
    const Segment &before = segments[i], &after = segments[i + 1];
    if (series.middle_s > jump_time_s(series, after.begin)) at_middle = i + 1;
    const double apart_s = after.time_s - before.time_s;
    const auto [begin_s, end_s] = jump_interval_s(series, fit, before, after);
    course.jumps.push_back(
        {begin_s, end_s, fit.level_s(after) - fit.level_s(before),
         std::sqrt(1 / before.information + 1 / after.information + apart_s * apart_s * fit.slope_variance)});
  }
  const Segment& middle = segments[at_middle];
  course.offset_s = fit.level_s(middle);
  course.sigma_s = std::sqrt(1 / middle.information + middle.time_s * middle.time_s * fit.slope_variance);
  return course;
}

}  // namespace

double OffsetCourse::offset_at_s(double time_s) const {
  double at_s = offset_s + rate * (time_s - middle_s);
  for (const OffsetJump& jump : jumps) {
    const double jump_s = (jump.begin_s + jump.end_s) / 2;
    at_s += jump.size_s * ((time_s > jump_s ? 1 : 0) - (middle_s > jump_s ? 1 : 0));
  }
  return at_s;
}

std::optional<OffsetCourse> course_of(const std::vector<OffsetWindow>& windows, double middle_s) {
  WindowSeries series = series_of(windows, middle_s);
  if (series.size() == 0) return std::nullopt;
  const double scatter = scatter_of(series);
  for (double& sigma_s : series.sigma_s) sigma_s *= scatter;
  Fitted best = best_with_jumps(series, false);
  if (series.size() >= kMinForLine) {
    Fitted line = best_with_jumps(series, true);
    if (line.score < best.score) best = std::move(line);
  }
  return course_from(series, best, scatter);
}

}  // namespace sweepscope
