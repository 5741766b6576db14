#pragma once

#include <optional>
#include <string>

#include "core/recording/messages/joint_reader.hpp"
#include "core/recording/messages/message_topic.hpp"
#include "core/recording/messages/scan_reader.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

/// How the messages of a topic are read with a rig.
struct TopicReading {
  std::optional<MessageKind> kind;  // empty: they are only counted
  JointReader joints;               // of a motor
  ScanReader scans;                 // of a laser whose messages are scans
  std::string warning;              // why a topic that looks right is not used; empty: nothing is wrong
  /// A sentence where the rig names the topic, and its messages cannot be read; else empty.
  std::string problem;
};

/// Topics of types that are a laser's or a motor's are read if the rig does not exclude them; those of all
/// other types if the rig names them. Transforms are always read.
TopicReading reading_of(const MessageTopic& topic, const Rig& rig);

}  // namespace sweepscope
