#include "core/recording/ros1_recording.hpp"

#include <fmt/format.h>

#include <map>

#include "core/recording/ros1_bag.hpp"
#include "core/recording/ros1_messages.hpp"

namespace sweepscope {
namespace {

// What is kept of one file, so that a small file of highly compressed messages cannot fill the memory.
constexpr std::size_t kMostBeams = std::size_t{1} << 29;
constexpr std::size_t kMostJointSamples = std::size_t{1} << 27;

/// Sorts the messages of a bag into lasers and joints.
class Collector {
 public:
  Collector(const Rig& rig, RawRecording& raw) : rig_(rig), raw_(raw) {}

  std::optional<Error> visit(const BagMessage& message);
  void finish();

 private:
  enum class Kind { kOther, kLaser, kJoints };
  struct Topic {
    std::size_t index;  // in RawRecording::topics
    Kind kind;
    std::size_t laser = 0;  // in RawRecording::lasers
    std::map<std::string, std::size_t, std::less<>> joints;
    std::string first_malformed;  // the place
  };

  Topic& topic_of(const BagConnection& connection);
  Kind kind_of(const BagConnection& connection);
  bool add_scan(const BagMessage& message, RawLaser& laser);
  bool add_joints(const BagMessage& message, Topic& topic);
  RawJoint& joint_of(Topic& topic, const std::string& topic_name, std::string_view joint);

  const Rig& rig_;
  RawRecording& raw_;
  std::map<std::pair<std::string, std::string>, Topic> topics_;  // by name and type
  Ros1JointState state_;
  std::size_t beams_ = 0, joint_samples_ = 0;
};

Collector::Kind Collector::kind_of(const BagConnection& connection) {
  const bool laser = connection.type == kLaserScanType;
  if (!laser && connection.type != kJointStateType) return Kind::kOther;
  if (connection.md5sum != "*" && connection.md5sum != (laser ? kLaserScanMd5 : kJointStateMd5)) {
    raw_.warnings.push_back(
        fmt::format("{}: topic {} holds another version of {} (md5sum {}) and is not used", raw_.name,
                    connection.topic, connection.type, connection.md5sum));
    return Kind::kOther;
  }
  const auto& wanted = laser ? rig_.laser.topic : rig_.motor.topic;
  if (wanted && *wanted != connection.topic) return Kind::kOther;
  return laser ? Kind::kLaser : Kind::kJoints;
}

Collector::Topic& Collector::topic_of(const BagConnection& connection) {
  const auto [found, is_new] = topics_.try_emplace({connection.topic, connection.type});
  Topic& topic = found->second;
  if (is_new) {
    topic.index = raw_.topics.size();
    topic.kind = kind_of(connection);
    topic.laser = raw_.lasers.size();
    raw_.topics.push_back({connection.topic, connection.type});
    if (topic.kind == Kind::kLaser) raw_.lasers.emplace_back().topic = connection.topic;
  }
  return topic;
}

std::optional<Error> Collector::visit(const BagMessage& message) {
  Topic& topic = topic_of(message.connection);
  ++raw_.topics[topic.index].messages;
  bool whole = true;
  if (topic.kind == Kind::kLaser) whole = add_scan(message, raw_.lasers[topic.laser]);
  if (topic.kind == Kind::kJoints) whole = add_joints(message, topic);
  if (!whole && raw_.topics[topic.index].malformed++ == 0) topic.first_malformed = message.place.text();
  if (beams_ <= kMostBeams && joint_samples_ <= kMostJointSamples) return std::nullopt;
  return Error{
      ExitCode::kUnreadableInput,
      fmt::format(
          "{}: holds more than {} {}, more than are read at once; cut it into parts with `rosbag filter`, "
          "or name the topic{} in a rig file",
          raw_.file, beams_ > kMostBeams ? kMostBeams : kMostJointSamples,
          beams_ > kMostBeams ? "beams" : "joint samples", beams_ > kMostBeams ? "" : " and joint")};
}

bool Collector::add_scan(const BagMessage& message, RawLaser& laser) {
  const auto decoded = decode_laser_scan(message.bytes);
  if (!decoded) return false;
  RawScan scan;
  scan.stamps = {decoded->header_ns, message.receive_ns};
  scan.angle_min_rad = decoded->angle_min_rad;
  scan.angle_increment_rad = decoded->angle_increment_rad;
  scan.time_increment_s = decoded->time_increment_s;
  scan.scan_time_s = decoded->scan_time_s;
  scan.range_min_m = decoded->range_min_m;
  scan.range_max_m = decoded->range_max_m;
  scan.first_range = laser.ranges_m.size();
  scan.beams = static_cast<std::uint32_t>(decoded->ranges_m.size());
  decoded->ranges_m.append_to(laser.ranges_m);
  laser.has_intensities = laser.has_intensities && decoded->intensities.size() == scan.beams;
  if (laser.has_intensities)
    decoded->intensities.append_to(laser.intensities);
  else
    std::vector<float>().swap(laser.intensities);
  laser.scans.push_back(scan);
  beams_ += scan.beams;
  return true;
}

bool Collector::add_joints(const BagMessage& message, Topic& topic) {
  if (!decode_joint_state(message.bytes, state_)) return false;
  for (std::size_t i = 0; i < state_.positions.size(); ++i) {
    if (rig_.motor.joint && state_.names[i] != *rig_.motor.joint) {
      joint_of(topic, message.connection.topic, state_.names[i]);  // known by name, for a list of choices
      continue;
    }
    RawJoint& joint = joint_of(topic, message.connection.topic, state_.names[i]);
    joint.stamps.push_back({state_.header_ns, message.receive_ns});
    joint.positions.push_back(state_.positions[i]);
    ++joint_samples_;
  }
  return true;
}

RawJoint& Collector::joint_of(Topic& topic, const std::string& topic_name, std::string_view joint) {
  auto found = topic.joints.find(joint);
  if (found == topic.joints.end()) {
    found = topic.joints.emplace(joint, raw_.joints.size()).first;
    RawJoint& added = raw_.joints.emplace_back();
    added.topic = topic_name;
    added.joint = joint;
  }
  return raw_.joints[found->second];
}

void Collector::finish() {
  for (const auto& [key, topic] : topics_) {
    const std::size_t malformed = raw_.topics[topic.index].malformed;
    if (malformed == 0) continue;
    raw_.warnings.push_back(
        fmt::format("{} of {} messages on {} are malformed and were skipped, the first at {}", malformed,
                    raw_.topics[topic.index].messages, key.first, topic.first_malformed));
  }
}

}  // namespace

Result<RawRecording> read_ros1_recording(const std::filesystem::path& path, const Rig& rig, const Job& job) {
  RawRecording raw;
  raw.file = path.string();
  raw.name = path.filename().string();
  Collector collector(rig, raw);
  auto damage = read_ros1_bag(
      path, [&](const BagMessage& message) { return collector.visit(message); }, job);
  if (!damage) return tl::unexpected(std::move(damage.error()));
  collector.finish();
  raw.warnings.insert(raw.warnings.begin(), damage->begin(), damage->end());
  return raw;
}

}  // namespace sweepscope
