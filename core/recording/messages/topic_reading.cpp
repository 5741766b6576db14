#include "core/recording/messages/topic_reading.hpp"

#include <fmt/format.h>

#include <utility>

namespace sweepscope {
namespace {

void read_as_motor(const MessageTopic& topic, const Rig& rig, TopicReading& reading) {
  // A joint that the rig names beside a field is the name of that field.
  const auto joint = rig.motor.field ? rig.motor.joint : std::nullopt;
  auto joints = JointReader::by_definition(topic, rig.motor.field, joint);
  if (!joints) {
    reading.problem = joints.error().message;
    return;
  }
  reading.joints = std::move(*joints);
  reading.kind = reading.joints.kind();
}

void read_as_laser(const MessageTopic& topic, const Rig& rig, TopicReading& reading) {
  auto scans = ScanReader::by_definition(topic, rig.laser.field, rig.laser.echo);
  if (!scans) {
    reading.problem = scans.error().message;
    return;
  }
  reading.scans = std::move(*scans);
  reading.kind = reading.scans.kind();
}

/// Whether the rig leaves a topic of that kind to be used.
bool is_wanted(MessageKind kind, const std::string& topic, const Rig& rig) {
  if (kind == MessageKind::kTransforms) return true;
  if (kind == MessageKind::kImu) return rig.imu.topic == topic;
  if (kind == MessageKind::kOdometry) return rig.odometry.topic == topic;
  const auto& named = is_laser(kind) ? rig.laser.topic : rig.motor.topic;
  return !named || *named == topic;
}

}  // namespace

TopicReading reading_of(const MessageTopic& topic, const Rig& rig) {
  TopicReading reading;
  if (!topic.decodable) return reading;
  const MessageType* const type = find_message_type(topic.type);
  const bool motor = rig.motor.topic == topic.name, laser = rig.laser.topic == topic.name;
  if (motor && (rig.motor.field || type == nullptr)) {
    read_as_motor(topic, rig, reading);
    return reading;
  }
  if (laser && (rig.laser.field || type == nullptr)) {
    read_as_laser(topic, rig, reading);
    return reading;
  }
  if (type == nullptr || !is_wanted(type->kind, topic.name, rig)) return reading;
  const bool by_definition = type->kind == MessageKind::kFields;
  const bool described = by_definition && !topic.definition.empty();
  if (!described && topic.md5sum != "*" && topic.md5sum != type->md5) {
    reading.warning = fmt::format("topic {} holds another version of {} (md5sum {}) and is not used",
                                  topic.name, topic.type, topic.md5sum);
    return reading;
  }
  if (by_definition) {
    read_as_motor(topic, rig, reading);
    if (!motor) std::swap(reading.problem, reading.warning);
    return reading;
  }
  reading.kind = type->kind;
  if (is_laser(type->kind))
    reading.scans = ScanReader(type->kind, topic.encoding, rig.laser.echo);
  else
    reading.joints = JointReader(type->kind, topic.encoding);
  return reading;
}

}  // namespace sweepscope
