#include "core/offset/walk/ways.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "core/loam/path/agreement.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

// Of each sweep whether another way found the same motion.
std::vector<char> confirmed_by(std::span<const SolvedWalk> ways, const SolvedWalk& walk) {
  std::vector<char> confirmed(walk.sweeps.size(), 0);
  for (const SolvedWalk& other : ways) {
    if (&other == &walk) continue;
    const std::vector<char> agreed = agreeing(walk.sweeps, other.sweeps);
    for (std::size_t i = 0; i < agreed.size(); ++i) confirmed[i] |= agreed[i];
  }
  return confirmed;
}

// Sweeps [first, end) in a row.
struct Run {
  std::size_t first = 0, end = 0;
  std::size_t size() const { return end - first; }
};

std::vector<Run> runs_of(const std::vector<char>& marks, char mark) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i] != mark) continue;
    if (runs.empty() || runs.back().end != i) runs.push_back({i, i});
    runs.back().end = i + 1;
  }
  return runs;
}

// A way beside the walk itself.
struct OtherWay {
  double velocity_sigma;    // of its prior, rad/s and m/s
  std::size_t first_start;  // of those that were tried at first
};

constexpr std::size_t kEnds = 2;  // the first and the last sweep hold few scans

// Whether a run is no more than the first or the last of so many sweeps.
bool is_end(const Run& run, std::size_t sweeps) {
  return run.size() == 1 && (run.first == 0 || run.end == sweeps);
}

std::vector<OtherWay> other_ways(const SolvedWalk& walk, const MappingOptions& mapping) {
  std::vector<OtherWay> others = {{5, 0}, {12, 0}};
  for (std::size_t first = 2; first + 2 <= walk.starts.size(); first += 2)
    others.push_back({mapping.velocity_sigma, first});
  return others;
}

}  // namespace

std::optional<WalkWays> ways_to_track(const OffsetProblem& problem, const SolvedWalk& walk,
                                      const MappingOptions& mapping, const Job& job) {
  const std::vector<OtherWay> others = other_ways(walk, mapping);
  std::vector<std::optional<SolvedWalk>> tracked(others.size());
  const Job quiet = Job::part_of(job);
  for_each_index(others.size(), [&](std::size_t i) {
    MappingOptions options = mapping;
    options.velocity_sigma = others[i].velocity_sigma;
    SolvedWalk from = walk;
    from.starts.erase(from.starts.begin(), from.starts.begin() + std::ptrdiff_t(others[i].first_start));
    tracked[i] = track_again(problem, std::move(from), options, i == 0 ? job : quiet);
  });
  WalkWays ways{{walk}, 1 + others.size()};
  for (std::optional<SolvedWalk>& way : tracked) {
    if (!way) return std::nullopt;
    ways.walks.push_back(std::move(*way));
  }
  constexpr int kMaxFurther = 3;
  std::size_t known_before = 0;
  for (int i = 0; i < kMaxFurther; ++i) {
    KnownSweeps known = certain_sweeps(ways);
    if (known.poses.size() <= known_before || known.poses.size() + kEnds >= walk.sweeps.size()) break;
    known_before = known.poses.size();
    auto way = track_from(problem, walk, std::move(known), mapping, job);
    if (!way) return std::nullopt;
    ways.walks.push_back(std::move(*way));
  }
  return ways;
}

const SolvedWalk& best_fitting(const WalkWays& ways) {
  return *std::ranges::min_element(ways.walks, {}, &SolvedWalk::misfit_m);
}

KnownSweeps certain_sweeps(const WalkWays& ways) {
  const SolvedWalk& best = best_fitting(ways);
  const std::vector<Run> runs = runs_of(confirmed_by(ways.walks, best), 1);
  if (runs.empty()) return {};
  const Run run = *std::ranges::max_element(runs, {}, &Run::size);
  const auto begin = best.sweeps.begin();
  return {run.first, {begin + std::ptrdiff_t(run.first), begin + std::ptrdiff_t(run.end)}};
}

std::string contradiction_of(const SolvedWalk& walk, const WalkWays& ways, double limit_m,
                             const Recording& recording) {
  const auto others = std::span(ways.walks).first(ways.independent);
  std::string contradiction;
  for (const Run& run : runs_of(confirmed_by(others, walk), 0)) {
    if (is_end(run, walk.sweeps.size())) continue;
    const auto motion = [&](const SolvedWalk& way) {
      return way.sweeps[run.first].begin().inverse() * way.sweeps[run.end - 1].end();
    };
    Apart nearest{std::numeric_limits<double>::infinity()};
    for (const SolvedWalk& other : others)
      if (&other != &walk) nearest = std::min(nearest, ends_apart(motion(walk), motion(other)), nearer);
    if (nearest.together_m() <= limit_m) continue;
    limit_m = nearest.together_m();
    contradiction = in_words({walk.sweeps[run.first].begin_s, walk.sweeps[run.end - 1].end_s, nearest},
                             recording.scans.front().first_beam_s);
  }
  return contradiction;
}

}  // namespace sweepscope
