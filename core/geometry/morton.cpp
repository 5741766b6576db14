#include "core/geometry/morton.hpp"

#include <algorithm>

#include "core/parallel.hpp"

namespace sweepscope {
namespace {

constexpr double kLastCube = (1U << kMortonBits) - 1;

std::uint64_t code_of(const std::array<float, 3>& point_m, const std::array<float, 3>& origin_m,
                      double edge_m) {
  const auto cube = [&](std::size_t axis) {
    const double along_m = static_cast<double>(point_m[axis]) - static_cast<double>(origin_m[axis]);
    return static_cast<std::uint64_t>(std::clamp(along_m / edge_m, 0.0, kLastCube));
  };
  return morton_code(cube(0), cube(1), cube(2));
}

}  // namespace

std::vector<MortonKey> along_morton_curve(std::span<const std::array<float, 3>> points_m,
                                          std::span<const std::uint32_t> chosen,
                                          const std::array<float, 3>& origin_m, double edge_m) {
  std::vector<MortonKey> keys(chosen.size());
  for_each_block(chosen.size(), 4096, [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k)
      keys[k] = {code_of(points_m[chosen[k]], origin_m, edge_m), chosen[k]};
  });
  sort_in_parallel(keys);
  return keys;
}

}  // namespace sweepscope
