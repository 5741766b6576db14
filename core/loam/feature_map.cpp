#include "core/loam/feature_map.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope {
namespace {

int count_lines(const Neighbours& found) {
  int lines = 0;
  for (int i = 0; i < found.count; ++i) {
    bool seen = false;
    for (int k = 0; k < i; ++k) seen |= found.line[k] == found.line[i];
    lines += seen ? 0 : 1;
  }
  return lines;
}

int whole(float value) {
  const int truncated = static_cast<int>(value);
  return truncated - (value < float(truncated) ? 1 : 0);
}

// A query's own cell and its neighbours, by axis: 0 the own slab of cells, 1 the neighbour on the side where
// the query lies, 2 the one on the other side.
struct CellStep {
  std::uint8_t x, y, z;
};

// The nearest cells first: what they hold narrows the search in the others.
constexpr std::array<CellStep, 27> near_first() {
  std::array<CellStep, 27> steps{};
  std::size_t count = 0;
  for (int rank = 0; rank <= 12; ++rank)
    for (int i = 0; i < 27; ++i) {
      const std::array<int, 3> step{i % 3, i / 3 % 3, i / 9};
      int of_step = 0;
      for (const int s : step) of_step += s * s;
      if (of_step == rank)
        steps[count++] = {std::uint8_t(step[0]), std::uint8_t(step[1]), std::uint8_t(step[2])};
    }
  return steps;
}

// The slabs of cells along one axis: which they are, and how far they lie from the query, squared.
struct Slabs {
  Slabs(float value_m, float inverse_cell, float cell_m) {
    const float scaled = value_m * inverse_cell;
    own = whole(scaled);
    const float below_m = value_m - float(own) * cell_m, above_m = float(own + 1) * cell_m - value_m;
    const int side = above_m < below_m ? 1 : -1;
    step = {0, side, -side};
    const float near_m = std::min(below_m, above_m), far_m = std::max(below_m, above_m);
    gap_m2 = {0, near_m * near_m, far_m * far_m};
  }
  int own;
  std::array<int, 3> step;
  std::array<float, 3> gap_m2;
};

}  // namespace

// Keeps the nearest candidates in order, at most `per_line` of one scan line.
class FeatureMap::NearestList {
 public:
  NearestList(int most, int per_line, float limit_m2)
      : most_(most), per_line_(per_line), limit_m2_(limit_m2) {
    line_.fill(kNone);
  }

  float limit_m2() const { return limit_m2_; }

  // `place` is the candidate's block times kBlock, plus its place there.
  void offer(float squared_m2, std::uint32_t line, std::uint32_t place) {
    int of_line = 0;
    for (const std::uint32_t kept : line_) of_line += kept == line ? 1 : 0;
    if (of_line >= per_line_) {
      int farthest = count_ - 1;
      while (line_[farthest] != line) --farthest;
      if (squared_m2 >= squared_m2_[farthest]) return;
      remove(farthest);
    } else if (count_ == most_) {
      remove(most_ - 1);
    }
    int at = count_++;
    for (; at > 0 && squared_m2_[at - 1] > squared_m2; --at) move(at - 1, at);
    squared_m2_[at] = squared_m2;
    line_[at] = line;
    place_[at] = place;
    if (count_ == most_) limit_m2_ = squared_m2_[most_ - 1];
  }

  void write(const Level& level, Neighbours& found) const {
    found.count = count_;
    for (int i = 0; i < count_; ++i) {
      const Block& block = level.blocks[place_[i] / kBlock];
      const std::uint32_t at = place_[i] % kBlock;
      found.p_m[i] = {block.x[at], block.y[at], block.z[at]};
      found.squared_distance_m2[i] = squared_m2_[i];
      found.line[i] = line_[i];
    }
    found.lines = count_lines(found);
  }

 private:
  static constexpr int kRoom = 12;  // whole vectors
  static_assert(kRoom >= Neighbours::kMax);

  void move(int from, int to) {
    squared_m2_[to] = squared_m2_[from];
    line_[to] = line_[from];
    place_[to] = place_[from];
  }
  void remove(int i) {
    for (; i + 1 < count_; ++i) move(i + 1, i);
    line_[--count_] = kNone;
  }

  int count_ = 0, most_, per_line_;
  float limit_m2_;
  std::array<float, kRoom> squared_m2_;
  std::array<std::uint32_t, kRoom> line_, place_;
};

// The cells that a query reaches, the nearest first, and how many points they hold.
struct FeatureMap::CellsInReach {
  struct At {
    const Cell* cell;
    float gap_m2;  // squared distance from the query
  };
  std::array<At, 27> at;
  int count = 0;
  std::uint32_t points = 0;
};

// The cells about a query; their bricks are looked up when first asked for.
class FeatureMap::NearbyCells {
 public:
  NearbyCells(const Level& level, int x, int y, int z)
      : level_(level), x_((x - 1) >> kBrickBits), y_((y - 1) >> kBrickBits), z_((z - 1) >> kBrickBits) {
    bricks_.fill(kUnknown);
  }

  const Cell* find(int x, int y, int z) {
    const int bx = x >> kBrickBits, by = y >> kBrickBits, bz = z >> kBrickBits;
    std::uint32_t& brick = bricks_[(bx - x_) + 2 * (by - y_) + 4 * (bz - z_)];
    if (brick == kUnknown) brick = find_brick(level_, key_of(bx, by, bz));
    if (brick == kNone) return nullptr;
    const std::uint32_t cell = level_.bricks[brick].cells[place_in_brick(x, y, z)];
    return cell == kNone ? nullptr : &level_.cells[cell];
  }

 private:
  static constexpr std::uint32_t kUnknown = kNone - 1;
  const Level& level_;
  int x_, y_, z_;  // the first brick
  std::array<std::uint32_t, 8> bricks_;
};

FeatureMap::FeatureMap(double cell_m, bool thinned) : thinned_(thinned) {
  for (int l = 0; l < kLevels; ++l) {
    levels_[l].cell_m = static_cast<float>(cell_m * (1 << l));
    levels_[l].inverse_cell = 1.0f / levels_[l].cell_m;
    levels_[l].radius_m = levels_[l].cell_m * 5.0 / 6.0;
    levels_[l].slots.resize(256);
  }
}

void FeatureMap::clear() {
  for (Level& level : levels_) {
    std::fill(level.slots.begin(), level.slots.end(), Slot{});
    level.bricks.clear();
    level.cells.clear();
    level.blocks.clear();
    level.before.clear();
    level.points = 0;
    level.latest = {};
  }
}

std::uint64_t FeatureMap::key_of(int x, int y, int z) {
  constexpr int kBias = 1 << 20;
  constexpr std::uint64_t kMask = (1 << 21) - 1;
  return (std::uint64_t(x + kBias) & kMask) << 42 | (std::uint64_t(y + kBias) & kMask) << 21 |
         (std::uint64_t(z + kBias) & kMask);
}

std::size_t FeatureMap::hash_of(std::uint64_t key) {
  key ^= key >> 31;
  key *= 0x9E3779B97F4A7C15ull;
  return static_cast<std::size_t>(key >> 20);
}

int FeatureMap::place_in_brick(int x, int y, int z) {
  constexpr int kMask = kBrick - 1;
  return (x & kMask) + kBrick * ((y & kMask) + kBrick * (z & kMask));
}

std::uint32_t FeatureMap::find_brick(const Level& level, std::uint64_t key) {
  const std::size_t mask = level.slots.size() - 1;
  for (std::size_t i = hash_of(key) & mask;; i = (i + 1) & mask) {
    const Slot& slot = level.slots[i];
    if (slot.key == key || slot.brick == kNone) return slot.brick;
  }
}

std::uint32_t FeatureMap::find_or_add_brick(Level& level, std::uint64_t key) {
  if (level.latest.key == key) return level.latest.brick;
  if (2 * (level.bricks.size() + 1) > level.slots.size()) grow(level);
  const std::size_t mask = level.slots.size() - 1;
  std::size_t i = hash_of(key) & mask;
  while (level.slots[i].brick != kNone && level.slots[i].key != key) i = (i + 1) & mask;
  if (level.slots[i].brick == kNone) {
    level.slots[i] = {key, static_cast<std::uint32_t>(level.bricks.size())};
    level.bricks.emplace_back();
  }
  level.latest = level.slots[i];
  return level.latest.brick;
}

FeatureMap::Cell& FeatureMap::find_or_add(Level& level, int x, int y, int z) {
  const std::uint32_t brick =
      find_or_add_brick(level, key_of(x >> kBrickBits, y >> kBrickBits, z >> kBrickBits));
  std::uint32_t& cell = level.bricks[brick].cells[place_in_brick(x, y, z)];
  if (cell == kNone) {
    cell = static_cast<std::uint32_t>(level.cells.size());
    level.cells.emplace_back();
  }
  return level.cells[cell];
}

void FeatureMap::grow(Level& level) {
  std::vector<Slot> old(level.slots.size() * 2);
  old.swap(level.slots);
  const std::size_t mask = level.slots.size() - 1;
  for (const Slot& slot : old) {
    if (slot.brick == kNone) continue;
    std::size_t i = hash_of(slot.key) & mask;
    while (level.slots[i].brick != kNone) i = (i + 1) & mask;
    level.slots[i] = slot;
  }
}

void FeatureMap::add_point(Level& level, Cell& cell, int side, const Eigen::Vector3f& p_m,
                           std::uint32_t line) {
  const std::uint32_t i = cell.points[side]++ % kBlock;
  if (i == 0) {
    level.before.push_back(cell.last[side]);
    cell.last[side] = static_cast<std::uint32_t>(level.blocks.size());
    level.blocks.emplace_back();
  }
  Block& block = level.blocks[cell.last[side]];
  block.x[i] = p_m.x();
  block.y[i] = p_m.y();
  block.z[i] = p_m.z();
  block.line[i] = line;
  ++level.points;
}

void FeatureMap::insert(const Eigen::Vector3f& p_m, std::uint32_t line, int direction) {
  const int side = direction > 0 ? 1 : 0;
  for (Level& level : levels_) {
    const Eigen::Vector3f scaled = p_m * level.inverse_cell;
    const int x = whole(scaled.x()), y = whole(scaled.y()), z = whole(scaled.z());
    Cell& cell = find_or_add(level, x, y, z);
    if (thinned_) {
      const auto third = [](float value, int below) {
        return std::min(2, static_cast<int>(3 * (value - float(below))));
      };
      const int place = third(scaled.x(), x) + 3 * third(scaled.y(), y) + 9 * third(scaled.z(), z);
      if (cell.taken[side] >> place & 1u) continue;
      cell.taken[side] |= 1u << place;
    }
    add_point(level, cell, side, p_m, line);
  }
}

int FeatureMap::level_for(double radius_m) const {
  int l = 0;
  while (l + 1 < kLevels && levels_[l].radius_m < radius_m) ++l;
  return l;
}

void FeatureMap::nearest(const Eigen::Vector3f& p_m, int level_index, SweepFilter filter, int most,
                         int per_line, Neighbours& found, int least) const {
  const Level& level = levels_[level_index];
  const auto radius = static_cast<float>(level.radius_m);
  NearestList list(std::min(most, Neighbours::kMax), per_line, radius * radius);
  CellsInReach cells;
  gather(level, p_m, radius * radius, filter, cells);
  if (cells.points >= std::uint32_t(least)) {
    for (int i = 0; i < cells.count; ++i) {
      if (cells.at[i].gap_m2 >= list.limit_m2()) continue;
      for (int side = 0; side < 2; ++side)
        if (static_cast<int>(filter) >> side & 1) search(level, *cells.at[i].cell, side, p_m, list);
    }
  }
  list.write(level, found);
}

void FeatureMap::gather(const Level& level, const Eigen::Vector3f& p_m, float limit_m2, SweepFilter filter,
                        CellsInReach& cells) {
  static constexpr std::array<CellStep, 27> kSteps = near_first();
  const Slabs x(p_m.x(), level.inverse_cell, level.cell_m), y(p_m.y(), level.inverse_cell, level.cell_m),
      z(p_m.z(), level.inverse_cell, level.cell_m);
  NearbyCells nearby(level, x.own, y.own, z.own);
  for (const CellStep& step : kSteps) {
    const float gap_m2 = x.gap_m2[step.x] + y.gap_m2[step.y] + z.gap_m2[step.z];
    if (gap_m2 >= limit_m2) continue;
    const Cell* cell = nearby.find(x.own + x.step[step.x], y.own + y.step[step.y], z.own + z.step[step.z]);
    if (cell == nullptr) continue;
    cells.at[cells.count++] = {cell, gap_m2};
    for (int side = 0; side < 2; ++side) {
      if ((static_cast<int>(filter) >> side & 1) == 0 || cell->points[side] == 0) continue;
      cells.points += cell->points[side];
      // Scattered over memory: they are on their way while the other cells are looked up.
      const Block& block = level.blocks[cell->last[side]];
      __builtin_prefetch(block.x.data());
      __builtin_prefetch(block.y.data() + 4);
      __builtin_prefetch(block.line.data());
    }
  }
}

void FeatureMap::search(const Level& level, const Cell& cell, int side, const Eigen::Vector3f& p_m,
                        NearestList& list) {
  std::uint32_t filled = (cell.points[side] + kBlock - 1) % kBlock + 1;
  for (std::uint32_t b = cell.last[side]; b != kNone; b = level.before[b], filled = kBlock) {
    const Block& block = level.blocks[b];
    std::array<float, kBlock> squared_m2;
    for (std::uint32_t i = 0; i < kBlock; ++i) {
      const float x = block.x[i] - p_m.x(), y = block.y[i] - p_m.y(), z = block.z[i] - p_m.z();
      squared_m2[i] = x * x + y * y + z * z;
    }
    for (std::uint32_t i = 0; i < filled; ++i)
      if (squared_m2[i] < list.limit_m2()) list.offer(squared_m2[i], block.line[i], kBlock * b + i);
  }
}

}  // namespace sweepscope
