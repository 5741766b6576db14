#include <algorithm>

#include "core/simulation/worlds/clutter.hpp"
#include "core/simulation/worlds/world.hpp"

namespace sweepscope::simulation {
namespace {

/// A main corridor along +x, branches to both sides, some of them joined at their ends, and a lobby.
std::vector<Box2> corridors(Draw& draw) {
  const double long_m = draw.in(24, 50), wide_m = draw.in(1.9, 3);
  std::vector<Box2> all{{Vector2d(0, 0), Vector2d(long_m, wide_m)}};
  for (const double side : {-1.0, 1.0}) {
    const double deep_m = draw.in(7, 16), joint_m = draw.in(1.8, 2.6);
    std::vector<double> branches;
    for (double x = draw.in(2, 8); x + 3 < long_m; x += draw.in(8, 16)) {
      const double width_m = draw.in(1.8, 2.6);
      const double y = side > 0 ? wide_m : -deep_m;
      all.push_back({Vector2d(x, y), Vector2d(x + width_m, y + deep_m)});
      branches.push_back(x);
    }
    if (branches.size() > 1 && draw.chance(0.7)) {
      const double y = side > 0 ? wide_m + deep_m : -deep_m - joint_m;
      all.push_back({Vector2d(branches.front(), y), Vector2d(branches.back() + 1.8, y + joint_m)});
    }
  }
  const double lobby_m = draw.in(4, 8), off_m = draw.in(0, lobby_m - wide_m);
  all.push_back({Vector2d(long_m, -off_m), Vector2d(long_m + lobby_m, lobby_m - off_m)});
  return all;
}

/// The borders of the boxes along one axis, each once.
std::vector<double> borders(const std::vector<Box2>& boxes, int axis) {
  std::vector<double> all;
  for (const Box2& box : boxes) all.insert(all.end(), {box.min()[axis], box.max()[axis]});
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void add_ceiling(Mesh& mesh, Draw& draw, const Box2& room, double height_m) {
  const bool along_x = room.sizes().x() > room.sizes().y();
  const Vector2d middle = room.center();
  const double length_m = room.sizes().maxCoeff(), every_m = draw.in(1.8, 4), deep_m = draw.in(0.05, 0.12);
  const bool beams = draw.chance(0.4);
  for (double s = every_m / 2 - length_m / 2; s < length_m / 2; s += every_m) {
    const Placement at{middle.x() + (along_x ? s : 0), middle.y() + (along_x ? 0 : s), height_m,
                       along_x ? 0.0 : 90.0};
    mesh.add(box({-0.6, -0.1, -deep_m}, {0.6, 0.1, 0}, 0.95), at);
    const double half_m = room.sizes().minCoeff() / 2;
    if (beams) mesh.add(box({0.8, -half_m, -0.25}, {1.0, half_m, 0}, 0.7), at);
  }
}

}  // namespace

World corridor(Draw& draw) {
  World world;
  const std::vector<Box2> rooms = corridors(draw);
  const double height_m = draw.in(2.4, 3.2);
  const std::vector<double> xs = borders(rooms, 0), ys = borders(rooms, 1);
  const auto inside = [&](const Vector2d& p) {
    return std::ranges::any_of(rooms, [&](const Box2& room) { return room.contains(p); });
  };
  for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
    for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
      const Box2 cell(Vector2d(xs[i], ys[j]), Vector2d(xs[i + 1], ys[j + 1]));
      if (!inside(cell.center())) continue;
      const Vector2d low = cell.min(), high = cell.max();
      world.mesh.add_box({low.x(), low.y(), -0.3}, {high.x(), high.y(), 0}, 0.4);
      world.mesh.add_box({low.x(), low.y(), height_m}, {high.x(), high.y(), height_m + 0.3}, 0.8);
      for (const auto& [placement, length_m] : sides_of(cell)) {
        const SinCos turn = sin_cos(radians(placement.yaw_deg));
        const Vector2d begin(placement.x_m, placement.y_m), along(turn.cos, turn.sin);
        const Vector2d beyond = begin + length_m / 2 * along + 1e-3 * Vector2d(-turn.sin, turn.cos);
        if (!inside(beyond)) world.mesh.add(furnished_wall(draw, length_m, height_m, 0.25), placement);
      }
    }
  }
  for (const Box2& room : rooms) add_ceiling(world.mesh, draw, room, height_m);
  world.walked_m = {Vector2d(xs.front(), ys.front()), Vector2d(xs.back(), ys.back())};
  world.start_m << rooms.back().center(), 0;
  return world;
}

}  // namespace sweepscope::simulation
