#include "core/recording/assemble/choose_streams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/numbers.hpp"
#include "core/recording/messages/messages.hpp"

namespace sweepscope {
namespace {

constexpr double kMinMotion_deg = 1.0;
constexpr std::size_t kMaxListed = 40;

double turn_deg(const RawJoint& joint, const Rig& rig) {
  return range_of(joint) * std::abs(rig.motor.scale) * kDegPerRad;
}

/// An indented line per choice, the first ones where there are many.
std::string list_of(const std::vector<std::string>& lines) {
  std::string list;
  for (std::size_t i = 0; i < lines.size() && i < kMaxListed; ++i) list += "\n    " + lines[i];
  if (lines.size() > kMaxListed) list += fmt::format("\n    and {} more", lines.size() - kMaxListed);
  return list;
}

std::string list_of_topics(const RawRecording& raw, std::string_view type_end) {
  std::vector<std::string> lines;
  for (const RecordedTopic& topic : raw.topics) {
    const MessageType* const type = find_message_type(topic.type);
    const bool cloud = type_end == "/LaserScan" && type != nullptr && is_cloud(type->kind);
    if (!topic.type.ends_with(type_end) && !cloud) continue;
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

std::size_t malformed_messages(const RawRecording& raw, std::string_view type_end) {
  std::size_t malformed = 0;
  for (const RecordedTopic& topic : raw.topics)
    malformed += topic.type.ends_with(type_end) ? topic.malformed : 0;
  return malformed;
}

/// What reading met first, which may be why something is not there.
std::string first_warning(const RawRecording& raw) {
  return raw.warnings.empty() ? std::string() : fmt::format("\n  also: {}", raw.warnings.front());
}

/// Why nothing is there to choose from: the damage that was met comes first.
std::string nothing_usable(const RawRecording& raw, std::string_view what, std::string_view type_end) {
  if (!raw.warnings.empty()) {
    return fmt::format("{}: nothing in it can be used: {}", raw.file, raw.warnings.front());
  }
  if (malformed_messages(raw, type_end) > 0)
    return fmt::format("{}: all of its {} are malformed", raw.file, what);
  return fmt::format("{}: no {}. Topics found:{}", raw.file, what, list_of_topics(raw, ""));
}

bool wanted(const RawJoint& joint, const Rig& rig) {
  if (rig.motor.topic && *rig.motor.topic != joint.topic) return false;
  if (rig.motor.joint && *rig.motor.joint != joint.joint) return false;
  return !joint.positions.empty();
}

/// Leaves out numbers where there are joint states, and transforms where there is either.
void keep_best_source(const RawRecording& raw, std::vector<std::size_t>& joints) {
  JointSource best = JointSource::kTransform;
  for (const std::size_t i : joints) best = std::min(best, raw.joints[i].source);
  std::erase_if(joints, [&](std::size_t i) { return raw.joints[i].source != best; });
}

}  // namespace

Result<std::size_t> choose_laser(const RawRecording& raw, const Rig& rig) {
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < raw.lasers.size(); ++i) {
    const RawLaser& laser = raw.lasers[i];
    if (rig.laser.topic && *rig.laser.topic != laser.topic) continue;
    if (!laser.scans.empty()) usable.push_back(i);
  }
  // Where nothing is named, a scanner's own scans go before clouds: those may be made of anything.
  const auto of_scans = [&](std::size_t i) { return !raw.lasers[i].of_clouds; };
  if (std::ranges::any_of(usable, of_scans)) std::erase_if(usable, std::not_fn(of_scans));
  if (usable.size() == 1) return usable.front();
  if (usable.size() > 1) {
    return unreadable(fmt::format(
        "{}: {} topics of scans, and it is ambiguous which to use; name one in a rig file (laser: {{topic: "
        "{}}}, given with --rig):{}",
        raw.file, usable.size(), raw.lasers[usable.front()].topic, list_of_topics(raw, "/LaserScan")));
  }
  const std::string any = list_of_topics(raw, "/LaserScan");
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
  return unreadable(nothing_usable(raw, "sensor_msgs/LaserScan", "/LaserScan"));
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
  if (rig.motor.topic) {
    return unreadable(fmt::format("{}: no usable joint states on {}, the rig's motor.topic. Topics found:{}",
                                  raw.file, *rig.motor.topic, list_of_topics(raw, "")) +
                      first_warning(raw));
  }
  return unreadable(nothing_usable(raw, "sensor_msgs/JointState", "/JointState"));
}

void warn_of_frames(const RawLaser& laser, Recording& recording) {
  if (laser.other_frames.empty()) return;
  recording.report.warnings.push_back(fmt::format(
      "scans on {} have {} frame_ids, {} and {}: all are used as of one scanner; if there are two, "
      "the answer is of neither",
      laser.topic, laser.other_frames.size() + 1, laser.frame, fmt::join(laser.other_frames, ", ")));
}

}  // namespace sweepscope
