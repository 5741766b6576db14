#include "core/recording/survey/survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/numbers.hpp"
#include "core/recording/assemble/choose_streams.hpp"
#include "core/recording/assemble/mount_from_frames.hpp"

namespace sweepscope {
namespace {

double seconds_between(const MessageStamps& first, const MessageStamps& last) {
  const bool headers = first.header_ns != 0 && last.header_ns != 0;
  const std::int64_t ns = headers ? last.header_ns - first.header_ns : last.receive_ns - first.receive_ns;
  return static_cast<double>(ns) * 1e-9;
}

LaserChoice choice_of(const RawLaser& laser) {
  LaserChoice choice{laser.topic, laser.of_clouds, laser.scans.size(), 0, 0};
  for (const RawScan& scan : laser.scans)
    choice.max_beams = std::max<std::size_t>(choice.max_beams, scan.beams);
  const double lasted_s = seconds_between(laser.scans.front().stamps, laser.scans.back().stamps);
  if (lasted_s > 0) choice.rate_hz = static_cast<double>(laser.scans.size() - 1) / lasted_s;
  return choice;
}

JointChoice choice_of(const RawJoint& joint, double scale) {
  const double turned_deg = range_of(joint) * std::abs(scale) * kDegPerRad;
  return {joint.topic, joint.joint, joint.source, joint.positions.size(), turned_deg};
}

std::string topics_in_words(const std::vector<RecordedTopic>& topics) {
  constexpr std::size_t kMaxListed = 8;
  std::string words;
  for (std::size_t i = 0; i < topics.size() && i < kMaxListed; ++i)
    words += fmt::format("{}{} ({})", i > 0 ? ", " : "", topics[i].name,
                         topics[i].type.substr(topics[i].type.rfind('/') + 1));
  if (topics.size() > kMaxListed) words += fmt::format(" and {} more", topics.size() - kMaxListed);
  return words.empty() ? "none" : words;
}

/// The topics of a file, and why one that looks right is not used.
std::string topics_instead(const RawRecording& raw) {
  const std::string topics = fmt::format("Topics: {}.", topics_in_words(raw.topics));
  return raw.warnings.empty() ? topics : fmt::format("{} Also: {}.", topics, raw.warnings.front());
}

std::string why_no_laser(const RecordingSurvey& survey, const RawRecording& raw, const Rig& rig) {
  if (survey.lasers.empty())
    return fmt::format("No topic holds scans or clouds with a time per point. {}", topics_instead(raw));
  const auto named = [&](const LaserChoice& laser) { return laser.topic == rig.laser.topic; };
  if (rig.laser.topic && std::ranges::none_of(survey.lasers, named))
    return fmt::format("There are no scans on {}.", *rig.laser.topic);
  return fmt::format("{} topics hold scans. Choose the scanner that the motor turns.", survey.lasers.size());
}

std::string why_no_joint(const RecordingSurvey& survey, const RawRecording& raw, const Rig& rig) {
  if (survey.joints.empty())
    return fmt::format("No topic holds the angle of a motor: joint states, numbers or transforms. {}",
                       topics_instead(raw));
  const auto named = [&](const JointChoice& joint) {
    return (!rig.motor.topic || joint.topic == *rig.motor.topic) &&
           (!rig.motor.joint || joint.joint == *rig.motor.joint);
  };
  if (std::ranges::none_of(survey.joints, named))
    return fmt::format("There is no joint {} on {}.", rig.motor.joint.value_or("(any)"),
                       rig.motor.topic.value_or("any topic"));
  const auto moving =
      std::ranges::count_if(survey.joints, [](const JointChoice& joint) { return joint.turned_deg > 1; });
  if (moving == 0) return "No joint turns by more than 1°. Choose the motor, or another recording.";
  return fmt::format("{} of {} joints turn. Choose the one that turns the scanner.", moving,
                     survey.joints.size());
}

std::string axis_in_words(const Eigen::Vector3d& axis) {
  return fmt::format("[{:.2g}, {:.2g}, {:.2g}]", axis.x() + 0.0, axis.y() + 0.0, axis.z() + 0.0);
}

std::string mount_in_words(const RawRecording& raw, const std::string& laser_frame) {
  const auto found = mount_from_frames(raw.frames, laser_frame);
  if (!found) return "";
  if (!found->turning) return fmt::format("Transforms place {} in {}.", laser_frame, found->chain.back());
  return fmt::format("Transforms: {} turns in {} about {}.", found->turning->child, found->parent,
                     axis_in_words(found->axis));
}

void note_stamps(const std::vector<RawScan>& scans, RecordingSurvey& survey) {
  for (const RawScan& scan : scans) {
    survey.header_stamps |= scan.stamps.header_ns != 0;
    survey.receive_stamps |= scan.stamps.receive_ns != 0;
  }
}

/// The number of the chosen one among those that are listed.
template <typename Choices, typename Same>
std::optional<std::size_t> listed(const Choices& choices, const Same& same) {
  const auto found = std::ranges::find_if(choices, same);
  if (found == choices.end()) return std::nullopt;
  return static_cast<std::size_t>(found - choices.begin());
}

}  // namespace

Rig without_streams(Rig rig) {
  if (!rig.laser.field) rig.laser.topic.reset();
  if (rig.motor.field) return rig;
  rig.motor.topic.reset();
  rig.motor.joint.reset();
  return rig;
}

RecordingSurvey survey(const RawRecording& raw, const Rig& rig) {
  RecordingSurvey found;
  found.topics = raw.topics;
  for (const RawLaser& laser : raw.lasers)
    if (!laser.scans.empty()) found.lasers.push_back(choice_of(laser));
  for (const RawJoint& joint : raw.joints)
    if (!joint.positions.empty()) found.joints.push_back(choice_of(joint, rig.motor.rad_per_value()));
  if (const auto laser = choose_laser(raw, rig)) {
    const RawLaser& chosen = raw.lasers[*laser];
    found.laser = listed(found.lasers, [&](const LaserChoice& c) { return c.topic == chosen.topic; });
    found.mount_note = mount_in_words(raw, chosen.frame);
    note_stamps(chosen.scans, found);
  } else {
    for (const RawLaser& any : raw.lasers) note_stamps(any.scans, found);
  }
  if (const auto joint = choose_joint(raw, rig)) {
    const RawJoint& chosen = raw.joints[*joint];
    found.joint = listed(found.joints, [&](const JointChoice& c) {
      return c.topic == chosen.topic && c.joint == chosen.joint;
    });
  }
  if (!found.laser) found.laser_problem = why_no_laser(found, raw, rig);
  if (!found.joint) found.joint_problem = why_no_joint(found, raw, rig);
  return found;
}

}  // namespace sweepscope
