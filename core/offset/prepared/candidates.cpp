#include "core/offset/prepared/candidates.hpp"
#include "core/parallel.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>

namespace sweepscope {
namespace {

std::int64_t nanoseconds(double seconds) {
  return std::llround(seconds * 1e9);
}

}  // namespace

std::vector<double> offsets_of(const std::vector<OffsetRange>& ranges) {
  std::vector<std::int64_t> offsets_ns;
  for (const OffsetRange& range : ranges) {
    const std::int64_t step_ns = std::max<std::int64_t>(1, nanoseconds(range.step_s));
    for (std::int64_t offset_ns = nanoseconds(range.from_s); offset_ns <= nanoseconds(range.to_s);
         offset_ns += step_ns)
      offsets_ns.push_back(offset_ns);
  }
  std::sort(offsets_ns.begin(), offsets_ns.end());
  offsets_ns.erase(std::unique(offsets_ns.begin(), offsets_ns.end()), offsets_ns.end());
  std::vector<double> offsets_s;
  for (const std::int64_t offset_ns : offsets_ns) offsets_s.push_back(double(offset_ns) * 1e-9);
  return offsets_s;
}

OffsetRange range_around(const OffsetsAround& around) {
  const int above = (around.steps + 1) / 2, below = around.steps / 2;
  return {around.initial_s - below * around.accuracy_s, around.initial_s + above * around.accuracy_s,
          around.accuracy_s};
}

bool Curve::compute(const std::vector<double>& offsets_s, const Job& job) {
  std::vector<double> wanted_s;
  for (const double offset_s : offsets_s) {
    const auto same = [&](const CurvePoint& p) { return p.offset_s == offset_s; };
    if (std::none_of(points_.begin(), points_.end(), same)) wanted_s.push_back(offset_s);
  }
  std::vector<std::optional<CurvePoint>> computed(wanted_s.size());
  std::atomic<std::size_t> done{0};
  const Job part = Job::part_of(job);
  const auto compute_one = [&](std::size_t i) {
    if (job.cancelled()) return;
    CurvePoint point = candidate_(wanted_s[i], part);
    if (job.cancelled()) return;
    computed[i] = point;
    job.report("candidates", double(++done) / double(wanted_s.size()));
  };
  for_each_task(wanted_s.size(), compute_one);
  for (const auto& point : computed)
    if (point) points_.push_back(*point);
  std::sort(points_.begin(), points_.end(),
            [](const CurvePoint& a, const CurvePoint& b) { return a.offset_s < b.offset_s; });
  return !job.cancelled();
}

std::vector<CurvePoint> united(std::vector<CurvePoint> curve, const std::vector<CurvePoint>& more) {
  for (const CurvePoint& point : more)
    if (std::none_of(curve.begin(), curve.end(), [&](const auto& p) { return p.offset_s == point.offset_s; }))
      curve.push_back(point);
  std::sort(curve.begin(), curve.end(), [](const auto& a, const auto& b) { return a.offset_s < b.offset_s; });
  return curve;
}

std::size_t index_of_min(const std::vector<CurvePoint>& curve, CurveValue value) {
  std::size_t best = curve.size();
  for (std::size_t i = 0; i < curve.size(); ++i)
    if (curve[i].*value && (best == curve.size() || *(curve[i].*value) < *(curve[best].*value))) best = i;
  return best;
}

std::size_t index_of_max(const std::vector<CurvePoint>& curve, CurveValue value) {
  std::size_t best = curve.size();
  for (std::size_t i = 0; i < curve.size(); ++i)
    if (curve[i].*value && (best == curve.size() || *(curve[i].*value) > *(curve[best].*value))) best = i;
  return best;
}

double ExtremumFit::at(double offset_s) const {
  const double x = (offset_s - centre_s) / reach_s;
  const double fitted = c0 + (c1 + c2 * x) * x;
  return scale * (of_squares ? std::sqrt(std::max(0.0, fitted)) : fitted);
}

namespace {

constexpr std::size_t kMinFitted = 5;  // a parabola has three unknowns: two more points say that it is one
constexpr double kWideReach = 2;       // of candidates a unit apart, 5 lie within 2 units

struct Span {
  std::size_t first, last;

  std::size_t size() const { return last - first + 1; }
};

// The contiguous present points round `best`.
Span present_within(const std::vector<CurvePoint>& curve, CurveValue value, std::size_t best,
                    double reach_s) {
  const double centre_s = curve[best].offset_s;
  Span span{best, best};
  const auto belongs = [&](std::size_t i) {
    return (curve[i].*value).has_value() && std::abs(curve[i].offset_s - centre_s) <= reach_s + 1e-9;
  };
  while (span.first > 0 && belongs(span.first - 1)) --span.first;
  while (span.last + 1 < curve.size() && belongs(span.last + 1)) ++span.last;
  return span;
}

// As far to one side as to the other where enough is left: a valley is no parabola, and what one side has
// more of pulls.
Span fitted_span(const std::vector<CurvePoint>& curve, CurveValue value, std::size_t best, double reach_s) {
  const Span all = present_within(curve, value, best, reach_s);
  const double even_s = std::min(curve[best].offset_s - curve[all.first].offset_s,
                                 curve[all.last].offset_s - curve[best].offset_s);
  const Span even = present_within(curve, value, best, even_s);
  return even.size() >= kMinFitted ? even : all;
}

}  // namespace

std::optional<ExtremumFit> fit_of_extremum(const std::vector<CurvePoint>& curve, CurveValue value,
                                           std::size_t best, double reach_s) {
  const double centre_s = curve[best].offset_s;
  const auto [first, last] = fitted_span(curve, value, best, reach_s);
  const auto count = static_cast<Eigen::Index>(last - first + 1);
  if (count < Eigen::Index(kMinFitted)) return std::nullopt;
  Eigen::MatrixXd powers(count, 3);
  Eigen::VectorXd values(count);
  const double best_value = *(curve[best].*value), scale = best_value == 0 ? 1.0 : best_value;
  const bool of_squares = value != &CurvePoint::n;
  for (Eigen::Index i = 0; i < count; ++i) {
    const CurvePoint& point = curve[first + std::size_t(i)];
    const double x = (point.offset_s - centre_s) / reach_s;
    const double scaled = *(point.*value) / scale;
    // All distances have the same error, so the error of a square is proportional to the distance.
    const double weight = of_squares ? 1 / std::max(1.0, scaled) : 1;
    powers.row(i) << weight, weight * x, weight * x * x;
    values[i] = weight * (of_squares ? scaled * scaled : scaled);
  }
  const Eigen::Vector3d c = powers.colPivHouseholderQr().solve(values);
  if (!(of_squares ? c[2] > 0 : c[2] < 0)) return std::nullopt;
  const ExtremumFit fit{
      of_squares, centre_s, reach_s, scale, c[0], c[1], c[2], curve[first].offset_s, curve[last].offset_s};
  const double offset_s = fit.extremum_s();
  if (offset_s < fit.from_s || offset_s > fit.to_s) return std::nullopt;
  return fit;
}

std::optional<ExtremumFit> fit_behind(const std::vector<CurvePoint>& curve, CurveValue value,
                                      const CriterionOptimum& optimum) {
  constexpr double kUsualUnit_s = 1e-3;                        // that of most motors, see search_scale
  constexpr double kSame_s = 1e-10, kSameGridPoint_s = 2e-12;  // rounding: a curve may come from a file
  const std::size_t best = value == &CurvePoint::n ? index_of_max(curve, value) : index_of_min(curve, value);
  if (best == curve.size() || std::abs(curve[best].offset_s - optimum.offset_s) <= kSameGridPoint_s)
    return std::nullopt;
  std::vector<double> reaches_s{kUsualUnit_s, kWideReach * kUsualUnit_s};
  for (const CurvePoint& point : curve) reaches_s.push_back(std::abs(point.offset_s - curve[best].offset_s));
  for (const double reach_s : reaches_s) {
    if (!(reach_s > 0)) continue;
    const auto fit = fit_of_extremum(curve, value, best, reach_s);
    if (fit && std::abs(fit->extremum_s() - optimum.offset_s) <= kSame_s) return fit;
  }
  return std::nullopt;
}

CriterionOptimum fitted_extremum(const std::vector<CurvePoint>& curve, CurveValue value, std::size_t best,
                                 double reach_s) {
  CriterionOptimum optimum{"", curve[best].offset_s, *(curve[best].*value)};
  auto fit = fit_of_extremum(curve, value, best, reach_s);
  if (!fit) fit = fit_of_extremum(curve, value, best, kWideReach * reach_s);
  if (!fit) return optimum;
  optimum.offset_s = fit->extremum_s();
  // The curve's own value there: the fit is to find the place.
  double nearest_s = std::numeric_limits<double>::max();
  for (const CurvePoint& point : curve) {
    const double away_s = std::abs(point.offset_s - optimum.offset_s);
    const bool inside = point.offset_s >= fit->from_s && point.offset_s <= fit->to_s;
    if (!inside || !(away_s < nearest_s)) continue;
    nearest_s = away_s;
    optimum.value = *(point.*value);
  }
  return optimum;
}

}  // namespace sweepscope
