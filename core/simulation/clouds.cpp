#include "core/simulation/clouds.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "core/recording/messages/messages.hpp"
#include "core/recording/messages/point_cloud.hpp"
#include "core/recording/messages/raw_messages.hpp"
#include "core/simulation/write_simulation.hpp"

namespace sweepscope::simulation {
namespace {

// As sensor_msgs/PointField numbers them.
constexpr std::uint8_t kUint16 = 4, kFloat32 = 7;
constexpr std::uint32_t kPointBytes = 22;

std::vector<RawCloud::Field> fields() {
  return {{"x", 0, kFloat32, 1},          {"y", 4, kFloat32, 1},    {"z", 8, kFloat32, 1},
          {"intensity", 12, kFloat32, 1}, {"ring", 16, kUint16, 1}, {"time", 18, kFloat32, 1}};
}

template <typename Number>
void append(std::vector<std::byte>& data, Number number) {
  const auto bytes = std::as_bytes(std::span(&number, 1));
  data.insert(data.end(), bytes.begin(), bytes.end());
}

// The directions and the times of the rays of every turn.
struct Rays {
  std::vector<Vector3d> directions;
  std::vector<float> times_s;

  Rays(const Sensor& sensor, std::uint32_t count) {
    for (std::uint32_t ray = 0; ray < count; ++ray) {
      directions.push_back(sensor.direction(ray));
      times_s.push_back(static_cast<float>(sensor.fired_s(ray)));
    }
  }
};

std::vector<std::byte> points_of(const Recording& cast, std::size_t turn, const Rays& rays,
                                 std::uint32_t rings) {
  std::vector<std::byte> data;
  const std::size_t first = turn * rays.directions.size();
  for (std::size_t ray = 0; ray < rays.directions.size(); ++ray) {
    const float range_m = cast.ranges_m[first + ray];
    if (std::isnan(range_m)) continue;
    const Vector3d p_m = rays.directions[ray] * double{range_m};
    for (const double coordinate_m : p_m) append(data, static_cast<float>(coordinate_m));
    append(data, cast.intensities[first + ray]);
    append(data, static_cast<std::uint16_t>(ray % rings));
    append(data, rays.times_s[ray]);
  }
  return data;
}

RawCloud cloud_of(const Simulation& simulation, const Sensor& sensor, const Rays& rays, std::size_t turn) {
  const double begin_s = sensor.scan(turn).first_beam_s;
  const double known_s = begin_s + double{rays.times_s.back()} + kScanLatency_s;
  const Recording& cast = simulation.recording;
  RawCloud cloud;
  cloud.stamps = {in_ns(cast, begin_s), in_ns(cast, known_s + delay_s(simulation, Arrival::kScan, turn))};
  cloud.frame = "laser";
  cloud.fields = fields();
  cloud.data = points_of(cast, turn, rays, simulation.options.scanner.rings);
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(cloud.data.size() / kPointBytes);
  cloud.point_bytes = kPointBytes;
  cloud.row_bytes = static_cast<std::uint32_t>(cloud.data.size());
  cloud.dense = true;
  return cloud;
}

}  // namespace

RawLaser clouds_of(const Simulation& cast, const Sensor& sensor) {
  const Scanner& scanner = cast.options.scanner;
  const Rays rays(sensor, scanner.rays());
  RawLaser laser;
  laser.topic = "/points";
  laser.of_clouds = true;
  CloudReader reader;
  for (std::size_t turn = 0; turn < cast.recording.ranges_m.size() / scanner.rays(); ++turn) {
    laser.clouds.push_back(cloud_of(cast, sensor, rays, turn));
    const std::string message = message_of(Encoding::kRos1, laser, turn);
    reader.add(Encoding::kRos1, std::as_bytes(std::span(message)), laser.clouds.back().stamps.receive_ns,
               laser);
  }
  return laser;
}

}  // namespace sweepscope::simulation
