#include "core/loam/feature_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sweepscope {
namespace {

// Keeps the nearest candidates in order, at most `per_line` of one scan line.
class NearestList {
 public:
  NearestList(Neighbours& found, int most, int per_line, float limit_m2)
      : found_(found), most_(most), per_line_(per_line), limit_m2_(limit_m2) {}

  float limit_m2() const { return limit_m2_; }

  void offer(float squared_m2, float x, float y, float z, std::uint32_t line) {
    int of_line = 0, farthest_of_line = -1;
    for (int i = 0; i < found_.count; ++i) {
      if (found_.line[i] != line) continue;
      ++of_line;
      farthest_of_line = i;
    }
    if (of_line >= per_line_) {
      if (squared_m2 >= found_.squared_distance_m2[farthest_of_line]) return;
      remove(farthest_of_line);
    } else if (found_.count == most_) {
      remove(most_ - 1);
    }
    int place = found_.count++;
    for (; place > 0 && found_.squared_distance_m2[place - 1] > squared_m2; --place) move(place - 1, place);
    found_.p_m[place] = {x, y, z};
    found_.squared_distance_m2[place] = squared_m2;
    found_.line[place] = line;
    if (found_.count == most_) limit_m2_ = found_.squared_distance_m2[most_ - 1];
  }

 private:
  void move(int from, int to) {
    found_.p_m[to] = found_.p_m[from];
    found_.squared_distance_m2[to] = found_.squared_distance_m2[from];
    found_.line[to] = found_.line[from];
  }
  void remove(int i) {
    for (; i + 1 < found_.count; ++i) move(i + 1, i);
    --found_.count;
  }

  Neighbours& found_;
  int most_, per_line_;
  float limit_m2_;
};

int count_lines(const Neighbours& found) {
  int lines = 0;
  for (int i = 0; i < found.count; ++i) {
    bool seen = false;
    for (int k = 0; k < i; ++k) seen = seen || found.line[k] == found.line[i];
    lines += seen ? 0 : 1;
  }
  return lines;
}

int cell_index(float value_m, float inverse_cell) {
  return static_cast<int>(std::floor(value_m * inverse_cell));
}

}  // namespace

FeatureMap::FeatureMap(double cell_m, bool thinned) : thinned_(thinned) {
  for (int l = 0; l < kLevels; ++l) {
    levels_[l].cell_m = static_cast<float>(cell_m * (1 << l));
    levels_[l].inverse_cell = 1.0f / levels_[l].cell_m;
    levels_[l].radius_m = levels_[l].cell_m * 5.0 / 6.0;
    levels_[l].slots.resize(1024);
  }
}

void FeatureMap::clear() {
  for (Level& level : levels_) {
    std::fill(level.slots.begin(), level.slots.end(), Slot{});
    level.cells.clear();
    level.blocks.clear();
    level.points = 0;
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

const FeatureMap::Cell* FeatureMap::find(const Level& level, std::uint64_t key) {
  const std::size_t mask = level.slots.size() - 1;
  for (std::size_t i = hash_of(key) & mask;; i = (i + 1) & mask) {
    const Slot& slot = level.slots[i];
    if (slot.cell == kNone) return nullptr;
    if (slot.key == key) return &level.cells[slot.cell];
  }
}

FeatureMap::Cell& FeatureMap::find_or_add(Level& level, std::uint64_t key) {
  if (2 * (level.cells.size() + 1) > level.slots.size()) grow(level);
  const std::size_t mask = level.slots.size() - 1;
  for (std::size_t i = hash_of(key) & mask;; i = (i + 1) & mask) {
    Slot& slot = level.slots[i];
    if (slot.cell == kNone) {
      slot = {key, static_cast<std::uint32_t>(level.cells.size())};
      return level.cells.emplace_back();
    }
    if (slot.key == key) return level.cells[slot.cell];
  }
}

void FeatureMap::grow(Level& level) {
  std::vector<Slot> old(level.slots.size() * 2);
  old.swap(level.slots);
  const std::size_t mask = level.slots.size() - 1;
  for (const Slot& slot : old) {
    if (slot.cell == kNone) continue;
    std::size_t i = hash_of(slot.key) & mask;
    while (level.slots[i].cell != kNone) i = (i + 1) & mask;
    level.slots[i] = slot;
  }
}

void FeatureMap::add_point(Level& level, std::uint32_t& first, const Eigen::Vector3f& p_m,
                           std::uint32_t line) {
  if (first == kNone || level.blocks[first].count == kBlock) {
    Block block;
    block.next = first;
    first = static_cast<std::uint32_t>(level.blocks.size());
    level.blocks.push_back(block);
  }
  Block& block = level.blocks[first];
  const std::uint32_t i = block.count++;
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
    const int x = static_cast<int>(std::floor(scaled.x())), y = static_cast<int>(std::floor(scaled.y())),
              z = static_cast<int>(std::floor(scaled.z()));
    Cell& cell = find_or_add(level, key_of(x, y, z));
    if (thinned_) {
      const auto third = [](float value, int whole) {
        return std::min(2, static_cast<int>(3 * (value - float(whole))));
      };
      const int place = third(scaled.x(), x) + 3 * third(scaled.y(), y) + 9 * third(scaled.z(), z);
      if (cell.taken[side] >> place & 1u) continue;
      cell.taken[side] |= 1u << place;
    }
    add_point(level, cell.first[side], p_m, line);
  }
}

int FeatureMap::level_for(double radius_m) const {
  int l = 0;
  while (l + 1 < kLevels && levels_[l].radius_m < radius_m) ++l;
  return l;
}

void FeatureMap::nearest(const Eigen::Vector3f& p_m, int level_index, SweepFilter filter, int most,
                         int per_line, Neighbours& found) const {
  const Level& level = levels_[level_index];
  const auto radius = static_cast<float>(level.radius_m);
  found.count = 0;
  NearestList list(found, std::min(most, Neighbours::kMax), per_line, radius * radius);

  const int cx = cell_index(p_m.x(), level.inverse_cell), cy = cell_index(p_m.y(), level.inverse_cell),
            cz = cell_index(p_m.z(), level.inverse_cell);
  const auto gap = [&](int d, int c, float value) {  // distance from the point to the slab of cells at c + d
    if (d == 0) return 0.0f;
    return d < 0 ? value - float(c) * level.cell_m : float(c + 1) * level.cell_m - value;
  };
  // The own cell first: what it holds narrows the search in the others.
  static constexpr std::array<int, 3> kOrder{0, -1, 1};
  for (const int dx : kOrder) {
    const float gx = gap(dx, cx, p_m.x());
    for (const int dy : kOrder) {
      const float gy = gap(dy, cy, p_m.y());
      for (const int dz : kOrder) {
        const float gz = gap(dz, cz, p_m.z());
        if (gx * gx + gy * gy + gz * gz >= list.limit_m2()) continue;
        const Cell* cell = find(level, key_of(cx + dx, cy + dy, cz + dz));
        if (cell == nullptr) continue;
        for (int side = 0; side < 2; ++side) {
          if ((static_cast<int>(filter) >> side & 1) == 0) continue;
          for (std::uint32_t b = cell->first[side]; b != kNone; b = level.blocks[b].next) {
            const Block& block = level.blocks[b];
            std::array<float, kBlock> squared;
            for (int i = 0; i < kBlock; ++i) {
              const float x = block.x[i] - p_m.x(), y = block.y[i] - p_m.y(), z = block.z[i] - p_m.z();
              squared[i] = x * x + y * y + z * z;
            }
            for (std::uint32_t i = 0; i < block.count; ++i)
              if (squared[i] < list.limit_m2())
                list.offer(squared[i], block.x[i], block.y[i], block.z[i], block.line[i]);
          }
        }
      }
    }
  }
  found.lines = count_lines(found);
}

}  // namespace sweepscope
