#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sweepscope {

/// A message as received, with its publisher's description of it. Valid during the call.
struct RosMessage {
  const std::string& topic;
  const std::string& type;
  const std::string& md5sum;
  std::int64_t receive_ns;
  const std::uint8_t* bytes;
  std::size_t size;
};

struct RosTopic {
  std::string name, type;
};

/// A topic to publish, as the master and subscribers know it.
struct RosPublishedTopic {
  std::string name, type, md5sum, definition;
  std::uint32_t max_queued = 1;  // of a subscriber; then the oldest are left out
  bool latched = false;          // later subscribers get the last message
};

/// The only code that uses roscpp, whose headers do not support C++20. One at a time in a program.
class RosLink {
 public:
  /// Null if no master answers at http://HOST:PORT.
  static std::unique_ptr<RosLink> open(const std::string& master);
  virtual ~RosLink() = default;
  /// The topics that are published now; none while no master answers. After a restart of the master this
  /// program's own topics are made known to it again.
  virtual std::vector<RosTopic> topics() = 0;
  /// The number of a topic, for publish().
  virtual std::size_t advertise(const RosPublishedTopic& topic) = 0;
  virtual void publish(std::size_t topic, const std::string& bytes) = 0;
  /// The newest `max_queued` messages wait until they are taken. Those that this program publishes are left
  /// out.
  virtual void subscribe(const std::string& topic, std::uint32_t max_queued) = 0;
  /// Passes on the messages that have arrived, waiting at most this long for the first.
  virtual void receive(std::chrono::milliseconds max_wait,
                       const std::function<void(const RosMessage&)>& take) = 0;
};

}  // namespace sweepscope
