#pragma once

#include <optional>
#include <string>

#include "core/recording/rig.hpp"

namespace sweepscope {

/// The streams of a recording by name, where they are ambiguous. Empty members are the rig file's, or
/// detected.
struct StreamNames {
  std::optional<std::string> laser;  // a topic of scans or clouds
  std::optional<std::string> motor;  // a topic of joint states, numbers or transforms
  std::optional<std::string> joint;

  bool any() const { return laser || motor || joint; }
  bool operator==(const StreamNames&) const = default;
};

/// The rig with these streams instead of its own. A joint without a topic is searched for on all topics.
inline Rig with_streams(Rig rig, const StreamNames& names) {
  // A field is one of its topic.
  if (names.laser && rig.laser.topic && rig.laser.topic != names.laser) rig.laser.field.reset();
  if (names.motor && rig.motor.topic && rig.motor.topic != names.motor) rig.motor.field.reset();
  if (names.laser) rig.laser.topic = names.laser;
  if (names.joint && !rig.motor.field) rig.motor.topic.reset();
  if (names.motor) rig.motor.topic = names.motor;
  if (names.motor && !names.joint) rig.motor.joint.reset();
  if (names.joint) rig.motor.joint = names.joint;
  return rig;
}

}  // namespace sweepscope
