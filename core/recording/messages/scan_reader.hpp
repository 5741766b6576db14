#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/recording/messages/message_layout.hpp"
#include "core/recording/messages/message_topic.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

/// Reads the scans of a topic's messages: sensor_msgs/LaserScan, sensor_msgs/MultiEchoLaserScan, or either of
/// them as a field of a message of another type.
class ScanReader {
 public:
  /// Reads kLaserScan and kMultiEcho, of which each beam's range and intensity are those of one echo. A beam
  /// without an echo has the range inf. Without intensities the strongest echo is the first.
  explicit ScanReader(MessageKind kind = MessageKind::kLaserScan, Encoding encoding = Encoding::kRos1,
                      Echo echo = Echo::kFirst)
      : kind_(kind), encoding_(encoding), echo_(echo) {}
  /// Reads a field of another type: `field`, else the only one that is a scan. The error is a sentence about
  /// the topic.
  static Result<ScanReader> by_definition(const MessageTopic& topic, const std::optional<std::string>& field,
                                          Echo echo);

  MessageKind kind() const { return kind_; }
  /// Empty where the message is malformed. Views are of the message or of this reader, until the next call.
  std::optional<ScanMessage> read(std::span<const std::byte> message);
  /// Whether the strongest echo was asked for and a scan had no intensities.
  bool without_strength() const { return without_strength_; }

 private:
  std::optional<ScanMessage> read_echoes(std::span<const std::byte> message);

  MessageKind kind_;
  Encoding encoding_;
  Echo echo_;
  bool without_strength_ = false;
  std::optional<MessageLayout::Path> within_;  // of another type
  MessageLayout layout_;
  MessageLayout::Found found_;
  std::vector<std::byte> scan_bytes_;  // of the scan within, as a message of its own
  std::vector<PackedArray<float>> range_echoes_, intensity_echoes_;
  std::vector<float> ranges_m_, intensities_;
};

}  // namespace sweepscope
