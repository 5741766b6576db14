#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/recording/messages/message_layout.hpp"
#include "core/recording/messages/message_topic.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// Reads the joints of a topic's messages: sensor_msgs/JointState, transforms, or any other type by its
/// definition.
class JointReader {
 public:
  /// Reads kJointState and kTransforms.
  explicit JointReader(MessageKind kind = MessageKind::kJointState, Encoding encoding = Encoding::kRos1);
  /// Reads a number of any type: `field`, else what is usual for the type, else its only number. A rotation
  /// (geometry_msgs/Quaternion) is one number, its angle about the axis. An array gives a joint per element.
  /// `joint` is the name of a joint that has none, by default the field's. The error is a sentence about the
  /// topic; where several numbers are possible it lists them.
  static Result<JointReader> by_definition(const MessageTopic& topic, const std::optional<std::string>& field,
                                           const std::optional<std::string>& joint);

  MessageKind kind() const { return kind_; }
  JointSource source() const { return source_; }
  /// Fills `joints`, whose memory is reused; false if the message is malformed. Names are views of the
  /// message or of this reader. See decode_joints().
  bool read(std::span<const std::byte> message, const Eigen::Vector3d& axis,
            std::vector<DecodedJoint>& joints);

 private:
  Result<void> choose(const MessageTopic& topic, const std::optional<std::string>& field);
  Result<void> set_values(const MessageTopic& topic, const std::string& field);
  std::string_view name_of(std::size_t i);

  MessageKind kind_;
  JointSource source_;
  Encoding encoding_;
  MessageLayout layout_;
  MessageLayout::Path values_;
  std::optional<MessageLayout::Path> names_;
  bool rotation_ = false, one_ = false;
  std::string field_;                   // the name of values_
  std::vector<std::string> own_names_;  // of joints without a name in the message
  MessageLayout::Found found_, found_names_;
};

}  // namespace sweepscope
