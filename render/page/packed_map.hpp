#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/map/turnable_map.hpp"

namespace sweepscope {

/// A map for every offset as a page holds it: bytes for the graphics card, and how to read them.
///
/// Times of beams are whole ticks of the laser's clock since `laser_origin_s`, and positions whole steps from
/// `corner_m`, both fine enough that a point is placed to within 0.2 mm: a tick is at most 0.5 us for 17
/// minutes, a step the map's extent / 2^21. Arrays are little-endian, each at a multiple of 8 bytes:
///   beams      3 uint32 each: x and the low bits of y; the high bits of y and z (21 bits each); ticks
///   scans      middle_s as float64
///   counts     beams of each scan, uint32
///   motor      time_s and angle_rad as float64, sample by sample, on the motor's clock
///   sweeps     begin_s and end_s as float64, on the motor's clock
///   path       of each pose: number of the sweep, begin_s, end_s and number of knots, as float64
///   knots      translation (m) and quaternion (x, y, z, w) of map_from_base, 7 float32 each
/// and more arrays of bytes that are given.
struct PackedMap {
  std::string bytes;
  /// JSON: tick_s, laser_origin_s, motor_origin_s, axis, corner_m, step_m, moving, and arrays: {NAME: [first
  /// byte, bytes]}.
  std::string head_json;
};

struct NamedBytes {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

PackedMap pack_map(const TurnableMap& map, std::span<const NamedBytes> more = {});

}  // namespace sweepscope
