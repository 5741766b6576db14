#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/comparison/comparison_points.hpp"

namespace sweepscope {
namespace {

constexpr double kCell_m = 0.05, kTile_m = 0.5, kMinHeight_m = 0.8;
constexpr double kMaxTiles = 2000;  // along a side: 1 km

/// Filled cells of a tile, or of a window of tiles, with their moments about the grid's corner.
struct Filled {
  double count = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;

  void add(double px, double py) {
    count += 1, x += px, y += py, xx += px * px, yy += py * py, xy += px * py;
  }
  void add(const Filled& other) {
    count += other.count, x += other.x, y += other.y, xx += other.xx, yy += other.yy, xy += other.xy;
  }
  /// 1 if the cells spread equally in all directions, 0 if they lie on a line.
  double roundness() const {
    if (count < 3) return 0;
    const double a = xx / count - x * x / (count * count), b = yy / count - y * y / (count * count);
    const double c = xy / count - x * y / (count * count);
    const double root = std::sqrt((a - b) * (a - b) / 4 + c * c), mean = (a + b) / 2;
    return mean + root > 0 ? std::max(0.0, (mean - root) / (mean + root)) : 0;
  }
};

struct TileGrid {
  Bounds x, y;
  std::size_t columns = 0, rows = 0;
  std::vector<Filled> tiles;

  Filled window(std::size_t column, std::size_t row, std::size_t wide, std::size_t high) const {
    Filled sum;
    for (std::size_t r = row; r < std::min(rows, row + high); ++r) {
      for (std::size_t c = column; c < std::min(columns, column + wide); ++c) sum.add(tiles[r * columns + c]);
    }
    return sum;
  }
};

/// Floors fill their cells however sharp they are: only what stands above the path counts.
TileGrid fill_tiles(const SlabPoints& map, const Bounds& x, const Bounds& y) {
  TileGrid grid{x,
                y,
                static_cast<std::size_t>(std::min(kMaxTiles, x.length() / kTile_m)) + 1,
                static_cast<std::size_t>(std::min(kMaxTiles, y.length() / kTile_m)) + 1,
                {}};
  grid.tiles.resize(grid.columns * grid.rows);
  std::vector<std::uint64_t> cells;
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const double px = static_cast<double>(map.points.xyz_m[i][0]) - x.from;
    const double py = static_cast<double>(map.points.xyz_m[i][1]) - y.from;
    if (static_cast<double>(map.above_path_m[i]) < kMinHeight_m) continue;
    if (px < 0 || py < 0 || px >= kTile_m * static_cast<double>(grid.columns) ||
        py >= kTile_m * static_cast<double>(grid.rows)) {
      continue;
    }
    cells.push_back(static_cast<std::uint64_t>(py / kCell_m) << 32 |
                    static_cast<std::uint64_t>(px / kCell_m));
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  for (const std::uint64_t cell : cells) {
    const double px = kCell_m * (static_cast<double>(cell & 0xffffffff) + 0.5);
    const double py = kCell_m * (static_cast<double>(cell >> 32) + 0.5);
    const auto column = std::min(grid.columns - 1, static_cast<std::size_t>(px / kTile_m));
    const auto row = std::min(grid.rows - 1, static_cast<std::size_t>(py / kTile_m));
    grid.tiles[row * grid.columns + column].add(px, py);
  }
  return grid;
}

/// The maps in tiles of one grid, and the window that is moved over it.
struct Tiled {
  std::vector<TileGrid> grids;  // of each map
  std::size_t side = 1;         // of the window, in tiles
};

Tiled tile(std::span<const SlabPoints> maps, const Bounds& x, const Bounds& y, double smaller_side_m) {
  Tiled tiled;
  for (const SlabPoints& map : maps) tiled.grids.push_back(fill_tiles(map, x, y));
  // Looked for in squares of half the close-up's smaller side, so that the find lies well inside.
  tiled.side = static_cast<std::size_t>(std::max(2.0, std::floor(0.5 * smaller_side_m / kTile_m)));
  return tiled;
}

struct CloseUpCandidate {
  double score = 0;
  DifferingPlace place;
};

/// The difference inside a window. A score of 0: no usable difference.
CloseUpCandidate candidate_at(const Tiled& tiled, std::size_t column, std::size_t row) {
  constexpr double kMinCells = 30;
  const std::size_t side = tiled.side, rim = side / 2;
  CloseUpCandidate found;
  for (const TileGrid& grid : tiled.grids)
    found.place.cells.push_back(static_cast<std::size_t>(grid.window(column, row, side, side).count));
  const auto sharp = static_cast<double>(found.place.cells[found.place.sharpest()]),
             blurred = static_cast<double>(found.place.cells[found.place.most_blurred()]);
  if (sharp < kMinCells) return found;
  const TileGrid& grid = tiled.grids[found.place.sharpest()];
  const Filled object = grid.window(column, row, side, side);
  const Filled around =
      grid.window(column - std::min(column, rim), row - std::min(row, rim), side + 2 * rim, side + 2 * rim);
  // Preferably with nothing around it: a pillar shows blur in more directions than a piece of a wall.
  const double alone = object.count / around.count;
  found.score = (1 - sharp / blurred) * std::sqrt(sharp) * object.roundness() * alone * alone;
  found.place.region.centre_m = {grid.x.from + object.x / object.count,
                                 grid.y.from + object.y / object.count};
  return found;
}

/// Best first; where they are equal, in the order of rows and columns.
std::vector<CloseUpCandidate> all_candidates(const Tiled& tiled) {
  std::vector<CloseUpCandidate> all;
  const TileGrid& first = tiled.grids.front();
  for (std::size_t row = 0; row + tiled.side <= first.rows; ++row) {
    for (std::size_t column = 0; column + tiled.side <= first.columns; ++column) {
      CloseUpCandidate candidate = candidate_at(tiled, column, row);
      if (candidate.score > 0) all.push_back(std::move(candidate));
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
  return all;
}

}  // namespace

std::size_t DifferingPlace::sharpest() const {
  return static_cast<std::size_t>(std::min_element(cells.begin(), cells.end()) - cells.begin());
}

std::size_t DifferingPlace::most_blurred() const {
  return static_cast<std::size_t>(std::max_element(cells.begin(), cells.end()) - cells.begin());
}

double DifferingPlace::ratio() const {
  return static_cast<double>(cells[most_blurred()]) / static_cast<double>(cells[sharpest()]);
}

std::vector<DifferingPlace> differing_places(std::span<const SlabPoints> maps, double height_m,
                                             double width_m, std::size_t max_count) {
  if (maps.empty()) return {};
  const Bounds x = bounds_of(maps, 0, 0.002), y = bounds_of(maps, 1, 0.002);
  const double larger_m = std::max(height_m, width_m);  // a close-up may be turned
  std::vector<DifferingPlace> best;
  for (CloseUpCandidate& candidate : all_candidates(tile(maps, x, y, std::min(height_m, width_m)))) {
    if (best.size() == max_count) break;
    const Eigen::Vector2d& here_m = candidate.place.region.centre_m;
    const bool shown = std::any_of(best.begin(), best.end(), [&](const DifferingPlace& other) {
      const Eigen::Vector2d apart_m = (other.region.centre_m - here_m).cwiseAbs();
      return apart_m.maxCoeff() < larger_m;
    });
    if (shown) continue;
    candidate.place.region.height_m = height_m;
    best.push_back(std::move(candidate.place));
  }
  return best;
}

double close_up_height_m(double extent_m) {
  return std::clamp(extent_m / 24, 2.0, 6.0);
}

Region find_close_up(std::span<const SlabPoints> maps, double height_m, double width_m) {
  const auto best = differing_places(maps, height_m, width_m, 1);
  if (!best.empty()) return best.front().region;
  return {{bounds_of(maps, 0, 0.002).middle(), bounds_of(maps, 1, 0.002).middle()}, height_m};
}

}  // namespace sweepscope
