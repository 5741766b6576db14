#include "ui/explorer/solved_maps.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "ui/jobs/task_plans.hpp"

namespace sweepscope::ui {
namespace {

constexpr std::size_t kMaxKept = 12;
constexpr const char* kSolve = "solve ";

std::int64_t to_ns(double offset_s) {
  return static_cast<std::int64_t>(std::llround(offset_s * 1e9));
}

std::string solve_key(std::int64_t offset_ns) {
  return kSolve + std::to_string(offset_ns);
}

}  // namespace

void SolvedMaps::open(LoadedPtr loaded, SolvedMapPtr first, std::optional<RigKind> assume) {
  close();
  loaded_ = std::move(loaded);
  first_ = std::move(first);
  assume_ = assume;
}

void SolvedMaps::close() {
  background_.cancel_all(kSolve);
  loaded_ = nullptr;
  first_ = nullptr;
  first_solved_ = newly_solved_ = false;
  solved_.clear();
  order_.clear();
  retry();
}

SolvedMapPtr SolvedMaps::nearest(double offset_s) const {
  if (const auto found = solved_.find(to_ns(offset_s)); found != solved_.end()) return found->second;
  SolvedMapPtr nearest;
  for (const auto& [ns, map] : solved_) {
    if (!nearest || std::abs(map->offset_s - offset_s) < std::abs(nearest->offset_s - offset_s))
      nearest = map;
  }
  return nearest ? nearest : first_;
}

bool SolvedMaps::is_exact(const SolvedMap& map, double offset_s) const {
  if (!loaded_->poses.empty() || was_stationary(*loaded_, assume_)) return true;
  return !map.provisional && to_ns(map.offset_s) == to_ns(offset_s);
}

std::string SolvedMaps::problem_at(double offset_s) const {
  const auto why = unsolvable_.find(to_ns(offset_s));
  return why != unsolvable_.end() ? why->second : "";
}

bool SolvedMaps::is_cancelled(double offset_s) const {
  return cancelled_.contains(to_ns(offset_s));
}

bool SolvedMaps::is_to_come(double offset_s) const {
  return is_to_come_ns(to_ns(offset_s));
}

bool SolvedMaps::is_to_come_ns(std::int64_t offset_ns) const {
  return !solved_.contains(offset_ns) && !unsolvable_.contains(offset_ns) && !cancelled_.contains(offset_ns);
}

void SolvedMaps::solve(std::span<const double> offsets_s, bool held) {
  std::vector<std::int64_t> wanted;
  for (const double offset_s : offsets_s) {
    const std::int64_t ns = to_ns(offset_s);
    if (is_to_come_ns(ns) && std::find(wanted.begin(), wanted.end(), ns) == wanted.end())
      wanted.push_back(ns);
  }
  for (const std::string& key : background_.keys(kSolve)) {
    const bool still =
        std::any_of(wanted.begin(), wanted.end(), [&](auto ns) { return solve_key(ns) == key; });
    if (!still) background_.cancel(key);
  }
  if (held) return;
  for (const std::int64_t ns : wanted)
    if (!background_.has(solve_key(ns))) start(ns);
}

void SolvedMaps::start(std::int64_t offset_ns) {
  background_.start(
      "solve", solve_key(offset_ns), "Solving the map",
      [this, offset_ns, loaded = loaded_, assume = assume_](const Job& job) {
        const double offset_s = static_cast<double>(offset_ns) * 1e-9;
        auto solved = std::make_shared<Result<SolvedMapPtr>>(solve_map(*loaded, offset_s, assume, job));
        return [this, offset_ns, solved] { keep(offset_ns, *solved); };
      },
      steps_of_solving());
}

void SolvedMaps::keep(std::int64_t offset_ns, const Result<SolvedMapPtr>& solved) {
  if (!solved) {
    unsolvable_[offset_ns] = solved.error().message;
    return;
  }
  first_solved_ = first_solved_ || solved_.empty();
  newly_solved_ = true;
  solved_[offset_ns] = *solved;
  order_.push_back(offset_ns);
  if (order_.size() <= kMaxKept) return;
  solved_.erase(order_.front());
  order_.erase(order_.begin());
}

void SolvedMaps::cancel(std::span<const double> offsets_s) {
  for (const double offset_s : offsets_s)
    if (!solved_.contains(to_ns(offset_s))) cancelled_.insert(to_ns(offset_s));
}

void SolvedMaps::retry() {
  cancelled_.clear();
  unsolvable_.clear();
}

}  // namespace sweepscope::ui
