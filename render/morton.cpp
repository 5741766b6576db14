#include "render/morton.hpp"

#include <algorithm>

#include "core/parallel.hpp"
#include "core/parallel_sort.hpp"

namespace sweepscope {
namespace {

constexpr double kLastCube = (1U << kMortonBits) - 1;

/// Spreads 21 bits out to every third bit.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffff;
  bits = (bits | bits << 16) & 0x001f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  bits = (bits | bits << 2) & 0x1249249249249249;
  return bits;
}

std::uint64_t code_of(const std::array<float, 3>& point_m, const std::array<float, 3>& origin_m,
                      double edge_m) {
  std::uint64_t code = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double along_m = static_cast<double>(point_m[axis]) - static_cast<double>(origin_m[axis]);
    code |= spread(static_cast<std::uint64_t>(std::clamp(along_m / edge_m, 0.0, kLastCube))) << axis;
  }
  return code;
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
