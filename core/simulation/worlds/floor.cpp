#include "core/simulation/worlds/floor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace sweepscope::simulation {
namespace {

constexpr double kStep_m = 0.36;  // the highest step between neighbours, a stair's or a kerb's
constexpr std::array<std::pair<int, int>, 8> kAround{
    {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};

double flat_m(const Vector3d& a, const Vector3d& b) {
  return (a - b).head<2>().norm();
}

}  // namespace

Floor::Floor(const World& world) : origin_m_(world.start_m.head<2>()) {
  const RayCaster caster(world.mesh);
  flood(caster, world);
  take_tolls();
}

Floor::Cell Floor::cell_of(const Vector3d& p_m) const {
  return {static_cast<int>(std::floor((p_m.x() - origin_m_.x()) / kCell_m + 0.5)),
          static_cast<int>(std::floor((p_m.y() - origin_m_.y()) / kCell_m + 0.5))};
}

std::optional<Vector3d> Floor::standing(const RayCaster& caster, const Vector2d& at_m, double floor_m) const {
  constexpr double kKnee_m = 0.8;
  const Vector3d above(at_m.x(), at_m.y(), floor_m + kKnee_m);
  const auto hit = caster.cast(above, -Vector3d::UnitZ(), kKnee_m + kStep_m);
  if (!hit || kKnee_m - hit->range_m > kStep_m) return std::nullopt;
  const Vector3d foot = above - hit->range_m * Vector3d::UnitZ();
  for (const double z_m : {kKnee_m, 1.25, 1.7})
    if (caster.distance_m(foot + z_m * Vector3d::UnitZ(), kElbow_m)) return std::nullopt;
  return foot;
}

std::int32_t Floor::place_at(const Cell& cell, double floor_m) const {
  constexpr double kStorey_m = 1;  // places of one cell are further apart
  const auto found = in_cell_.find(cell);
  if (found == in_cell_.end()) return -1;
  for (const std::int32_t place : found->second)
    if (std::abs(places_[static_cast<std::size_t>(place)].floor_m.z() - floor_m) < kStorey_m) return place;
  return -1;
}

void Floor::flood(const RayCaster& caster, const World& world) {
  const auto add = [&](const Cell& cell, const Vector3d& foot) {
    const auto number = static_cast<std::int32_t>(places_.size());
    places_.push_back({foot, {-1, -1, -1, -1, -1, -1, -1, -1}});
    in_cell_[cell].push_back(number);
    return number;
  };
  if (const auto foot = standing(caster, origin_m_, world.start_m.z())) add({0, 0}, *foot);
  for (std::size_t i = 0; i < places_.size(); ++i) {  // grows on the way
    const Cell here = cell_of(places_[i].floor_m);
    for (std::size_t k = 0; k < kAround.size(); ++k) {
      const Cell there{here.first + kAround[k].first, here.second + kAround[k].second};
      const Vector2d at_m = origin_m_ + kCell_m * Vector2d(there.first, there.second);
      if (!world.walked_m.contains(at_m)) continue;
      std::int32_t place = place_at(there, places_[i].floor_m.z());
      if (place < 0) {
        const auto foot = standing(caster, at_m, places_[i].floor_m.z());
        if (!foot) continue;
        place = add(there, *foot);
      }
      const double step_m = places_[static_cast<std::size_t>(place)].floor_m.z() - places_[i].floor_m.z();
      if (std::abs(step_m) <= kStep_m) places_[i].next[k] = place;
    }
  }
}

void Floor::take_tolls() {
  constexpr int kNear = 4;  // cells from the border in which a place costs more
  std::vector<int> to_border(places_.size(), kNear);
  for (int ring = 0; ring < kNear; ++ring) {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (to_border[i] < kNear) continue;
      const bool is_next = std::ranges::any_of(places_[i].next, [&](std::int32_t next) {
        return next < 0 ? ring == 0 : to_border[static_cast<std::size_t>(next)] == ring - 1;
      });
      if (is_next) to_border[i] = ring;
    }
  }
  for (std::size_t i = 0; i < places_.size(); ++i) places_[i].toll = 1 + 0.4 * (kNear - to_border[i]);
}

Floor::Tree Floor::tree_from(std::size_t from, const std::vector<std::int32_t>& worn) const {
  constexpr double kWorn = 4;
  std::vector<double> toll(places_.size());
  for (std::size_t i = 0; i < places_.size(); ++i) toll[i] = places_[i].toll;
  for (const std::int32_t place : worn) toll[static_cast<std::size_t>(place)] *= kWorn;
  Tree tree;
  tree.cost.assign(places_.size(), std::numeric_limits<double>::infinity());
  tree.length_m.assign(places_.size(), 0);
  tree.before.assign(places_.size(), -1);
  using Reached = std::pair<double, std::size_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  tree.cost[from] = 0;
  open.emplace(0, from);
  while (!open.empty()) {
    const auto [cost, here] = open.top();
    open.pop();
    if (cost > tree.cost[here]) continue;
    for (const std::int32_t next : places_[here].next) {
      if (next < 0) continue;
      const auto there = static_cast<std::size_t>(next);
      const double metres = flat_m(places_[here].floor_m, places_[there].floor_m);
      const double reached = cost + metres * toll[there];
      if (reached >= tree.cost[there]) continue;
      tree.cost[there] = reached;
      tree.length_m[there] = tree.length_m[here] + metres;
      tree.before[there] = static_cast<std::int32_t>(here);
      open.emplace(reached, there);
    }
  }
  return tree;
}

std::vector<std::int32_t> Floor::way_to(const Tree& tree, std::size_t to) const {
  std::vector<std::int32_t> way;
  for (auto place = static_cast<std::int32_t>(to); place >= 0;
       place = tree.before[static_cast<std::size_t>(place)])
    way.push_back(place);
  std::ranges::reverse(way);
  return way;
}

std::vector<Vector3d> Floor::rounded(const std::vector<std::int32_t>& places) const {
  constexpr int kRounds = 40;
  std::vector<Vector3d> way;
  for (const std::int32_t place : places) way.push_back(places_[static_cast<std::size_t>(place)].floor_m);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 1; i + 1 < way.size(); ++i) {
      const Vector3d moved = 0.25 * way[i - 1] + 0.5 * way[i] + 0.25 * way[i + 1];
      if (place_at(cell_of(moved), moved.z()) >= 0) way[i] = moved;
    }
  }
  return way;
}

std::optional<std::vector<Vector3d>> Floor::way(const Ask& ask, Draw& draw) const {
  constexpr double kMinLeg_m = 4, kMaxLeg_m = 30;
  constexpr int kChosenFrom = 6;
  constexpr std::size_t kWornPlaces = 12;
  if (places_.size() < 50) return std::nullopt;
  const auto any_of = [&](std::size_t count) {
    return static_cast<std::size_t>(draw.count(0, static_cast<int>(count) - 1));
  };
  std::size_t here = any_of(places_.size());
  const Tree home = tree_from(here, {});
  std::vector<std::int32_t> way{static_cast<std::int32_t>(here)};
  double walked_m = 0;
  while (walked_m < ask.length_m) {
    const std::size_t worn = std::min(way.size(), kWornPlaces);
    const Tree tree = tree_from(here, {way.end() - static_cast<std::ptrdiff_t>(worn), way.end()});
    std::vector<std::size_t> eligible;
    for (std::size_t there = 0; there < places_.size(); ++there) {
      const double leg_m = tree.length_m[there], home_m = ask.returns ? home.length_m[there] : 0;
      const bool is_in_reach = leg_m > kMinLeg_m && leg_m < kMaxLeg_m;
      if (is_in_reach && (!ask.returns || walked_m + leg_m + home_m < ask.length_m))
        eligible.push_back(there);
    }
    std::optional<std::size_t> target;
    for (int i = 0; i < kChosenFrom && !eligible.empty(); ++i) {
      const std::size_t there = eligible[any_of(eligible.size())];
      const auto climbs_m = [&](std::size_t place) {
        return std::abs(places_[place].floor_m.z() - places_[here].floor_m.z());
      };
      if (!target || climbs_m(there) > climbs_m(*target) + 1) target = there;
    }
    if (!target && !ask.returns) return std::nullopt;
    const bool last = !target;
    const std::size_t to = last ? static_cast<std::size_t>(way.front()) : *target;
    const std::vector<std::int32_t> leg = way_to(tree, to);
    way.insert(way.end(), leg.begin() + 1, leg.end());
    walked_m += tree.length_m[to];
    here = to;
    if (last) break;
  }
  if (way.size() < 12) return std::nullopt;
  return rounded(way);
}

}  // namespace sweepscope::simulation
