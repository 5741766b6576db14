#include "core/offset/search/coarse_search.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/numbers.hpp"
#include "core/offset/judgement/limits.hpp"
#include "core/offset/judgement/unseen_sigma.hpp"
#include "core/offset/prepared/candidates.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "core/offset/search/motor_images.hpp"
#include "core/offset/stationary/stationary_points.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

// 20 s of sweeps of 0.5 s, so that the cost ends growing with the length. More would not move the valley by
// a unit.
constexpr std::size_t kMaxSweeps = 40;

// As MappingOptions::cost_cap_m. Beside edges ranges differ by metres at any offset.
constexpr double kCoarseCap_m = 0.3;

struct CoarseSum {
  double sum_m = 0;
  std::size_t count = 0, asked = 0;
};

// Differences between a line's ranges and another sweep's at the same motor angle and beam. On a plane
// 1 / r is A cos(angle) + B sin(angle), which two lines determine.
void add_differences(const StationaryGrid& grid, const StationaryPoints& points, std::size_t line,
                     const LinePool& pool, const StationaryPatchOptions& patches, CoarseSum& total) {
  StationaryNeighbours neighbours(points, pool, line, patches);
  for (std::size_t bin = line % 2; bin < points.bins; bin += 2) {
    const std::size_t cell = line * points.bins + bin;
    if (!points.placed[cell]) continue;
    ++total.asked;
    const double angle_rad = points.angle_rad[cell];
    const auto [found, below, above] = neighbours.bracket(angle_rad, bin);
    if (!found) continue;
    // In single precision, as the ranges are: sines cost less in it.
    const float up = float(angle_rad - points.angle_rad[below]),
                down = float(points.angle_rad[above] - angle_rad);
    const float inverse_range = (std::sin(down) / grid.range_m[below] + std::sin(up) / grid.range_m[above]) /
                                std::max(1e-9F, std::sin(up + down));
    total.sum_m += std::min(double(std::abs(grid.range_m[cell] - 1 / inverse_range)), kCoarseCap_m);
    ++total.count;
  }
}

// Which sweeps a line is compared with: its neighbours, since a rig moves little meanwhile, or all.
enum class Partners { kNeighbours, kAll };

std::optional<double> coarse_cost_m(const StationaryGrid& grid, const StationaryPatchOptions& patches,
                                    double offset_s, Partners partners) {
  const StationaryPoints points = place_stationary(grid, offset_s, StationaryDetail::kAngles);
  const std::vector<LinePool> pools = pools_by_sweep(points);
  CoarseSum total;
  const bool all = partners == Partners::kAll || grid.problem->motor.one_way();
  for (std::size_t line = 0; line < points.lines(); ++line) {
    const std::size_t sweep = points.sweep[line];
    if (sweep == kNoSweep) continue;
    if (all) {
      add_differences(grid, points, line, points.against(points.direction[line]), patches, total);
      continue;
    }
    if (sweep > 0) add_differences(grid, points, line, pools[sweep - 1], patches, total);
    if (sweep + 1 < pools.size()) add_differences(grid, points, line, pools[sweep + 1], patches, total);
  }
  if (total.count < 100 || 5 * total.count < total.asked) return std::nullopt;
  return total.sum_m / double(total.count);
}

// Mean difference of range between the directions at each candidate offset, each at most a cap: needs no
// registration, so it is valid far from the minimum too. Absent if the directions hardly overlap.
std::vector<CurvePoint> coarse_curve(const StationaryGrid& grid, const std::vector<double>& offsets_s,
                                     Partners partners, const Job& job, const SearchWatch& watch) {
  const StationaryPatchOptions patches = stationary_patch_options(*grid.problem);
  std::vector<CurvePoint> curve(offsets_s.size());
  std::atomic<std::size_t> done{0};
  for_each_index(offsets_s.size(), [&](std::size_t i) {
    curve[i].offset_s = offsets_s[i];
    if (!job.cancelled()) curve[i].capped_cost_m = coarse_cost_m(grid, patches, offsets_s[i], partners);
    if (watch.finished && curve[i].capped_cost_m) watch.finished(curve[i]);
    job.report("searching", double(++done) / double(offsets_s.size()));
  });
  return curve;
}

std::vector<double> every_second(const std::vector<double>& offsets_s) {
  std::vector<double> chosen_s;
  for (std::size_t i = 0; i < offsets_s.size(); i += 2) chosen_s.push_back(offsets_s[i]);
  if (chosen_s.back() != offsets_s.back()) chosen_s.push_back(offsets_s.back());
  return chosen_s;
}

OffsetProblem first_sweeps_of(const OffsetProblem& problem, double middle_s, std::size_t max_sweeps) {
  return problem.motor.one_way() ? beginnings_of_sides(problem, middle_s, max_sweeps / 2)
                                 : beginning_of(problem, middle_s, max_sweeps);
}

void set_best(CoarseSearch& search) {
  const std::size_t best = index_of_min(search.curve, &CurvePoint::capped_cost_m);
  if (best < search.curve.size()) search.best = best;
}

double cost_m(const CoarseSearch& search) {
  return *search.curve[*search.best].capped_cost_m;
}

bool is_inside(const CoarseSearch& search) {
  return search.best && *search.best > 0 && *search.best + 1 < search.curve.size();
}

// How far the least cost lies below the usual one, of which it is a part: 0.68 to 0.86 of simulated rooms and
// walks (tests/benchmark/thresholds).
double depth_of(const CoarseSearch& search) {
  std::vector<double> costs_m;
  for (const CurvePoint& point : search.curve)
    if (point.capped_cost_m) costs_m.push_back(*point.capped_cost_m);
  return 1 - cost_m(search) / median(std::move(costs_m));
}

// Two sparse sweeps have few lines near each other, and of those beside edges most differ at any offset.
// Where neighbours show no valley, all sweeps may.
template <typename Search>
CoarseSearch by_neighbours_or_all(const OffsetProblem& problem, const Search& search_against) {
  CoarseSearch search = search_against(Partners::kNeighbours);
  const auto is_flat = [](const CoarseSearch& of) {
    return !of.best || !(depth_of(of) > kLimits.min_cost_depth);
  };
  if (!is_flat(search) || !has_sparse_sweeps(*problem.recording, problem.motor)) return search;
  CoarseSearch all = search_against(Partners::kAll);
  return is_flat(all) ? search : all;
}

}  // namespace

bool has_clear_valley(const CoarseSearch& search) {
  constexpr double kClearDepth = 0.5;
  return is_inside(search) && depth_of(search) > kClearDepth;
}

CoarseSearch search_coarsely(const OffsetProblem& problem, double from_s, double to_s,
                             const SearchScale& scale, const Job& job, const SearchWatch& watch) {
  const OffsetProblem part = first_sweeps_of(problem, (from_s + to_s) / 2, kMaxSweeps);
  const StationaryGrid grid = stationary_grid(part);
  const std::vector<double> all_s = offsets_of({{from_s, to_s, scale.unit_s}});
  return by_neighbours_or_all(part, [&](Partners partners) {
    if (watch.began) watch.began();
    CoarseSearch search;
    const auto compute = [&](const std::vector<double>& offsets_s) {
      search.curve = united(std::move(search.curve), coarse_curve(grid, offsets_s, partners, job, watch));
      set_best(search);
    };
    compute(every_second(all_s));
    if (!search.best) return search;
    const double best_s = search.offset_s();
    std::vector<double> beside_s;
    for (const double offset_s : all_s)
      if (std::abs(offset_s - best_s) < 1.5 * scale.unit_s &&
          std::ranges::find(search.curve, offset_s, &CurvePoint::offset_s) == search.curve.end())
        beside_s.push_back(offset_s);
    compute(beside_s);
    return search;
  });
}

CoarseSearch search_roughly(const OffsetProblem& problem, double from_s, double to_s,
                            const SearchScale& scale, const Job& job) {
  constexpr std::size_t kSweeps = 12;
  constexpr double kStep_units = 4;  // 1.4 deg of the motor: valleys are wider
  const OffsetProblem part = first_sweeps_of(problem, (from_s + to_s) / 2, kSweeps);
  const StationaryGrid grid = stationary_grid(part);
  return by_neighbours_or_all(part, [&](Partners partners) {
    CoarseSearch search;
    search.curve =
        coarse_curve(grid, offsets_of({{from_s, to_s, kStep_units * scale.unit_s}}), partners, job, {});
    set_best(search);
    return search;
  });
}

SearchedWindow search_by_default(const PreparedRecording& prepared, const SearchScale& scale, const Job& job,
                                 const SearchWatch& watch) {
  constexpr double kClearlyLower = 0.7;  // than the best of the default window
  const MotorMotion& motor = prepared.motor;
  const auto about = [&](double middle_s) {
    const double from_s = std::max(middle_s - scale.half_width_s, -scale.max_half_width_s),
                 to_s = std::min(middle_s + scale.half_width_s, scale.max_half_width_s);
    return SearchedWindow{
        from_s, to_s, search_coarsely(problem_for(prepared, from_s, to_s), from_s, to_s, scale, job, watch)};
  };
  const auto about_unit = [&](double middle_s) {
    return about(scale.unit_s * std::round(middle_s / scale.unit_s));
  };
  const auto everywhere = [&](SearchedWindow near) {
    if (has_clear_valley(near.coarse) || scale.half_width_s >= scale.max_half_width_s || job.cancelled())
      return near;
    // As wide as two sweeps it holds the offset or an image of it.
    const double reach_s =
        motor.one_way() ? scale.max_half_width_s : std::min(scale.max_half_width_s, motor.median_sweep_s);
    const CoarseSearch all =
        search_roughly(problem_for(prepared, -reach_s, reach_s), -reach_s, reach_s, scale, job);
    if (!is_inside(all)) return near;
    const bool lower = !near.coarse.best || cost_m(all) < kClearlyLower * cost_m(near.coarse);
    if (is_inside(near.coarse) && (!lower || std::abs(all.offset_s()) <= scale.half_width_s)) return near;
    return about_unit(all.offset_s());
  };
  const auto with_margin = [&](SearchedWindow found) {
    constexpr double kMargin_units = 2;  // the least squares ends beside the best candidate
    if (!is_inside(found.coarse) || job.cancelled()) return found;
    const double best_s = found.coarse.offset_s(), margin_s = kMargin_units * scale.unit_s;
    const bool near_from = best_s - found.from_s < margin_s && found.from_s > -scale.max_half_width_s,
               near_to = found.to_s - best_s < margin_s && found.to_s < scale.max_half_width_s;
    return near_from || near_to ? about_unit(best_s) : found;
  };
  SearchedWindow found = with_margin(everywhere(about(0)));
  if (!found.coarse.best || motor.one_way() || 2 * scale.max_half_width_s <= motor.median_sweep_s)
    return found;
  const double best_s = best_of_images_s(prepared, found.coarse.offset_s(), scale.max_half_width_s);
  return best_s == found.coarse.offset_s() ? found : about_unit(best_s);
}

}  // namespace sweepscope
