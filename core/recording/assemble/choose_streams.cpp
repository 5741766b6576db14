#include "core/recording/assemble/choose_streams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/numbers.hpp"
#include "core/recording/assemble/mount_from_frames.hpp"
#include "core/recording/messages/messages.hpp"

namespace sweepscope {
namespace {

constexpr double kMinMotion_deg = 1.0;
constexpr std::size_t kMaxListed = 40;

double turn_deg(const RawJoint& joint, const Rig& rig) {
  return range_of(joint) * std::abs(rig.motor.rad_per_value()) * kDegPerRad;
}

/// An indented line per choice, the first ones where there are many.
std::string list_of(const std::vector<std::string>& lines) {
  std::string list;
  for (std::size_t i = 0; i < lines.size() && i < kMaxListed; ++i) list += "\n    " + lines[i];
  if (lines.size() > kMaxListed) list += fmt::format("\n    and {} more", lines.size() - kMaxListed);
  return list;
}

std::string list_of_topics(const RawRecording& raw, bool lasers_only = false) {
  std::vector<std::string> lines;
  for (const RecordedTopic& topic : raw.topics) {
    const MessageType* const type = find_message_type(topic.type);
    const bool laser = topic.type == "csv/LaserScan" || (type != nullptr && is_laser(type->kind));
    if (lasers_only && !laser) continue;
    lines.push_back(fmt::format("{}   {}   {} messages", topic.name, topic.type, topic.messages));
  }
  return lines.empty() ? " nothing" : list_of(lines);
}

std::string list_of_joints(const RawRecording& raw, const std::vector<std::size_t>& which, const Rig& rig) {
  std::size_t width = 0;
  for (const std::size_t i : which) width = std::max(width, raw.joints[i].joint.size());
  std::vector<std::string> lines;
  for (const std::size_t i : which) {
    const RawJoint& joint = raw.joints[i];
    lines.push_back(fmt::format("{:{}}   turns over {:.1f} deg   {} samples   on {}", joint.joint, width,
                                turn_deg(joint, rig), joint.positions.size() + joint.left_out, joint.topic));
  }
  return list_of(lines);
}

bool all_malformed(const RawRecording& raw, std::string_view type_end) {
  const auto found = std::ranges::find_if(raw.topics, [&](const RecordedTopic& topic) {
    return topic.type.ends_with(type_end) && topic.malformed > 0;
  });
  return found != raw.topics.end();
}

/// What reading met first, which may be why something is not there.
std::string first_warning(const RawRecording& raw) {
  return raw.warnings.empty() ? std::string() : fmt::format("\n  also: {}", raw.warnings.front());
}

/// How to name a topic of a type that is only read where it is named.
std::string advice(const RawRecording& raw, std::string_view stream, std::string_view what,
                   const std::optional<std::string>& of_other_stream) {
  const auto other = std::ranges::find_if(raw.topics, [&](const RecordedTopic& topic) {
    return topic.name != of_other_stream && find_message_type(topic.type) == nullptr &&
           !topic.type.starts_with("csv/");
  });
  if (other == raw.topics.end()) return "";
  return fmt::format(
      "\n  If one of them holds {}, name it in a rig file ({}: {{topic: {}}}, given with --rig).", what,
      stream, other->name);
}

/// Why nothing is there to choose from.
std::string nothing_usable(const RawRecording& raw, std::string_view what, std::string_view type_end,
                           const std::string& advice) {
  if (raw.topics.empty() && raw.warnings.empty())
    return fmt::format("{}: is a whole recording without messages", raw.file);
  if (all_malformed(raw, type_end))
    return fmt::format("{}: all of its {} are malformed", raw.file, what) + first_warning(raw);
  return fmt::format("{}: no {}. Topics found:{}{}", raw.file, what, list_of_topics(raw), advice) +
         first_warning(raw);
}

/// A topic of joint states, all without positions.
const RecordedTopic* without_positions(const RawRecording& raw, const Rig& rig) {
  const auto found = std::ranges::find_if(raw.topics, [&](const RecordedTopic& topic) {
    const MessageType* const type = find_message_type(topic.type);
    return type != nullptr && type->kind == MessageKind::kJointState && topic.messages > topic.malformed &&
           (!rig.motor.topic || *rig.motor.topic == topic.name) &&
           std::ranges::find(raw.joints, topic.name, &RawJoint::topic) == raw.joints.end();
  });
  return found == raw.topics.end() ? nullptr : &*found;
}

/// Why no joint is there to choose from.
std::string no_joint(const RawRecording& raw, const Rig& rig) {
  if (const RecordedTopic* const topic = without_positions(raw, rig))
    return fmt::format(
               "{}: the {} messages on {} ({}) have no positions, which are the motor's angles. Record "
               "them, or name another topic in a rig file (motor: {{topic: ...}}, given with --rig). "
               "Topics found:{}",
               raw.file, topic->messages, topic->name, topic->type, list_of_topics(raw)) +
           first_warning(raw);
  if (rig.motor.topic)
    return fmt::format("{}: no angles on {}, the rig's motor.topic. Topics found:{}", raw.file,
                       *rig.motor.topic, list_of_topics(raw)) +
           first_warning(raw);
  return nothing_usable(raw, "sensor_msgs/JointState", "/JointState",
                        advice(raw, "motor", "the motor's angle", rig.laser.topic)) +
         "\n  If nothing measures it, state how the motor is driven in a rig file (motor: {profile: ...}).";
}

bool wanted(const RawJoint& joint, const Rig& rig) {
  if (rig.motor.topic && *rig.motor.topic != joint.topic) return false;
  if (rig.motor.joint && *rig.motor.joint != joint.joint) return false;
  return !joint.positions.empty();
}

/// Leaves out all but those of the first source in the order of JointSource.
void keep_best_source(const RawRecording& raw, std::vector<std::size_t>& joints) {
  JointSource best = JointSource::kTransform;
  for (const std::size_t i : joints) best = std::min(best, raw.joints[i].source);
  std::erase_if(joints, [&](std::size_t i) { return raw.joints[i].source != best; });
}

/// Of several joints that move, the one that turns as far as the frame that turns the scanner, if only one
/// does.
void keep_turning_frame(const RawRecording& raw, const Rig& rig, std::vector<std::size_t>& moving) {
  constexpr double kNearly =
      1.1;  // the frame's turn is the farthest from its first pose, at most the joint's range
  const auto laser = choose_laser(raw, rig);
  const auto mount = laser ? mount_from_frames(raw.frames, raw.lasers[*laser].frame) : std::nullopt;
  if (!mount || !mount->turning) return;
  const double frame_deg = mount->turning->turned_rad * kDegPerRad;
  std::vector<std::size_t> alike;
  std::ranges::copy_if(moving, std::back_inserter(alike), [&](std::size_t i) {
    const double joint_deg = turn_deg(raw.joints[i], rig);
    return joint_deg * kNearly > frame_deg && joint_deg < 2 * kNearly * frame_deg;
  });
  if (alike.size() == 1) moving = alike;
}

}  // namespace

Result<std::size_t> choose_laser(const RawRecording& raw, const Rig& rig) {
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < raw.lasers.size(); ++i) {
    const RawLaser& laser = raw.lasers[i];
    if (rig.laser.topic && *rig.laser.topic != laser.topic) continue;
    if (!laser.scans.empty()) usable.push_back(i);
  }
  // Where nothing is named, a scanner's own scans go before those of several echoes, which hold the same, and
  // before clouds, which may be made of anything.
  const auto rank = [&](std::size_t i) {
    return raw.lasers[i].of_clouds ? 2 : raw.lasers[i].of_echoes ? 1 : 0;
  };
  int first = 2;
  for (const std::size_t i : usable) first = std::min(first, rank(i));
  std::erase_if(usable, [&](std::size_t i) { return rank(i) != first; });
  if (usable.size() > 1) {
    std::vector<std::size_t> on_motor;
    std::ranges::copy_if(usable, std::back_inserter(on_motor), [&](std::size_t i) {
      const auto mount = mount_from_frames(raw.frames, raw.lasers[i].frame);
      return mount && mount->turning;
    });
    if (on_motor.size() == 1) return on_motor.front();
  }
  if (usable.size() == 1) return usable.front();
  if (usable.size() > 1) {
    return unreadable(fmt::format(
        "{}: {} topics of scans, and it is ambiguous which to use; name one in a rig file (laser: {{topic: "
        "{}}}, given with --rig):{}",
        raw.file, usable.size(), raw.lasers[usable.front()].topic, list_of_topics(raw, true)));
  }
  const std::string any = list_of_topics(raw, true);
  if (rig.laser.topic && any != " nothing") {
    return unreadable(
        fmt::format("{}: no usable scans on {}, the rig's laser.topic. Topics of scans found:{}", raw.file,
                    *rig.laser.topic, any) +
        first_warning(raw));
  }
  for (const RawLaser& laser : raw.lasers) {
    if (!laser.of_clouds || !raw.warnings.empty()) continue;
    return unreadable(fmt::format("{}: no cloud on {} has a line of points with positions and times",
                                  raw.file, laser.topic));
  }
  const auto clouds = std::ranges::find_if(raw.topics, [](const RecordedTopic& topic) {
    const MessageType* const type = find_message_type(topic.type);
    return type != nullptr && is_cloud(type->kind) && topic.messages > 0 && topic.malformed == topic.messages;
  });
  if (clouds != raw.topics.end() && !raw.warnings.empty())
    return unreadable(fmt::format("{}: no usable scans: {}", raw.file, raw.warnings.front()));
  return unreadable(nothing_usable(raw, "sensor_msgs/LaserScan", "LaserScan",
                                   advice(raw, "laser", "the scans", rig.motor.topic)));
}

Result<std::size_t> choose_joint(const RawRecording& raw, const Rig& rig) {
  std::vector<std::size_t> all, usable, moving;
  for (std::size_t i = 0; i < raw.joints.size(); ++i) {
    all.push_back(i);
    if (wanted(raw.joints[i], rig)) usable.push_back(i);
  }
  if (!rig.motor.topic) keep_best_source(raw, usable);
  for (const std::size_t i : usable)
    if (turn_deg(raw.joints[i], rig) > kMinMotion_deg) moving.push_back(i);
  if (moving.size() > 1) keep_turning_frame(raw, rig, moving);
  if (moving.size() == 1) return moving.front();
  if (moving.empty() && usable.size() == 1) return usable.front();
  if (!usable.empty()) {
    const auto& choices = moving.empty() ? usable : moving;
    return unreadable(
        fmt::format("{}: {} of {} joints move, and it is ambiguous which of them turns the scanner; name it "
                    "in a rig file (motor: {{topic: {}, joint: {}}}, given with --rig):{}",
                    raw.file, moving.size(), usable.size(), raw.joints[choices.front()].topic,
                    raw.joints[choices.front()].joint, list_of_joints(raw, choices, rig)));
  }
  if (!all.empty()) {
    return unreadable(
        fmt::format("{}: no positions of joint {} on topic {}, which the rig names. Joints found:{}",
                    raw.file, rig.motor.joint.value_or("(any)"), rig.motor.topic.value_or("(any)"),
                    list_of_joints(raw, all, rig)) +
        first_warning(raw));
  }
  return unreadable(no_joint(raw, rig));
}

void warn_of_frames(const RawLaser& laser, Recording& recording) {
  if (laser.other_frames.empty()) return;
  recording.report.warnings.push_back(fmt::format(
      "scans on {} have {} frame_ids, {} and {}: all are used as of one scanner; if there are two, "
      "the answer is of neither",
      laser.topic, laser.other_frames.size() + 1, laser.frame, fmt::join(laser.other_frames, ", ")));
}

}  // namespace sweepscope
