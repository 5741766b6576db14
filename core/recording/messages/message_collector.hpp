#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/error.hpp"
#include "core/recording/messages/messages.hpp"
#include "core/recording/messages/point_cloud.hpp"
#include "core/recording/messages/topic_reading.hpp"
#include "core/recording/packed/unpacking_limit.hpp"
#include "core/recording/read_detail.hpp"

namespace sweepscope {

/// The limits of what is kept of a file or topic, so that a small file of highly compressed messages cannot
/// fill the memory.
inline constexpr std::size_t kMaxBeams = std::size_t{1} << 29;
inline constexpr std::size_t kMaxJointSamples = std::size_t{1} << 27;
/// The limit of an unpacked message.
inline constexpr std::size_t kMaxPackedMessage_bytes = std::size_t{1} << 28;
/// The limit of the bytes of clouds that are kept completely.
inline constexpr std::size_t kMaxCloudBytes = std::size_t{1} << 33;

/// The error for a file that holds more beams or joint samples than that; otherwise empty.
std::optional<Error> too_much(const std::string& file, std::size_t beams, std::size_t joint_samples);

/// Sorts the messages of a file, of any format, into lasers and joints. Those that the rig excludes by name
/// are counted and not kept.
class MessageCollector {
 public:
  using Topic = MessageTopic;

  /// Both must outlive it, and so must what `detail` points to.
  MessageCollector(const Rig& rig, RawRecording& raw, const ReadDetail& detail = {})
      : rig_(rig), raw_(raw), detail_(detail) {}

  /// The limit for unpacking the messages that follow; it must outlive them.
  void begin_file(UnpackingLimit& limit) { limit_ = &limit; }
  /// The number of a topic, for add(): the same for the same name, type and encoding.
  std::size_t number_of(const Topic& topic);
  /// Takes a message, one of CDR also packed by zstd (rosbag2's compression mode MESSAGE). `place` gives its
  /// position, and is called only if the message is malformed. `publisher`: the node's name, empty if
  /// unknown.
  std::optional<Error> add(std::size_t topic, std::int64_t receive_ns, std::span<const std::byte> message,
                           const std::function<std::string()>& place, std::string_view publisher = {});
  /// Call once, last: warns of what was malformed.
  void finish();
  /// What was added so far was taken away and counts no longer against the limits.
  void forget_messages() { beams_ = scan_beams_ = joint_samples_ = cloud_bytes_ = 0; }

 private:
  struct Entry {
    Topic topic;
    TopicReading reading;
    std::size_t laser = 0;     // in RawRecording::lasers
    std::size_t scans = 0;     // that were decoded, kept or not
    bool may_be_motor = true;  // false: another topic is the rig's motor.topic
    std::map<std::string, std::size_t, std::less<>> joints;
    std::string first_malformed;  // the place
    CloudReader clouds;
    std::string cloud_problem;  // of the first unusable cloud
  };

  Result<std::span<const std::byte>> unpacked(std::span<const std::byte> message);
  bool add_scan(Entry& entry, std::int64_t receive_ns, std::span<const std::byte> message);
  void leave_ranges_out();
  bool add_cloud(Entry& entry, std::int64_t receive_ns, std::span<const std::byte> message);
  void keep_cloud(const CloudMessage& decoded, std::int64_t receive_ns, RawLaser& laser);
  bool add_joints(Entry& entry, std::int64_t receive_ns, std::span<const std::byte> message,
                  std::string_view publisher);
  bool add_kind(Entry& entry, std::int64_t receive_ns, std::span<const std::byte> message,
                std::string_view publisher);
  bool add_motion(const Entry& entry, std::int64_t receive_ns, std::span<const std::byte> message);
  bool add_frames(const Entry& entry, std::int64_t receive_ns, std::span<const std::byte> message);
  RawJoint& joint_of(Entry& entry, std::string_view joint);

  const Rig& rig_;
  RawRecording& raw_;
  ReadDetail detail_;
  UnpackingLimit* limit_ = nullptr;
  std::vector<Entry> entries_;  // like RawRecording::topics
  std::map<std::tuple<std::string, std::string, Encoding>, std::size_t> numbers_;
  std::vector<std::byte> unpacked_;
  std::vector<DecodedJoint> joints_;
  std::vector<TransformMessage> transforms_;
  std::map<std::string, std::size_t, std::less<>> frames_;  // by the child, in RawRecording::frames
  std::size_t beams_ = 0, scan_beams_ = 0, joint_samples_ = 0, cloud_bytes_ = 0;
  bool ranges_left_out_ = false;
};

}  // namespace sweepscope
