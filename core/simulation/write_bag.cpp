#include "core/simulation/write_bag.hpp"

#include <fmt/format.h>
#include <rosbag/bag.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <system_error>
#include <vector>

#include "core/io/unfinished_files.hpp"
#include "core/simulation/portable_math.hpp"
#include "core/simulation/sensor.hpp"

namespace sweepscope {
namespace {

using simulation::Random;
using simulation::Sensor;

enum Purpose : std::uint64_t { kScanArrival = 101, kMotorArrival = 102 };

/// ROS's headers ask their allocator for rebind, which C++20's standard allocator no longer has.
template <typename T>
struct MessageAllocator : std::allocator<T> {
  MessageAllocator() = default;
  template <typename U>
  MessageAllocator(const MessageAllocator<U>&) {}
  template <typename U>
  struct rebind {
    using other = MessageAllocator<U>;
  };
};
using LaserScanMessage = sensor_msgs::LaserScan_<MessageAllocator<void>>;
using JointStateMessage = sensor_msgs::JointState_<MessageAllocator<void>>;

/// A message to be written: the number of its scan or motor sample, and when it arrives.
struct Arrival {
  std::int64_t receive_ns = 0;
  bool is_scan = false;
  std::size_t number = 0;
};

/// Most messages arrive promptly, few late: an exponential distribution, cut off.
double delay_s(const Simulation& simulation, Purpose purpose, std::size_t number) {
  constexpr double kMean_s = 0.0003, kMost_s = 0.003;
  const double u = Random(simulation.options.seed, purpose, number).uniform();
  return std::min(-kMean_s * simulation::natural_log(1 - u), kMost_s);
}

std::int64_t in_ns(const Recording& recording, double time_s) {
  return recording.epoch_ns + static_cast<std::int64_t>(std::floor(time_s * 1e9 + 0.5));
}

ros::Time ros_time(std::int64_t ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  return {static_cast<std::uint32_t>(ns / kSecond_ns), static_cast<std::uint32_t>(ns % kSecond_ns)};
}

std::vector<Arrival> arrivals(const Simulation& simulation) {
  const Recording& recording = simulation.recording;
  std::vector<Arrival> all;
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    const double known_s = recording.scans[i].last_beam_s() + kScanLatency_s;
    all.push_back({in_ns(recording, known_s + delay_s(simulation, kScanArrival, i)), true, i});
  }
  for (std::size_t i = 0; i < recording.motor.time_s.size(); ++i) {
    // Where the motor's clock is behind the laser's, its stamp is older than the instant it is about.
    const double known_s =
        recording.motor.time_s[i] + std::max(0.0, -simulation.options.offset_s) + kMotorLatency_s;
    all.push_back({in_ns(recording, known_s + delay_s(simulation, kMotorArrival, i)), false, i});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Arrival& l, const Arrival& r) { return l.receive_ns < r.receive_ns; });
  return all;
}

LaserScanMessage scan_message(const Recording& recording, std::size_t number) {
  const LaserScan& scan = recording.scans[number];
  LaserScanMessage message;
  message.header.seq = static_cast<std::uint32_t>(number);
  message.header.stamp = ros_time(in_ns(recording, scan.first_beam_s));
  message.header.frame_id = "laser";
  message.angle_min = static_cast<float>(scan.angle_min_rad);
  message.angle_increment = static_cast<float>(scan.angle_increment_rad);
  message.angle_max = static_cast<float>(scan.beam_angle_rad(scan.beams - 1.0));
  message.time_increment = static_cast<float>(scan.time_increment_s);
  message.scan_time = static_cast<float>(Sensor::kScanPeriod_s);
  message.range_min = static_cast<float>(Sensor::kRangeMin_m);
  message.range_max = static_cast<float>(Sensor::kRangeMax_m);
  for (const float range_m : recording.ranges(scan))
    message.ranges.push_back(std::isnan(range_m) ? std::numeric_limits<float>::infinity() : range_m);
  const auto first = recording.intensities.begin() + static_cast<std::ptrdiff_t>(scan.first_range);
  message.intensities.assign(first, first + scan.beams);
  return message;
}

JointStateMessage motor_message(const Recording& recording, std::size_t number) {
  JointStateMessage message;
  message.header.seq = static_cast<std::uint32_t>(number);
  message.header.stamp = ros_time(in_ns(recording, recording.motor.time_s[number]));
  message.name = {"roll_motor"};
  message.position = {recording.motor.angle_rad[number]};
  message.velocity = {0.0};  // as many drivers leave it
  message.effort = {0.0};
  return message;
}

/// False where the job was cancelled. Throws what rosbag throws.
bool write_messages(const Simulation& simulation, const std::filesystem::path& path, const Job& job) {
  rosbag::Bag bag(path.string(), rosbag::bagmode::Write);
  const std::vector<Arrival> all = arrivals(simulation);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (job.cancelled()) return false;
    const ros::Time received = ros_time(all[i].receive_ns);
    if (all[i].is_scan)
      bag.write("/scan", received, scan_message(simulation.recording, all[i].number));
    else
      bag.write("/joint_states", received, motor_message(simulation.recording, all[i].number));
    if (i % 512 == 0) job.report("writing", static_cast<double>(i) / static_cast<double>(all.size()));
  }
  bag.close();
  return true;
}

}  // namespace

Result<void> write_bag(const Simulation& simulation, const std::filesystem::path& path, const Job& job) {
  const std::filesystem::path part = path.string() + ".part";
  remember_unfinished(part);
  std::error_code ignored;
  errno = 0;
  try {
    if (!write_messages(simulation, part, job)) {
      std::filesystem::remove(part, ignored);
      forget_unfinished(part);
      return failure(ExitCode::kInterrupted, "interrupted");
    }
    std::filesystem::rename(part, path);
    forget_unfinished(part);
  } catch (const std::exception& error) {
    const std::string reason = errno != 0 ? std::strerror(errno) : error.what();
    std::filesystem::remove(part, ignored);
    forget_unfinished(part);
    return failure(ExitCode::kWrongUsage, fmt::format("{}: cannot be written: {}", path.string(), reason));
  }
  return {};
}

}  // namespace sweepscope
