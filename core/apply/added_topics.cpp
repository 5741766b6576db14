#include "core/apply/added_topics.hpp"

#include <cmath>

#include "core/apply/added_messages.hpp"
#include "core/io/trajectory_file.hpp"

namespace sweepscope {
namespace {

std::int64_t ns_of(const Recording& recording, double time_s) {
  return recording.epoch_ns + std::llround(time_s * 1e9);
}

/// The recording, what was prepared from it, and its sweeps: they point to each other.
struct Sweeps {
  Recording recording;
  PreparedRecording prepared;
  std::unique_ptr<SweepClouds> clouds;
};

Result<std::shared_ptr<const Sweeps>> sweeps_of(Recording recording, const MapOptions& options,
                                                const Job& job) {
  auto sweeps = std::make_shared<Sweeps>();
  sweeps->recording = std::move(recording);
  auto prepared = prepare(sweeps->recording, options.features, job);
  if (!prepared) return tl::unexpected(prepared.error());
  sweeps->prepared = std::move(*prepared);
  auto clouds = SweepClouds::create(sweeps->prepared, 0, options, job);
  if (!clouds) return tl::unexpected(clouds.error());
  sweeps->clouds = std::make_unique<SweepClouds>(std::move(*clouds));
  return sweeps;
}

AddedTopic added_clouds(const std::shared_ptr<const Sweeps>& sweeps, const AddOptions& options,
                        Encoding encoding, const StampMap& stamped) {
  AddedTopic added;
  added.topic = written_topic(options.clouds_topic, "sensor_msgs/PointCloud2", encoding);
  for (std::size_t i = 0; i < sweeps->clouds->size(); ++i)
    added.ready_ns.push_back(ns_of(sweeps->recording, sweeps->clouds->end_s(i)));
  added.message = [sweeps, encoding, stamped, frame = options.base_frame](std::size_t i) {
    const SweepCloud cloud = sweeps->clouds->at(i);
    return cloud_message(encoding, stamped(ns_of(sweeps->recording, cloud.begin_s)), frame, cloud.points,
                         cloud.begin_s);
  };
  return added;
}

AddedTopic added_transforms(const Recording& recording, const AddOptions& options, Encoding encoding,
                            const std::string& laser_frame, const StampMap& stamped) {
  AddedTopic added;
  added.topic = written_topic("/tf", "tf2_msgs/TFMessage", encoding);
  for (const double time_s : recording.motor.time_s) added.ready_ns.push_back(ns_of(recording, time_s));
  const Mount mount = recording.rig.mount;
  added.message = [=, times_ns = added.ready_ns, angles_rad = recording.motor.angle_rad,
                   base_frame = options.base_frame](std::size_t i) {
    return transform_message(encoding, stamped(times_ns[i]), base_frame, laser_frame,
                             base_from_laser(mount, angles_rad[i]));
  };
  return added;
}

}  // namespace

Result<MapOptions> map_options(const AddOptions& options, const Recording& recording) {
  MapOptions map = options.map;
  if (!options.poses) return map;
  return read_tum(*options.poses, recording.epoch_ns).map([&](std::vector<StampedPose>&& poses) {
    map.poses = std::move(poses);
    return std::move(map);
  });
}

Recording without_offset(Recording recording, const ClockShift& clocks) {
  MotorTrack motor;
  for (std::size_t i = 0; i < recording.motor.time_s.size(); ++i) {
    const std::int64_t ns = clocks.laser_ns(ns_of(recording, recording.motor.time_s[i]));
    const double time_s = static_cast<double>(ns - recording.epoch_ns) * 1e-9;
    if (!motor.time_s.empty() && time_s <= motor.time_s.back()) continue;  // beside a jump of the offset
    motor.time_s.push_back(time_s);
    motor.angle_rad.push_back(recording.motor.angle_rad[i]);
  }
  recording.motor = std::move(motor);
  return recording;
}

Result<AddedTopics> add_topics(Recording recording, const AddOptions& options, Encoding encoding,
                               const std::string& laser_frame, const StampMap& stamped, const Job& job) {
  AddedTopics added;
  if (options.transforms)
    added.topics.push_back(added_transforms(recording, options, encoding, laser_frame, stamped));
  if (options.clouds_topic.empty()) return added;
  const auto map = map_options(options, recording);
  if (!map) return tl::unexpected(map.error());
  const auto sweeps = sweeps_of(std::move(recording), *map, job);
  if (!sweeps) return tl::unexpected(sweeps.error());
  const SweepClouds& clouds = *(*sweeps)->clouds;
  if (!clouds.warning().empty()) added.warnings.push_back(clouds.warning());
  if (clouds.lost()) added.warnings.push_back("the motion could not be followed: do not trust the clouds");
  added.topics.push_back(added_clouds(*sweeps, options, encoding, stamped));
  return added;
}

std::optional<Error> AddedStreams::write_until(std::int64_t laser_ns, std::int64_t log_ns,
                                               const Write& write) {
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    const AddedTopic& added = topics_[i];
    for (std::size_t& next = written_[i]; next < added.ready_ns.size() && added.ready_ns[next] <= laser_ns;
         ++next) {
      const std::string bytes = added.message(next);
      if (auto error =
              write(added.topic, static_cast<std::uint32_t>(next), log_ns, std::as_bytes(std::span(bytes))))
        return error;
    }
  }
  return std::nullopt;
}

}  // namespace sweepscope
