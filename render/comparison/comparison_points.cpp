#include "render/comparison/comparison_points.hpp"
#include "core/numbers.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sweepscope {
namespace {

constexpr double kBlindHeight_m = 0.8;  // nearer to the path's height a roll error shows too little
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The sensor's height at the instants of a map's points, which come in the order of time.
class PathHeight {
 public:
  explicit PathHeight(const ComparedMap& map) : map_(map) {}

  double at(double time_s) {
    const auto& path = map_.path;
    if (path.empty()) return map_.path_height_m;
    if (next_ > 0 && path[next_ - 1].time_s > time_s) next_ = 0;
    while (next_ < path.size() && path[next_].time_s <= time_s) ++next_;
    if (next_ == 0) return path.front().position_m.z();
    if (next_ == path.size()) return path.back().position_m.z();
    const StampedPose &a = path[next_ - 1], &b = path[next_];
    const double t = (time_s - a.time_s) / (b.time_s - a.time_s);
    return (1 - t) * a.position_m.z() + t * b.position_m.z();
  }

 private:
  const ComparedMap& map_;
  std::size_t next_ = 0;
};

template <typename Visit>
void for_each_point(const ComparedMap& map, Visit visit) {
  if (!map.cloud) return;
  PathHeight path(map);
  std::size_t index = 0;
  for (const MapPoint& point : *map.cloud) {
    visit(index++, point, static_cast<double>(point.z) - path.at(point.time_s));
  }
}

bool is_inside(const MapPoint& point, const Box& box) {
  const Eigen::Array3d p = point.getVector3fMap().cast<double>().array();
  return (p >= box.from_m.array()).all() && (p <= box.to_m.array()).all();
}

bool in_any(std::span<const HeightRange> slabs, double height_m) {
  return std::ranges::any_of(
      slabs, [&](const HeightRange& slab) { return height_m >= slab.from_m && height_m <= slab.to_m; });
}

/// How far above the path a ceiling begins to hide what is below it; infinite where there is none.
double ceiling_above_path_m(std::span<const ComparedMap> maps) {
  constexpr double kBin_m = 0.1, kMinShare = 0.12;
  std::vector<std::size_t> bins(300, 0);
  std::size_t above = 0;
  for (const ComparedMap& map : maps) {
    for_each_point(map, [&](std::size_t, const MapPoint&, double height_m) {
      if (height_m < kBlindHeight_m) return;
      ++above;
      const double bin = (height_m - kBlindHeight_m) / kBin_m;
      if (bin < static_cast<double>(bins.size())) ++bins[static_cast<std::size_t>(bin)];
    });
  }
  std::size_t best = 0, best_count = 0;  // three bins together: a blurred ceiling is thick
  for (std::size_t i = 1; i + 1 < bins.size(); ++i) {
    const std::size_t count = bins[i - 1] + bins[i] + bins[i + 1];
    if (count > best_count) best = i, best_count = count;
  }
  if (static_cast<double>(best_count) < kMinShare * static_cast<double>(above) || above == 0)
    return kInfinity;
  // Lamps and beams hang below it, and a roll error tilts its far parts down: a quarter of the way is left
  // out.
  const double ceiling_m = kBlindHeight_m + (static_cast<double>(best) + 0.5) * kBin_m;
  const double height_m = ceiling_m - std::max(0.5, 0.25 * ceiling_m);
  return height_m > kBlindHeight_m + 0.3 ? height_m : kInfinity;
}

}  // namespace

std::vector<HeightRange> choose_slabs(std::span<const ComparedMap> maps, const ComparisonOptions& options) {
  if (!options.slabs.empty()) return options.slabs;
  const double ceiling_m = ceiling_above_path_m(maps);
  if (options.viewpoint != Viewpoint::kTop || options.camera || options.box) return {{-kInfinity, ceiling_m}};
  return {{-kInfinity, -kBlindHeight_m}, {kBlindHeight_m, ceiling_m}};
}

std::vector<std::uint32_t> indices_in_slabs(const ComparedMap& map, std::span<const HeightRange> slabs) {
  std::vector<std::uint32_t> indices;
  for_each_point(map, [&](std::size_t index, const MapPoint&, double height_m) {
    if (in_any(slabs, height_m)) indices.push_back(static_cast<std::uint32_t>(index));
  });
  return indices;
}

SlabPoints points_in_slabs(const ComparedMap& map, std::span<const float> values,
                           std::span<const HeightRange> slabs, const std::optional<Box>& box) {
  SlabPoints out;
  for_each_point(map, [&](std::size_t index, const MapPoint& point, double height_m) {
    if (!in_any(slabs, height_m) || (box && !is_inside(point, *box))) return;
    out.points.add({point.x, point.y, point.z}, values[index]);
    out.above_path_m.push_back(static_cast<float>(height_m));
  });
  return out;
}

std::shared_ptr<const ColouredPoints> points_seen(const SlabPoints& map, const Projection& projection,
                                                  float min_height_m) {
  constexpr double kCellsPerPixel = 2;
  std::vector<char> seen(map.points.size());
  for_each_block(seen.size(), 1, [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const auto& p = map.points.xyz_m[i];
      if (map.above_path_m[i] < min_height_m) continue;
      const auto at = projection(Eigen::Vector3f(p[0], p[1], p[2]).cast<double>());
      seen[i] = at && projection.place().contains(*at);
    }
  });
  ColouredPoints inside;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] != 0) inside.add(map.points.xyz_m[i], map.points.values[i]);
  }
  const double edge_m = std::max(projection.metres_per_px(), 1e-5) / kCellsPerPixel;
  return std::make_shared<const ColouredPoints>(thin(inside, edge_m));
}

Bounds bounds_of(std::span<const SlabPoints> maps, std::size_t axis, double outermost_fraction) {
  std::vector<float> all;
  for (const SlabPoints& map : maps) {
    for (const auto& point : map.points.xyz_m) all.push_back(point[axis]);
  }
  if (all.empty()) return {0, 1};
  const auto at = [&](double fraction) { return static_cast<double>(quantile(all, fraction)); };
  const double from = at(outermost_fraction);
  return {from, at(1 - outermost_fraction)};
}

}  // namespace sweepscope
