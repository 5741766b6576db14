#include "core/apply/survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/recording/assemble/choose_streams.hpp"
#include "core/recording/messages/message_collector.hpp"
#include "core/recording/messages/topic_reading.hpp"
#include "core/recording/packed/unpacked_file.hpp"
#include "core/recording/stream_stamps.hpp"

namespace sweepscope {
namespace {

/// The earlier of each kind of stamp; 0 stands for none.
MessageStamps lesser(MessageStamps a, const MessageStamps& b) {
  if (b.header_ns != 0 && (a.header_ns == 0 || b.header_ns < a.header_ns)) a.header_ns = b.header_ns;
  if (b.receive_ns != 0 && (a.receive_ns == 0 || b.receive_ns < a.receive_ns)) a.receive_ns = b.receive_ns;
  return a;
}

/// Collects the survey in one pass.
class Surveyor {
 public:
  Surveyor(const StreamRecording& recording, const Rig& rig) : rig_(rig) {
    result_.raw.file = recording.path.string();
    result_.raw.name = recording.path.filename().string();
  }

  std::size_t add_topic(const StreamTopic& topic);
  std::optional<Error> add(const StreamMessage& message);
  StreamSurvey take() { return std::move(result_); }

 private:
  struct Entry {
    TopicReading reading;
    Encoding encoding = Encoding::kRos1;
    std::map<std::string, std::size_t, std::less<>> joints;
  };

  bool add_scan(Entry& entry, const StreamMessage& message, std::span<const std::byte> bytes);
  bool add_joints(Entry& entry, const StreamMessage& message, std::span<const std::byte> bytes);
  void add_position(RawJoint& joint, const MessageStamps& stamps, double position);

  const Rig& rig_;
  StreamSurvey result_;
  std::vector<Entry> entries_;
  std::vector<std::byte> buffer_;
  std::vector<DecodedJoint> decoded_;
};

std::size_t Surveyor::add_topic(const StreamTopic& topic) {
  const auto known = std::ranges::find(result_.topics, topic);
  if (known != result_.topics.end()) return static_cast<std::size_t>(known - result_.topics.begin());
  Entry& entry = entries_.emplace_back();
  entry.reading = reading_of(message_topic(topic), rig_);
  entry.encoding = stream_encoding(topic).value_or(Encoding::kRos1);
  result_.topics.push_back(topic);
  result_.messages.push_back(0);
  result_.raw.topics.push_back({topic.name, topic.type});
  return result_.topics.size() - 1;
}

std::optional<Error> Surveyor::add(const StreamMessage& message) {
  Entry& entry = entries_[message.topic];
  RecordedTopic& counts = result_.raw.topics[message.topic];
  ++counts.messages;
  ++result_.messages[message.topic];
  if (!entry.reading.problem.empty())
    return Error{ExitCode::kUnreadableInput, fmt::format("{}: {}", result_.raw.file, entry.reading.problem)};
  if (!result_.compression) result_.compression = message.compression;
  if (!entry.reading.kind || is_motion(*entry.reading.kind)) return std::nullopt;
  const auto bytes = plain_message(result_.topics[message.topic], message.bytes, buffer_);
  const bool whole =
      is_laser(*entry.reading.kind) ? add_scan(entry, message, bytes) : add_joints(entry, message, bytes);
  if (!whole) ++counts.malformed;
  return std::nullopt;
}

bool Surveyor::add_scan(Entry& entry, const StreamMessage& message, std::span<const std::byte> bytes) {
  MessageStamps stamps{0, message.log_ns};
  std::string frame;
  if (is_scan(*entry.reading.kind)) {
    const auto scan = entry.reading.scans.read(bytes);
    if (!scan) return false;
    stamps.header_ns = scan->header_ns;
    frame = scan->frame;
  } else {
    const auto cloud = decode_points(*entry.reading.kind, entry.encoding, bytes);
    if (!cloud || cloud->points() == 0) return false;
    stamps.header_ns = cloud->header_ns;
    frame = cloud->frame;
  }
  const std::string& topic = result_.topics[message.topic].name;
  auto& lasers = result_.raw.lasers;
  const auto known = std::ranges::find(lasers, topic, &RawLaser::topic);
  if (known == lasers.end()) {
    RawLaser& laser = lasers.emplace_back();
    laser.topic = topic;
    laser.frame = std::move(frame);
    laser.of_clouds = is_cloud(*entry.reading.kind);
    laser.of_echoes = entry.reading.kind == MessageKind::kMultiEcho;
    laser.scans.emplace_back().stamps = stamps;
    result_.first_scans.push_back(stamps);
    result_.last_scans.push_back(stamps);
    return true;
  }
  RawScan& scan = known->scans.front();
  scan.stamps = lesser(scan.stamps, stamps);
  const auto number = static_cast<std::size_t>(known - lasers.begin());
  MessageStamps &first = result_.first_scans[number], &last = result_.last_scans[number];
  first = lesser(first, stamps);
  last = {std::max(last.header_ns, stamps.header_ns), std::max(last.receive_ns, stamps.receive_ns)};
  return true;
}

bool Surveyor::add_joints(Entry& entry, const StreamMessage& message, std::span<const std::byte> bytes) {
  if (!entry.reading.joints.read(bytes, rig_.mount.axis, decoded_)) return false;
  const std::string& topic = result_.topics[message.topic].name;
  auto& joints = result_.raw.joints;
  for (const DecodedJoint& decoded : decoded_) {
    auto found = entry.joints.find(decoded.name);
    if (found == entry.joints.end()) {
      // Several publishers of a topic are one stream.
      const auto same = std::ranges::find_if(
          joints, [&](const RawJoint& joint) { return joint.topic == topic && joint.joint == decoded.name; });
      found = entry.joints.emplace(decoded.name, static_cast<std::size_t>(same - joints.begin())).first;
      if (same == joints.end()) {
        RawJoint& added = joints.emplace_back();
        added.topic = topic;
        added.joint = decoded.name;
        added.source = entry.reading.joints.source();
      }
    }
    add_position(joints[found->second], {decoded.header_ns, message.log_ns}, decoded.position);
  }
  return true;
}

void Surveyor::add_position(RawJoint& joint, const MessageStamps& stamps, double position) {
  if (joint.positions.empty()) {
    joint.positions = {position};
    joint.stamps = {stamps};
    return;
  }
  joint.stamps.front() = lesser(joint.stamps.front(), stamps);
  ++joint.left_out;
  if (!std::isfinite(position)) return;
  double &least = joint.positions.front(), &most = joint.positions.back();
  if (!std::isfinite(least)) least = most = position;
  if (joint.positions.size() == 1) {
    if (position == least) return;
    joint.positions.push_back(position);
    --joint.left_out;
    std::ranges::sort(joint.positions);
    return;
  }
  least = std::min(least, position);
  most = std::max(most, position);
}

/// The stamps that an estimate would use for a stream.
StampSource stamp_of(const MessageStamps& any, StampSource wanted, const std::string& topic,
                     StreamSurvey& survey) {
  return choose_stamps({&any, 1}, wanted, topic, survey.warnings).used;
}

}  // namespace

std::optional<Encoding> stream_encoding(const StreamTopic& topic) {
  if (topic.encoding == "ros1") return Encoding::kRos1;
  if (topic.encoding == "cdr") return Encoding::kCdr;
  return std::nullopt;
}

std::span<const std::byte> plain_message(const StreamTopic& topic, std::span<const std::byte> message,
                                         std::vector<std::byte>& buffer) {
  if (topic.encoding != "cdr" || !begins_zstd(message)) return message;
  const Decompressed plain = decompress(Compression::kZstd, message, kMaxPackedMessage_bytes, buffer);
  return plain.problem.empty() ? plain.bytes : std::span<const std::byte>();
}

Result<StreamSurvey> survey(const StreamRecording& recording, const Rig& rig, const Job& job) {
  Surveyor surveyor(recording, rig);
  const StreamVisitor visitor{[&](const StreamTopic& topic) { return surveyor.add_topic(topic); },
                              [&](const StreamMessage& message) { return surveyor.add(message); }};
  std::vector<std::string> warnings;
  for (const StreamFile& file : recording.files) {
    const auto damage = read_stream(file, visitor, job);
    if (!damage) return tl::unexpected(damage.error());
    for (const std::string& what : *damage)
      warnings.push_back(recording.is_folder ? fmt::format("{}: {}", file.path.filename().string(), what)
                                             : what);
  }
  StreamSurvey result = surveyor.take();
  result.warnings = warnings;
  result.raw.warnings = std::move(warnings);
  return result;
}

Result<MovedStream> find_motor(StreamSurvey& survey, const Rig& rig, std::optional<StampSource> stamps) {
  const auto chosen = choose_joint(survey.raw, rig);
  if (!chosen) return tl::unexpected(chosen.error());
  const RawJoint& joint = survey.raw.joints[*chosen];
  MovedStream moved;
  moved.topic = joint.topic;
  moved.joint = joint.joint;
  moved.stamp =
      stamp_of(joint.stamps.front(), stamps.value_or(rig.motor.stamp.value_or(StampSource::kHeader)),
               joint.topic, survey);
  moved.messages = joint.positions.size() + joint.left_out;
  return moved;
}

Result<MovedStream> find_laser(StreamSurvey& survey, const Rig& rig, std::optional<StampSource> stamps) {
  const auto chosen = choose_laser(survey.raw, rig);
  if (!chosen) return tl::unexpected(chosen.error());
  const RawLaser& laser = survey.raw.lasers[*chosen];
  MovedStream moved;
  moved.topic = laser.topic;
  moved.frame = laser.frame;
  moved.stamp =
      stamp_of(laser.scans.front().stamps, stamps.value_or(rig.laser.stamp.value_or(StampSource::kHeader)),
               laser.topic, survey);
  moved.first_ns = stamp_ns(survey.first_scans[*chosen], moved.stamp);
  for (std::size_t i = 0; i < survey.topics.size(); ++i)
    if (survey.topics[i].name == laser.topic) moved.messages += survey.messages[i];
  moved.last_ns = stamp_ns(survey.last_scans[*chosen], moved.stamp);
  return moved;
}

}  // namespace sweepscope
