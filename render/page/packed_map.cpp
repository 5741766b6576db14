#include "render/page/packed_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>

#include "core/io/printable_text.hpp"

namespace sweepscope {
namespace {

constexpr std::uint32_t kMaxStep = (1U << 21) - 1;

/// Arrays of numbers, one after the other.
class Arrays {
 public:
  template <typename Number>
  void add(const std::string& name, const std::vector<Number>& numbers) {
    bytes_.append((8 - bytes_.size() % 8) % 8, '\0');
    const std::size_t size = numbers.size() * sizeof(Number);
    places_[name] = {bytes_.size(), size};
    bytes_.append(reinterpret_cast<const char*>(numbers.data()), size);
  }
  std::string take_bytes() { return std::move(bytes_); }
  nlohmann::ordered_json places() const { return places_; }

 private:
  std::string bytes_;
  nlohmann::ordered_json places_ = nlohmann::ordered_json::object();
};

/// A power of two, so that ticks are exact; the last of the times is below 2^31 ticks.
double tick_for(double duration_s) {
  double tick_s = std::ldexp(1, -21);
  while (duration_s > 0.99 * std::ldexp(tick_s, 31)) tick_s *= 2;
  return tick_s;
}

/// A grid of 2^21 steps along each axis that holds all beams.
struct Grid {
  std::array<float, 3> corner_m{};
  double step_m = 1e-6;

  std::uint32_t step(const TurnableBeam& beam, std::size_t axis) const {
    const double steps = (double(beam.p_in_motor_m[axis]) - double(corner_m[axis])) / step_m;
    return static_cast<std::uint32_t>(std::clamp(std::round(steps), 0.0, double(kMaxStep)));
  }
};

Grid grid_for(const std::vector<TurnableBeam>& beams) {
  Grid grid;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = [axis](const TurnableBeam& beam) { return beam.p_in_motor_m[axis]; };
    const auto [min, max] = std::ranges::minmax_element(beams, {}, at);
    if (min == beams.end()) break;
    grid.corner_m[axis] = at(*min);
    grid.step_m = std::max(grid.step_m, (double(at(*max)) - double(at(*min))) / kMaxStep);
  }
  return grid;
}

std::vector<std::uint32_t> packed_beams(const TurnableMap& map, const Grid& grid, double origin_s,
                                        double tick_s) {
  std::vector<std::uint32_t> words;
  words.reserve(3 * map.beams.size());
  for (const TurnableBeam& beam : map.beams) {
    const std::uint32_t x = grid.step(beam, 0), y = grid.step(beam, 1), z = grid.step(beam, 2);
    words.push_back(x | (y & 0x7ff) << 21);
    words.push_back(y >> 11 | z << 10);
    words.push_back(static_cast<std::uint32_t>(std::llround((beam.time_s - origin_s) / tick_s)));
  }
  return words;
}

void add_path(Arrays& arrays, const std::vector<SweepPose>& path) {
  std::vector<double> poses;
  std::vector<float> knots;
  for (const SweepPose& pose : path) {
    for (const double value :
         {double(pose.sweep), pose.begin_s, pose.end_s, static_cast<double>(pose.knots.size())})
      poses.push_back(value);
    for (const Pose& knot : pose.knots) {
      const auto& p_m = knot.translation_m;
      const auto& q = knot.rotation;
      for (const double value : {p_m.x(), p_m.y(), p_m.z(), q.x(), q.y(), q.z(), q.w()})
        knots.push_back(static_cast<float>(value));
    }
  }
  arrays.add("path", poses);
  arrays.add("knots", knots);
}

void add_motor(Arrays& arrays, const TurnableMap& map) {
  std::vector<double> motor, sweeps;
  for (std::size_t i = 0; i < map.motor.time_s.size(); ++i) {
    motor.push_back(map.motor.time_s[i]);
    motor.push_back(map.motor.angle_rad[i]);
  }
  for (const Sweep& sweep : map.sweeps) {
    sweeps.push_back(sweep.begin_s);
    sweeps.push_back(sweep.end_s);
  }
  arrays.add("motor", motor);
  arrays.add("sweeps", sweeps);
}

void add_scans(Arrays& arrays, const std::vector<TurnableScan>& scans) {
  std::vector<double> middles_s;
  std::vector<std::uint32_t> counts;
  for (const TurnableScan& scan : scans) {
    middles_s.push_back(scan.middle_s);
    counts.push_back(static_cast<std::uint32_t>(scan.beams));
  }
  arrays.add("scans", middles_s);
  arrays.add("counts", counts);
}

}  // namespace

PackedMap pack_map(const TurnableMap& map, std::span<const NamedBytes> more) {
  const auto [first, last] = std::ranges::minmax_element(map.beams, {}, &TurnableBeam::time_s);
  const double laser_origin_s = map.beams.empty() ? 0 : first->time_s;
  const double laser_s = map.beams.empty() ? 0 : last->time_s - laser_origin_s;
  const double motor_origin_s = map.motor.time_s.empty() ? 0 : map.motor.time_s.front();
  const double motor_s = map.motor.time_s.empty() ? 0 : map.motor.time_s.back() - motor_origin_s;
  const double tick_s = tick_for(std::max(laser_s, motor_s));
  const Grid grid = grid_for(map.beams);

  Arrays arrays;
  arrays.add("beams", packed_beams(map, grid, laser_origin_s, tick_s));
  add_scans(arrays, map.scans);
  add_motor(arrays, map);
  add_path(arrays, map.path);
  for (const NamedBytes& one : more) arrays.add(one.name, one.bytes);
  nlohmann::ordered_json head{{"tick_s", tick_s},
                              {"laser_origin_s", laser_origin_s},
                              {"motor_origin_s", motor_origin_s},
                              {"axis", {map.axis.x(), map.axis.y(), map.axis.z()}},
                              {"corner_m", grid.corner_m},
                              {"step_m", grid.step_m},
                              {"moving", map.moving},
                              {"arrays", arrays.places()}};
  return {arrays.take_bytes(), json_text(std::move(head))};
}

}  // namespace sweepscope
