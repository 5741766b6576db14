#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/recording/raw_recording.hpp"
#include "core/simulation/simulate.hpp"

namespace sweepscope {

/// The time at which a message reaches the recorder: after the last time that it refers to and after its own
/// stamp.
inline constexpr double kScanLatency_s = 0.0040, kMotorLatency_s = 0.0015;

/// Of which stream.
enum class Arrival : std::uint64_t { kScan = 101, kMotor = 102 };
/// How much later it does. Most messages arrive promptly, few late: an exponential distribution, cut off.
double delay_s(const Simulation& simulation, Arrival what, std::size_t number);

/// A time of a recording, in ns since 1970.
std::int64_t in_ns(const Recording& recording, double time_s);

/// The motor's messages of a simulation.
RawJoint raw_joint(const Simulation& simulation);

/// The messages of a simulation, as its drivers write them: the content of the bag of write_bag, for
/// assemble(). Beams without a usable return are +inf.
RawRecording messages_of(const Simulation& simulation);

/// Writes a simulation as a ROS 1 bag: sensor_msgs/LaserScan on /scan, beams without a usable return as +inf,
/// or of a 3D scanner sensor_msgs/PointCloud2 on /points, and sensor_msgs/JointState on /joint_states with
/// the joint roll_motor. Messages are in the order in which they were received: a few milliseconds late, by a
/// random but repeatable amount. Equal simulations give equal bytes. Written beside the path and then
/// renamed; if that fails, ExitCode::kUnreadableInput.
Result<void> write_bag(const Simulation& simulation, const std::filesystem::path& path, const Job& job);

/// The ground truth of a simulation as JSON: the offset, the walk's figures, and every option.
std::string truth_json(const Simulation& simulation);

/// The base frame's trajectory as TUM: `timestamp tx ty tz qx qy qz qw`, seconds since 1970 on the laser's
/// clock.
std::string truth_tum(const Simulation& simulation);

/// Writes both beside a bag: OUT.truth.json and OUT.truth.tum, where OUT is the bag's path without `.bag`;
/// and OUT.rig.yaml if rig_of says something that is not in the messages.
Result<void> write_truth(const Simulation& simulation, const std::filesystem::path& bag_path);

/// All files of a simulation: the bag and those that write_truth writes.
std::vector<std::filesystem::path> files_of_simulation(const SimulationOptions& options,
                                                       const std::filesystem::path& bag_path);
std::filesystem::path truth_json_path(const std::filesystem::path& bag_path);
std::filesystem::path truth_tum_path(const std::filesystem::path& bag_path);
std::filesystem::path rig_path(const std::filesystem::path& bag_path);

}  // namespace sweepscope
