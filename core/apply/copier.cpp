#include "core/apply/copier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/apply/stamp_shift.hpp"
#include "core/recording/messages/point_cloud.hpp"
#include "core/recording/packed/compress.hpp"

namespace sweepscope {
namespace {

/// Absent where the message is malformed or has none.
std::optional<std::int64_t> laser_stamp_ns(TopicReading& reading, Encoding encoding,
                                           std::span<const std::byte> message) {
  if (!is_scan(*reading.kind)) return header_stamp_ns(*reading.kind, encoding, message);
  const auto scan = reading.scans.read(message);
  return scan && scan->header_ns != 0 ? std::optional(scan->header_ns) : std::nullopt;
}

}  // namespace

std::size_t Copier::add_topic(const StreamTopic& recorded) {
  const StreamTopic topic = topic_in(format_, recorded);
  const auto known = std::ranges::find(written_.topics, topic);
  if (known != written_.topics.end()) return static_cast<std::size_t>(known - written_.topics.begin());
  Entry& entry = entries_.emplace_back();
  const auto encoding = stream_encoding(topic);
  if (encoding) entry.encoding = *encoding;
  const bool moved = topic.name == move_.stream.topic, laser = topic.name == move_.laser.topic;
  if (moved || laser) entry.reading = reading_of(message_topic(topic), move_.rig);
  entry.moved = moved && entry.reading.kind;
  entry.laser = laser && entry.reading.kind && is_laser(*entry.reading.kind);
  written_.topics.push_back(topic);
  written_.counts.push_back(0);
  if (const auto added = sink_.add_topic(topic); !added && !problem_) problem_ = added.error();
  return written_.topics.size() - 1;
}

std::optional<Error> Copier::write(const StreamMessage& message) {
  if (auto written = sink_.write(message); !written) return written.error();
  const bool first = written_.messages++ == 0;
  written_.first_ns = first ? message.log_ns : std::min(written_.first_ns, message.log_ns);
  written_.last_ns = first ? message.log_ns : std::max(written_.last_ns, message.log_ns);
  ++written_.counts[message.topic];
  return std::nullopt;
}

Error Copier::out_of_range(const StreamMessage& message) const {
  return {ExitCode::kUnreadableInput,
          fmt::format("{}: a message on {}, received at {:.9f} s, cannot be moved: its new stamp would lie "
                      "before 1970, or beyond what a stamp holds",
                      name_, move_.stream.topic, static_cast<double>(message.log_ns) * 1e-9)};
}

/// Whether a message on the motor's topic holds the motor's joint: several publishers may share a topic. No
/// value if it is malformed.
std::optional<bool> Copier::is_of_motor(Entry& entry, std::span<const std::byte> plain) {
  if (!entry.reading.joints.read(plain, Eigen::Vector3d::UnitX(), joints_)) return std::nullopt;
  const bool found = std::ranges::find(joints_, move_.stream.joint, &DecodedJoint::name) != joints_.end();
  const bool frames_apart =
      entry.reading.kind == MessageKind::kTransforms && move_.stream.stamp == StampSource::kHeader;
  if (found && !frames_apart)
    for (const DecodedJoint& joint : joints_)
      if (joint.name != move_.stream.joint) other_joints_.emplace(joint.name);
  return found;
}

std::optional<Error> Copier::refuse_absolute_times(const Entry& entry,
                                                   std::span<const std::byte> plain) const {
  if (!is_cloud(*entry.reading.kind)) return std::nullopt;
  const auto cloud = decode_points(*entry.reading.kind, entry.encoding, plain);
  if (!cloud || !CloudReader::counts_since_1970(*cloud)) return std::nullopt;
  return Error{ExitCode::kWrongUsage, fmt::format("{}: the points on {} have absolute times, since 1970, "
                                                  "which --shift laser does not move; use --shift motor",
                                                  name_, move_.stream.topic)};
}

std::optional<Error> Copier::write_moved(Entry& entry, StreamMessage message) {
  const auto plain = plain_message(written_.topics[message.topic], message.bytes, plain_);
  if (move_.shifted == ShiftedStream::kMotor) {
    const auto of_motor = is_of_motor(entry, plain);
    if (!of_motor) ++malformed_;
    if (!of_motor.value_or(false)) return write(message);
  } else if (auto refused = refuse_absolute_times(entry, plain)) {
    return refused;
  }
  const auto moved_ns = [&](std::int64_t ns) { return move_.moved_ns(ns); };
  if (move_.stream.stamp == StampSource::kReceive) {
    message.log_ns = moved_ns(message.log_ns);
    if (message.log_ns <= 0) return out_of_range(message);
    ++moved_;
    return write(message);
  }
  const bool packed = plain.data() != message.bytes.data();
  copy_.assign(plain.begin(), plain.end());
  const StampShift shift =
      shift_header_stamps(*entry.reading.kind, entry.encoding, move_.stream.joint, moved_ns, copy_);
  if (shift == StampShift::kOutOfRange) return out_of_range(message);
  if (shift == StampShift::kMalformed) ++malformed_;
  if (shift != StampShift::kShifted) return write(message);
  ++moved_;
  const std::string again =
      packed ? compressed(Compression::kZstd, {reinterpret_cast<const char*>(copy_.data()), copy_.size()})
             : std::string();
  message.bytes = packed ? std::as_bytes(std::span(again)) : std::span<const std::byte>(copy_);
  return write(message);
}

std::optional<Error> Copier::write_added(const StreamTopic& topic, std::uint32_t sequence,
                                         std::int64_t log_ns, std::span<const std::byte> bytes) {
  const StreamTopic described = topic_in(format_, topic);
  const auto same = [&](const StreamTopic& other) {
    return other.name == described.name && other.type == described.type &&
           other.encoding == described.encoding;
  };
  const auto known = std::ranges::find_if(written_.topics, same);
  StreamMessage message;
  message.topic = known != written_.topics.end() ? static_cast<std::size_t>(known - written_.topics.begin())
                                                 : add_topic(topic);
  if (problem_) return problem_;
  message.log_ns = message.publish_ns = log_ns;
  message.sequence = sequence;
  message.bytes = bytes;
  return write(message);
}

/// What was measured before a message of the laser.
std::optional<Error> Copier::write_added_before(Entry& entry, const StreamMessage& message) {
  std::optional<std::int64_t> stamp_ns = message.log_ns;
  if (move_.laser.stamp == StampSource::kHeader) {
    const auto plain = plain_message(written_.topics[message.topic], message.bytes, plain_);
    stamp_ns = laser_stamp_ns(entry.reading, entry.encoding, plain);
  }
  if (!stamp_ns) return std::nullopt;
  return added_.write_until(*stamp_ns, message.log_ns,
                            [&](auto&&... added) { return write_added(added...); });
}

std::optional<Error> Copier::end() {
  if (problem_) return problem_;
  return added_.write_until(std::numeric_limits<std::int64_t>::max(), written_.last_ns,
                            [&](auto&&... added) { return write_added(added...); });
}

std::optional<Error> Copier::add(const StreamMessage& message) {
  if (problem_) return problem_;
  Entry& entry = entries_[message.topic];
  if (entry.laser && added_.any())
    if (auto error = write_added_before(entry, message)) return error;
  return entry.moved ? write_moved(entry, message) : write(message);
}

Result<void> Copier::finish(const std::vector<std::string>& records) {
  if (problem_) return tl::unexpected(*problem_);
  return sink_.finish(records);
}

}  // namespace sweepscope
