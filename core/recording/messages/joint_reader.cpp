#include "core/recording/messages/joint_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/recording/messages/message_archives.hpp"

namespace sweepscope {
namespace {

constexpr std::string_view kRotation = "geometry_msgs/Quaternion";

/// The fields of joints that are usual for a type; the first row whose fields a definition has is used.
struct UsualFields {
  std::string_view type, names, values;
  JointSource source;
};
constexpr UsualFields kUsualFields[] = {
    {"dynamixel_msgs/JointState", "name", "current_pos", JointSource::kJointState},
    {"control_msgs/JointControllerState", "", "process_value", JointSource::kController},
    {"pr2_controllers_msgs/JointControllerState", "", "process_value", JointSource::kController},
    {"control_msgs/JointTrajectoryControllerState", "joint_names", "actual.positions",
     JointSource::kController},
    {"control_msgs/JointTrajectoryControllerState", "joint_names", "feedback.positions",
     JointSource::kController},
    {"dynamixel_workbench_msgs/DynamixelStateList", "dynamixel_state.name",
     "dynamixel_state.present_position", JointSource::kNumber},
    {"geometry_msgs/QuaternionStamped", "", "quaternion", JointSource::kTransform},
    {"geometry_msgs/PoseStamped", "", "pose.orientation", JointSource::kTransform},
};

std::string of_topic(const MessageTopic& topic) {
  return fmt::format("topic {} ({})", topic.name, topic.type);
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMaxListed = 40;
  const std::size_t shown = std::min(names.size(), kMaxListed);
  return fmt::format("{}{}", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(shown), ", "),
                     shown < names.size() ? ", ..." : "");
}

}  // namespace

JointReader::JointReader(MessageKind kind, Encoding encoding)
    : kind_(kind),
      source_(kind == MessageKind::kTransforms ? JointSource::kTransform : JointSource::kJointState),
      encoding_(encoding) {}

Result<JointReader> JointReader::by_definition(const MessageTopic& topic,
                                               const std::optional<std::string>& field,
                                               const std::optional<std::string>& joint) {
  auto layout = MessageLayout::parse(topic);
  if (!layout) return tl::unexpected(layout.error());
  JointReader reader(MessageKind::kFields, topic.encoding);
  reader.source_ = JointSource::kNumber;
  reader.layout_ = std::move(*layout);
  if (!reader.layout_.has_header()) reader.kind_ = MessageKind::kFieldsWithoutHeader;
  if (auto chosen = reader.choose(topic, field); !chosen) return tl::unexpected(chosen.error());
  if (reader.one_) reader.own_names_ = {joint.value_or(reader.field_)};
  return reader;
}

Result<void> JointReader::choose(const MessageTopic& topic, const std::optional<std::string>& field) {
  if (field) return set_values(topic, *field);
  const std::string type = short_type_name(topic.type);
  for (const UsualFields& usual : kUsualFields) {
    if (usual.type != type || !layout_.find(usual.values)) continue;
    if (!usual.names.empty()) names_ = layout_.find(usual.names);
    source_ = usual.source;
    return set_values(topic, std::string(usual.values));
  }
  const std::vector<std::string> numbers = layout_.numbers();
  if (numbers.empty()) return unreadable(fmt::format("{} holds no numbers", of_topic(topic)));
  const bool array = type.starts_with("std_msgs/") && type.ends_with("MultiArray");
  if (array) return set_values(topic, "data");
  if (numbers.size() == 1 && !numbers.front().ends_with(']')) return set_values(topic, numbers.front());
  const auto likely = std::ranges::find_if(
      numbers, [](const std::string& name) { return name.find("position") != std::string::npos; });
  return unreadable(fmt::format(
      "{} has several numbers. Name one in a rig file (motor: {{topic: {}, field: {}}}, given "
      "with --rig). Its numbers: {}",
      of_topic(topic), topic.name, likely == numbers.end() ? numbers.front() : *likely, listed(numbers)));
}

Result<void> JointReader::set_values(const MessageTopic& topic, const std::string& field) {
  const auto path = layout_.find(field);
  const bool rotation = path && layout_.is_message(*path, kRotation);
  if (!path || (!rotation && !layout_.is_number(*path)))
    return unreadable(fmt::format("{} has no number \"{}\", the rig's motor.field. Its numbers: {}",
                                  of_topic(topic), field, listed(layout_.numbers())));
  values_ = *path;
  rotation_ = rotation;
  field_ = field;
  one_ = !names_ && layout_.is_single(*path);
  if (rotation && !one_)
    return unreadable(fmt::format("{}: {}, the rig's motor.field, is an array of rotations; name one: {}[0]",
                                  of_topic(topic), field, field));
  return {};
}

/// Of a joint without a name in the message: "data[3]".
std::string_view JointReader::name_of(std::size_t i) {
  if (one_) return own_names_.front();
  while (own_names_.size() <= i) own_names_.push_back(fmt::format("{}[{}]", field_, own_names_.size()));
  return own_names_[i];
}

bool JointReader::read(std::span<const std::byte> message, const Eigen::Vector3d& axis,
                       std::vector<DecodedJoint>& joints) {
  constexpr std::size_t kMaxJoints = 4096;
  if (kind_ == MessageKind::kJointState || kind_ == MessageKind::kTransforms)
    return decode_joints(kind_, encoding_, message, axis, joints);
  joints.clear();
  if (!layout_.read(message, values_, found_)) return false;
  std::vector<double>& numbers = found_.numbers;
  if (rotation_) numbers = {angle_about(axis, {numbers[0], numbers[1], numbers[2]}, numbers[3])};
  if (numbers.size() > kMaxJoints) return false;
  if (names_ &&
      (!layout_.read(message, *names_, found_names_) || found_names_.texts.size() != numbers.size()))
    return false;
  std::int64_t header_ns = 0;
  if (std::string_view frame; kind_ == MessageKind::kFields)
    MessageReader(encoding_, message).header(header_ns, frame);
  if (!names_ && !numbers.empty()) name_of(numbers.size() - 1);  // before views of the names are given
  for (std::size_t i = 0; i < numbers.size(); ++i)
    joints.push_back({header_ns, names_ ? found_names_.texts[i] : name_of(i), numbers[i]});
  return true;
}

}  // namespace sweepscope
