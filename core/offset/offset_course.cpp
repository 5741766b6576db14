#include "core/offset/offset_course.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kMinWindows = 3;  // between jumps, and before the first and after the last
constexpr std::size_t kMinForLine = 4;  // windows
constexpr std::size_t kMaxJumps = 20;   // a bound on the time; a clock that jumps more often has no course
constexpr double kLossWidth = 3;        // Cauchy, in sigmas
// Parameters that a jump counts as, since its time is fitted too (Zhang and Siegmund 2007). A rate counts as
// many, so that one in a thousand constant offsets is mistaken for a drifting one.
constexpr double kPenalty = 3;

// The windows with an offset, ordered by time, their sigmas multiplied by the scatter.
struct Series {
  std::vector<double> time_s, offset_s, sigma_s;
  double middle_s = 0, span_s = 1;

  std::size_t size() const { return time_s.size(); }
};

// Each jump lies before the window of this number; ascending.
struct Model {
  bool line = false;
  std::vector<std::size_t> jumps;
};

struct Fitted {
  Model model;
  Eigen::VectorXd parameters;  // the offset at the middle, the rate times the span, the jumps
  Eigen::MatrixXd covariance;
  double cost = std::numeric_limits<double>::infinity();
  double score = std::numeric_limits<double>::infinity();
};

// The scatter of the windows in units of their sigmas, from the distance of each from the mean of its
// neighbours: insensitive to a drift and to a few jumps.
double scatter_of(const Series& series) {
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
  return std::max(1.0, kSigmaPerMedianDeviation * median(std::move(sizes)));
}

Series series_of(const std::vector<OffsetWindow>& windows, double middle_s) {
  Series series;
  series.middle_s = middle_s;
  for (const OffsetWindow& window : windows) {
    if (!window.offset_s || !window.sigma_s || !(*window.sigma_s > 0)) continue;
    series.time_s.push_back(window.time_s);
    series.offset_s.push_back(*window.offset_s);
    series.sigma_s.push_back(*window.sigma_s);
  }
  if (series.size() > 1) series.span_s = std::max(1e-9, series.time_s.back() - series.time_s.front());
  return series;
}

double jump_time_s(const Series& series, std::size_t jump) {
  return (series.time_s[jump - 1] + series.time_s[jump]) / 2;
}

// The design matrix: row i gives the offset of window i.
Eigen::MatrixXd design(const Series& series, const Model& model) {
  const auto rows = Eigen::Index(series.size());
  Eigen::MatrixXd a =
      Eigen::MatrixXd::Zero(rows, Eigen::Index(1 + (model.line ? 1 : 0) + model.jumps.size()));
  a.col(0).setOnes();
  Eigen::Index column = 1;
  if (model.line) {
    for (Eigen::Index i = 0; i < rows; ++i)
      a(i, column) = (series.time_s[std::size_t(i)] - series.middle_s) / series.span_s;
    ++column;
  }
  for (const std::size_t jump : model.jumps) {
    const double at_middle = series.middle_s > jump_time_s(series, jump) ? 1 : 0;
    for (Eigen::Index i = 0; i < rows; ++i) a(i, column) = (std::size_t(i) >= jump ? 1 : 0) - at_middle;
    ++column;
  }
  return a;
}

// Iteratively reweighted least squares (Cauchy), beginning with the given weights.
Fitted fitted(const Series& series, const Model& model, std::vector<double> weights, int iterations) {
  const Eigen::MatrixXd a = design(series, model);
  Fitted fit;
  fit.model = model;
  const std::size_t n = series.size();
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(a.cols(), a.cols());
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(a.cols());
    for (std::size_t i = 0; i < n; ++i) {
      const double weight = weights[i] / (series.sigma_s[i] * series.sigma_s[i]);
      const Eigen::VectorXd row = a.row(Eigen::Index(i)).transpose();
      information.noalias() += weight * row * row.transpose();
      gradient += weight * series.offset_s[i] * row;
    }
    const Eigen::LDLT<Eigen::MatrixXd> solver(information);
    fit.parameters = solver.solve(gradient);
    fit.covariance = solver.solve(Eigen::MatrixXd::Identity(a.cols(), a.cols()));
    fit.cost = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double residual =
          (series.offset_s[i] - a.row(Eigen::Index(i)).dot(fit.parameters)) / series.sigma_s[i] / kLossWidth;
      weights[i] = 1 / (1 + residual * residual);
      fit.cost += kLossWidth * kLossWidth * std::log1p(residual * residual);
    }
  }
  const double parameters = 1 + kPenalty * (double(model.line ? 1 : 0) + double(model.jumps.size()));
  fit.score = fit.cost + parameters * std::log(double(n));
  return fit;
}

Fitted fitted(const Series& series, const Model& model) {
  constexpr int kIterations = 12;  // of the weights
  return fitted(series, model, std::vector<double>(series.size(), 1.0), kIterations);
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
Fitted with_best_jump(const Series& series, const Model& model) {
  constexpr int kRoughIterations = 2;  // enough to rank the places; the best one is fitted again
  const std::vector<double> even(series.size(), 1.0);
  Fitted best;
  for (std::size_t jump = kMinWindows; jump + kMinWindows <= series.size(); ++jump) {
    if (!apart(model.jumps, jump, series.size())) continue;
    Fitted candidate = fitted(series, with_jump(model, jump), even, kRoughIterations);
    if (candidate.cost < best.cost) best = std::move(candidate);
  }
  return best.model.jumps.empty() ? best : fitted(series, best.model);
}

// Moves each jump to its best place given the others, until none moves.
Fitted settled(const Series& series, Fitted fit) {
  constexpr int kMaxRounds = 5;  // against jumps that swap places for ever
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

Fitted without_needless_jumps(const Series& series, Fitted fit) {
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
Fitted best_with_jumps(const Series& series, bool line) {
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

OffsetCourse course_from(const Series& series, const Fitted& fit, double scatter) {
  OffsetCourse course;
  course.middle_s = series.middle_s;
  course.windows = series.size();
  course.scatter = scatter;
  course.offset_s = fit.parameters[0];
  course.sigma_s = std::sqrt(fit.covariance(0, 0));
  Eigen::Index column = 1;
  if (fit.model.line) {
    course.rate = fit.parameters[column] / series.span_s;
    course.rate_sigma = std::sqrt(fit.covariance(column, column)) / series.span_s;
    ++column;
  }
  for (const std::size_t jump : fit.model.jumps) {
    course.jumps.push_back({series.time_s[jump - 1], series.time_s[jump], fit.parameters[column],
                            std::sqrt(fit.covariance(column, column))});
    ++column;
  }
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
  Series series = series_of(windows, middle_s);
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
