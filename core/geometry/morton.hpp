#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sweepscope {

/// Spreads the low 21 bits out to every third bit.
constexpr std::uint64_t morton_spread(std::uint64_t bits) {
  bits &= 0x1fffff;
  bits = (bits | bits << 32) & 0x001f00000000ffff;
  bits = (bits | bits << 16) & 0x001f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

/// The inverse: gathers every third bit.
constexpr std::uint64_t morton_gathered(std::uint64_t code) {
  code &= 0x1249249249249249;
  code = (code | code >> 2) & 0x10c30c30c30c30c3;
  code = (code | code >> 4) & 0x100f00f00f00f00f;
  code = (code | code >> 8) & 0x001f0000ff0000ff;
  code = (code | code >> 16) & 0x001f00000000ffff;
  return (code | code >> 32) & 0x1fffff;
}

/// A cube's number along a Morton curve, by its place along each axis.
constexpr std::uint64_t morton_code(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return morton_spread(x) | morton_spread(y) << 1 | morton_spread(z) << 2;
}

/// A point's number along a Morton curve: points that are close in space have close numbers.
struct MortonKey {
  std::uint64_t code;   // of its cube: 21 bits along each axis
  std::uint32_t index;  // of the point

  bool operator<(const MortonKey& other) const {
    return code != other.code ? code < other.code : index < other.index;
  }
};

constexpr int kMortonBits = 21;

/// Orders keys whose indices ascend along the curve; equal codes stay in the order of their indices.
void sort_along_curve(std::vector<MortonKey>& keys);

/// The chosen points, given by ascending indices, ordered along the curve through cubes of `edge_m`, counted
/// from `origin_m`; points of one cube are in the order of their indices. Points beyond the last cube belong
/// to it. The result is the same for any number of threads.
std::vector<MortonKey> along_morton_curve(std::span<const std::array<float, 3>> points_m,
                                          std::span<const std::uint32_t> chosen,
                                          const std::array<float, 3>& origin_m, double edge_m);

}  // namespace sweepscope
