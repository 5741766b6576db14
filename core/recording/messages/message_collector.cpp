#include "core/recording/messages/message_collector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/recording/packed/decompress.hpp"
#include "core/recording/packed/unpacked_file.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kMaxOtherFrames = 8;  // enough to name

/// Which of the joint's publishers that is; a new one is added.
std::uint16_t number_of_publisher(RawJoint& joint, std::string_view publisher) {
  constexpr std::size_t kMaxPublishers = 256;  // further ones count as the last
  auto found = std::ranges::find(joint.publishers, publisher);
  if (found == joint.publishers.end() && joint.publishers.size() < kMaxPublishers)
    found = joint.publishers.emplace(found, publisher);
  return static_cast<std::uint16_t>(
      std::min<std::size_t>(std::size_t(found - joint.publishers.begin()), joint.publishers.size() - 1));
}

}  // namespace

std::optional<Error> too_much(const std::string& file, std::size_t beams, std::size_t joint_samples) {
  if (beams <= kMaxBeams && joint_samples <= kMaxJointSamples) return std::nullopt;
  const bool of_beams = beams > kMaxBeams;
  return Error{ExitCode::kUnreadableInput,
               fmt::format("{}: holds more than {} {}, the limit; cut it into parts, or name the topic{} in "
                           "a rig file",
                           file, of_beams ? kMaxBeams : kMaxJointSamples,
                           of_beams ? "beams" : "joint samples", of_beams ? "" : " and joint")};
}

std::size_t MessageCollector::number_of(const Topic& topic) {
  const auto [found, is_new] =
      numbers_.try_emplace({topic.name, topic.type, topic.encoding}, entries_.size());
  if (is_new) {
    Entry& entry = entries_.emplace_back();
    entry.topic = topic;
    entry.reading = reading_of(topic, rig_);
    if (!entry.reading.warning.empty())
      raw_.warnings.push_back(fmt::format("{}: {}", raw_.name, entry.reading.warning));
    entry.laser = raw_.lasers.size();
    entry.may_be_motor = !rig_.motor.topic || *rig_.motor.topic == topic.name;
    raw_.topics.push_back({topic.name, topic.type});
    if (const auto kind = entry.reading.kind; kind && is_laser(*kind)) {
      raw_.lasers.emplace_back().topic = topic.name;
      raw_.lasers.back().of_clouds = is_cloud(*kind);
      raw_.lasers.back().of_echoes = kind == MessageKind::kMultiEcho;
    }
  }
  return found->second;
}

/// Empty, which no message is, where it is damaged.
Result<std::span<const std::byte>> MessageCollector::unpacked(std::span<const std::byte> message) {
  const std::uint64_t max_bytes =
      limit_ != nullptr ? limit_->max_bytes(kMaxPackedMessage_bytes) : kMaxPackedMessage_bytes;
  const Decompressed plain = decompress(Compression::kZstd, message, max_bytes, unpacked_);
  if (limit_ != nullptr)
    if (auto error = limit_->take(plain.bytes.size() + (plain.too_long ? 1 : 0)))
      return tl::unexpected(std::move(*error));
  return plain.problem.empty() ? plain.bytes : std::span<const std::byte>();
}

std::optional<Error> MessageCollector::add(std::size_t topic, std::int64_t receive_ns,
                                           std::span<const std::byte> message,
                                           const std::function<std::string()>& place,
                                           std::string_view publisher) {
  Entry& entry = entries_[topic];
  RecordedTopic& counts = raw_.topics[topic];
  ++counts.messages;
  if (!entry.reading.problem.empty())
    return Error{ExitCode::kUnreadableInput, fmt::format("{}: {}", raw_.file, entry.reading.problem)};
  if (!entry.reading.kind) return std::nullopt;
  // CDR begins with 00, a frame of zstd never does.
  if (entry.topic.encoding == Encoding::kCdr && begins_zstd(message)) {
    const auto plain = unpacked(message);
    if (!plain) return plain.error();
    message = *plain;
  }
  const bool whole = add_kind(entry, receive_ns, message, publisher);
  if (!whole && counts.malformed++ == 0) entry.first_malformed = place();
  if (cloud_bytes_ > kMaxCloudBytes)
    return Error{ExitCode::kUnreadableInput,
                 fmt::format("{}: holds more than {} GiB of clouds, the limit; cut it into parts, or name "
                             "the topic in a rig file",
                             raw_.file, kMaxCloudBytes >> 30)};
  return too_much(raw_.file, beams_, joint_samples_);
}

bool MessageCollector::add_kind(Entry& entry, std::int64_t receive_ns, std::span<const std::byte> message,
                                std::string_view publisher) {
  const MessageKind kind = *entry.reading.kind;
  if (is_scan(kind)) return add_scan(entry, receive_ns, message);
  if (is_cloud(kind)) return add_cloud(entry, receive_ns, message);
  return is_motion(kind) ? add_motion(entry, receive_ns, message)
                         : add_joints(entry, receive_ns, message, publisher);
}

bool MessageCollector::add_scan(Entry& entry, std::int64_t receive_ns, std::span<const std::byte> message) {
  const auto decoded = entry.reading.scans.read(message);
  if (!decoded) return false;
  const std::size_t number = entry.scans++;
  if (detail_.scans != nullptr && (number >= detail_.scans->size() || !(*detail_.scans)[number])) return true;
  RawLaser& laser = raw_.lasers[entry.laser];
  RawScan scan;
  scan.stamps = {decoded->header_ns, receive_ns};
  scan.angle_min_rad = decoded->angle_min_rad;
  scan.angle_max_rad = decoded->angle_max_rad;
  scan.angle_increment_rad = decoded->angle_increment_rad;
  scan.time_increment_s = decoded->time_increment_s;
  scan.scan_time_s = decoded->scan_time_s;
  scan.range_min_m = decoded->range_min_m;
  scan.range_max_m = decoded->range_max_m;
  scan.beams = static_cast<std::uint32_t>(decoded->ranges_m.size());
  if (scan.beams + scan_beams_ > detail_.max_beams) leave_ranges_out();
  scan.first_range = ranges_left_out_ ? number : laser.ranges_m.size();
  if (laser.scans.empty()) laser.frame = decoded->frame;
  if (decoded->frame != laser.frame && laser.other_frames.size() < kMaxOtherFrames &&
      std::ranges::count(laser.other_frames, decoded->frame) == 0)
    laser.other_frames.emplace_back(decoded->frame);
  laser.scans.push_back(scan);
  if (ranges_left_out_) return true;
  decoded->ranges_m.append_to(laser.ranges_m);
  const bool whole = detail_.scans == nullptr;  // parts are read for an estimate, which needs no intensities
  laser.has_intensities = whole && laser.has_intensities && decoded->intensities.size() == scan.beams;
  if (laser.has_intensities)
    decoded->intensities.append_to(laser.intensities);
  else
    std::vector<float>().swap(laser.intensities);
  beams_ += scan.beams;
  scan_beams_ += scan.beams;
  return true;
}

void MessageCollector::leave_ranges_out() {
  if (std::exchange(ranges_left_out_, true)) return;
  beams_ -= scan_beams_;
  for (RawLaser& laser : raw_.lasers) {
    if (laser.of_clouds) continue;
    std::vector<float>().swap(laser.ranges_m);
    std::vector<float>().swap(laser.intensities);
    laser.has_intensities = false;
    for (std::size_t i = 0; i < laser.scans.size(); ++i) laser.scans[i].first_range = i;
  }
}

bool MessageCollector::add_cloud(Entry& entry, std::int64_t receive_ns, std::span<const std::byte> message) {
  constexpr std::size_t kBeamsOfScans_a_beam = 4;  // a beam of a cloud has a direction besides
  RawLaser& laser = raw_.lasers[entry.laser];
  const std::size_t before = laser.ranges_m.size();
  const auto cloud = decode_points(*entry.reading.kind, entry.topic.encoding, message);
  const bool used = entry.clouds.add(cloud, receive_ns, laser);
  beams_ += kBeamsOfScans_a_beam * (laser.ranges_m.size() - before);
  if (used && detail_.clouds == CloudDetail::kWhole) keep_cloud(*cloud, receive_ns, laser);
  if (!used && entry.cloud_problem.empty()) entry.cloud_problem = entry.clouds.problem();
  return used;
}

void MessageCollector::keep_cloud(const CloudMessage& decoded, std::int64_t receive_ns, RawLaser& laser) {
  RawCloud& cloud = laser.clouds.emplace_back();
  cloud.stamps = {decoded.header_ns, receive_ns};
  cloud.frame = decoded.frame;
  cloud.height = decoded.height;
  cloud.width = decoded.width;
  cloud.point_bytes = decoded.point_bytes;
  cloud.row_bytes = decoded.row_bytes;
  cloud.big_endian = decoded.swapped;
  cloud.dense = decoded.dense;
  for (const CloudField& field : decoded.fields)
    cloud.fields.push_back({std::string(field.name), field.offset, field.datatype, field.count});
  cloud.data.assign(decoded.data.begin(), decoded.data.end());
  // A Livox scanner's last point.
  cloud.data.resize(std::max(cloud.data.size(), std::size_t{cloud.height} * cloud.row_bytes));
  cloud_bytes_ += cloud.data.size();
}

bool MessageCollector::add_joints(Entry& entry, std::int64_t receive_ns, std::span<const std::byte> message,
                                  std::string_view publisher) {
  if (entry.reading.kind == MessageKind::kTransforms && !add_frames(entry, receive_ns, message)) return false;
  if (!entry.may_be_motor) return true;
  if (!entry.reading.joints.read(message, rig_.mount.axis, joints_)) return false;
  for (const DecodedJoint& decoded : joints_) {
    RawJoint& joint = joint_of(entry, decoded.name);
    // Known by name all the same, for a list of choices.
    if (rig_.motor.joint && decoded.name != *rig_.motor.joint) continue;
    joint.stamps.push_back({decoded.header_ns, receive_ns});
    joint.positions.push_back(decoded.position);
    if (!publisher.empty()) joint.publisher.push_back(number_of_publisher(joint, publisher));
    ++joint_samples_;
  }
  return true;
}

bool MessageCollector::add_motion(const Entry& entry, std::int64_t receive_ns,
                                  std::span<const std::byte> message) {
  ++joint_samples_;  // as large as those
  if (entry.reading.kind == MessageKind::kImu) {
    const auto imu = decode_imu(entry.topic.encoding, message);
    if (!imu) return false;
    raw_.turn_rates.stamps.push_back({imu->header_ns, receive_ns});
    raw_.turn_rates.rates_rad_s.push_back(imu->rate_rad_s);
    return true;
  }
  const auto odometry = decode_odometry(entry.topic.encoding, message);
  if (!odometry) return false;
  raw_.odometry.stamps.push_back({odometry->header_ns, receive_ns});
  raw_.odometry.positions_m.push_back(odometry->position_m);
  raw_.odometry.orientations.push_back(odometry->orientation);
  return true;
}

bool MessageCollector::add_frames(const Entry& entry, std::int64_t receive_ns,
                                  std::span<const std::byte> message) {
  constexpr std::size_t kMaxFrames = 4096;
  if (!decode_transforms(entry.topic.encoding, message, transforms_)) return false;
  for (const TransformMessage& decoded : transforms_) {
    if (!decoded.rotation.coeffs().allFinite() || !(decoded.rotation.norm() > 0.5)) continue;
    const RawFrame::Pose pose{
        {decoded.header_ns, receive_ns}, decoded.rotation.normalized(), decoded.translation_m};
    auto found = frames_.find(decoded.child);
    if (found == frames_.end()) {
      if (raw_.frames.size() == kMaxFrames) continue;
      found = frames_.emplace(decoded.child, raw_.frames.size()).first;
      raw_.frames.push_back({std::string(decoded.parent), std::string(decoded.child), pose, pose});
    }
    RawFrame& frame = raw_.frames[found->second];
    frame.shifted_m = std::max(frame.shifted_m, (pose.translation_m - frame.first.translation_m).norm());
    const double turned_rad = frame.first.rotation.angularDistance(pose.rotation);
    if (turned_rad <= frame.turned_rad) continue;
    frame.turned_rad = turned_rad;
    frame.farthest = pose;
  }
  return true;
}

RawJoint& MessageCollector::joint_of(Entry& entry, std::string_view joint) {
  auto found = entry.joints.find(joint);
  if (found == entry.joints.end()) {
    found = entry.joints.emplace(joint, raw_.joints.size()).first;
    RawJoint& added = raw_.joints.emplace_back();
    added.topic = entry.topic.name;
    added.joint = joint;
    added.source = entry.reading.joints.source();
  }
  return raw_.joints[found->second];
}

void MessageCollector::finish() {
  for (const auto& [key, number] : numbers_) {
    const RecordedTopic& topic = raw_.topics[number];
    if (entries_[number].reading.scans.without_strength())
      raw_.warnings.push_back(fmt::format(
          "scans on {} have no intensities: the first echo is used and not the strongest", topic.name));
    if (topic.malformed == 0) continue;
    const std::string& cloud_problem = entries_[number].cloud_problem;
    raw_.warnings.push_back(
        fmt::format("{} of {} messages on {} are {} and were skipped, the first at {}{}", topic.malformed,
                    topic.messages, topic.name, cloud_problem.empty() ? "malformed" : "unusable",
                    entries_[number].first_malformed, cloud_problem.empty() ? "" : ": " + cloud_problem));
  }
}

}  // namespace sweepscope
