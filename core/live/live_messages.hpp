#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/live/live_clouds.hpp"
#include "core/recording/streams/message_stream.hpp"

namespace sweepscope {

/// The topics of live clouds, in the order of live_topics().
enum class LiveTopic : std::size_t { kCloud, kTransform, kOffset };

/// sensor_msgs/PointCloud2 as `apply --clouds` writes it, the laser's pose on /tf, and the offset in ms
/// (std_msgs/Float64); all of ROS 1.
std::vector<StreamTopic> live_topics();

struct LiveMessage {
  LiveTopic topic = LiveTopic::kCloud;
  std::int64_t stamp_ns = 0;
  std::string bytes;
};
LiveMessage live_message(const LiveCloud& cloud, const std::string& base_frame);
/// One message of all of them, at least one: subscribers' queues are short.
LiveMessage live_message(std::span<const LivePose> poses, const std::string& base_frame,
                         const std::string& laser_frame);
LiveMessage live_offset_message(double offset_s, std::int64_t stamp_ns);

/// Where live messages go.
class LivePublisher {
 public:
  virtual ~LivePublisher() = default;
  virtual void publish(const LiveMessage& message) = 0;
};

}  // namespace sweepscope
