#pragma once

// The mathematics: docs/algorithms.md, section 4.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace sweepscope {

/// The sweeps whose points a query sees, by their direction of turning.
enum class SweepFilter : std::uint8_t { kBackward = 1, kForward = 2, kAny = 3 };

/// The points nearest to a query, nearest first.
struct Neighbours {
  static constexpr int kMax = 10;               // the largest number that PatchOptions asks for
  int count = 0;                                // found so far
  int lines = 0;                                // distinct scan lines among them
  std::array<Eigen::Vector3f, kMax> p_m;        // in the frame of the map, the nearest first
  std::array<float, kMax> squared_distance_m2;  // from the point asked for
  std::array<std::uint32_t, kMax> line;         // the scan line that each was measured on
};

/// A map of feature points, thinned, in hashed grids of doubling cell size: level l has cells of `cell_m *
/// 2^l` and at most one point per third of a cell and sweep direction, and is searched within 5/6 of a cell.
/// Distant points, which are sparse, are therefore matched as fast as near ones. The first point in a third
/// of a cell is kept.
class FeatureMap {
 public:
  static constexpr int kLevels = 4;  // cells of 0.6 to 4.8 m: beyond, 30 m of range have as few points
  /// An empty map. `cell_m` is the edge of the finest cells; a thinned map keeps one point in a third of a
  /// cell.
  explicit FeatureMap(double cell_m = 0.6, bool thinned = true);

  /// Adds a point of scan line `line` (below 2^31) of a sweep turning in `direction` (+1 or -1).
  void insert(const Eigen::Vector3f& p_m, std::uint32_t line, int direction);

  /// The level whose search radius is at least `radius_m`, or the last.
  int level_for(double radius_m) const;
  /// The distance within which a level is searched.
  double search_radius_m(int level) const { return levels_[level].radius_m; }

  /// The nearest points: at most `most`, and at most `per_line` of one scan line. Empty if it is clear early
  /// that there are fewer than `least`.
  void nearest(const Eigen::Vector3f& p_m, int level, SweepFilter filter, int most, int per_line,
               Neighbours& found, int least = 1) const;

  /// The number of points.
  std::size_t size() const { return levels_[0].points; }
  /// Removes all points; memory is kept for the next ones.
  void clear();

 private:
  static constexpr std::uint32_t kBlock = 12;                     // points; fills three cache lines
  static constexpr int kBrickBits = 2, kBrick = 1 << kBrickBits;  // cells along a brick's edge
  static constexpr std::uint32_t kNone = 0xffffffffu;
  // Points of one cell and direction, usually all of them: three cache lines.
  struct alignas(64) Block {
    std::array<float, kBlock> x{}, y{}, z{};
    std::array<std::uint32_t, kBlock> line{};
  };
  // By direction: points, the block that the last one is in (see Level::before), and the thirds of the cell
  // that hold one.
  struct Cell {
    std::array<std::uint32_t, 2> points{0, 0}, last{kNone, kNone}, taken{0, 0};
  };
  // Neighbouring cells, hashed as one: the 27 cells of a query lie in at most 8 bricks.
  struct Brick {
    Brick() { cells.fill(kNone); }
    std::array<std::uint32_t, std::size_t{kBrick} * kBrick * kBrick> cells;
  };
  struct Slot {
    std::uint64_t key = kNoKey;
    std::uint32_t brick = kNone;
  };
  static constexpr std::uint64_t kNoKey = ~std::uint64_t{0};
  struct Level {
    float inverse_cell = 0, cell_m = 0;
    double radius_m = 0;
    std::vector<Slot> slots;
    std::vector<Brick> bricks;
    std::vector<Cell> cells;
    std::vector<Block> blocks;
    std::vector<std::uint32_t> before;  // each block's predecessor in its cell, full
    std::size_t points = 0;
    Slot latest;  // the brick that a point was added to: the next one mostly lies there as well
  };
  class NearbyCells;
  struct CellsInReach;
  class NearestList;
  static std::uint64_t key_of(int x, int y, int z);
  static std::size_t hash_of(std::uint64_t key);
  static int place_in_brick(int x, int y, int z);
  static std::uint32_t find_brick(const Level& level, std::uint64_t key);
  static std::uint32_t find_or_add_brick(Level& level, std::uint64_t key);
  static Cell& find_or_add(Level& level, int x, int y, int z);
  static void grow(Level& level);
  static void add_point(Level& level, Cell& cell, int side, const Eigen::Vector3f& p_m, std::uint32_t line);
  static void gather(const Level& level, const Eigen::Vector3f& p_m, float limit_m2, SweepFilter filter,
                     CellsInReach& cells);
  // Offers a cell's points of one direction.
  static void search(const Level& level, const Cell& cell, int side, const Eigen::Vector3f& p_m,
                     NearestList& list);

  std::array<Level, kLevels> levels_;
  bool thinned_;
};

}  // namespace sweepscope
