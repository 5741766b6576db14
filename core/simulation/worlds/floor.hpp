#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/simulation/meshes/ray_caster.hpp"
#include "core/simulation/worlds/draw.hpp"
#include "core/simulation/worlds/world.hpp"

namespace sweepscope::simulation {

/// The places of a world in which a person can stand, on a grid in plan, on every level that can be reached
/// from the world's start: the floor goes on without a jump, and nothing is within kElbow_m of the body.
class Floor {
 public:
  static constexpr double kCell_m = 0.3, kElbow_m = 0.5;

  explicit Floor(const World& world);

  std::size_t size() const { return places_.size(); }

  /// What a way is to be.
  struct Ask {
    double length_m = 0;   // at least; a loop is as long as it comes out, at most this
    bool returns = false;  // ends where it begins
  };
  /// A way through random places, in steps of about a cell, rounded at its corners. It prefers places that
  /// are far from surfaces, and ways up and down over level ones. None where the world has no room for one.
  std::optional<std::vector<Vector3d>> way(const Ask& ask, Draw& draw) const;

 private:
  struct Place {
    Vector3d floor_m;
    std::array<std::int32_t, 8> next;  // the neighbours that can be walked to; -1: none
    double toll = 1;                   // what a metre costs here: more near surfaces
  };
  struct Tree {  // of the shortest ways from one place to all others
    std::vector<double> cost, length_m;
    std::vector<std::int32_t> before;
  };
  using Cell = std::pair<int, int>;

  std::optional<Vector3d> standing(const RayCaster& caster, const Vector2d& at_m, double floor_m) const;
  std::int32_t place_at(const Cell& cell, double floor_m) const;
  Cell cell_of(const Vector3d& p_m) const;
  void flood(const RayCaster& caster, const World& world);
  void take_tolls();
  /// `worn` places cost more: those that were just walked.
  Tree tree_from(std::size_t from, const std::vector<std::int32_t>& worn) const;
  std::vector<std::int32_t> way_to(const Tree& tree, std::size_t to) const;
  std::vector<Vector3d> rounded(const std::vector<std::int32_t>& places) const;

  Vector2d origin_m_;
  std::vector<Place> places_;
  std::map<Cell, std::vector<std::int32_t>> in_cell_;
};

}  // namespace sweepscope::simulation
