#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sweepscope {

/// A point's number along a Morton curve, on which what is near in space is near in number.
struct MortonKey {
  std::uint64_t code;   // of its cube: 21 bits along each axis
  std::uint32_t index;  // of the point

  bool operator<(const MortonKey& other) const {
    return code != other.code ? code < other.code : index < other.index;
  }
};

constexpr int kMortonBits = 21;

/// The chosen points along the curve through cubes of `edge_m`, counted from `origin_m`; those of one cube in
/// the order of their indices. What lies beyond the last cube counts into it. The same for any number of
/// threads.
std::vector<MortonKey> along_morton_curve(std::span<const std::array<float, 3>> points_m,
                                          std::span<const std::uint32_t> chosen,
                                          const std::array<float, 3>& origin_m, double edge_m);

}  // namespace sweepscope
