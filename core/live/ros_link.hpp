#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sweepscope {

/// A message as it came over the wire, with what its publisher said of it. There for the length of the call.
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

/// All that touches roscpp, whose headers are not made for C++20. One at a time in a program.
class RosLink {
 public:
  /// None where no master answers at http://HOST:PORT.
  static std::unique_ptr<RosLink> open(const std::string& master);
  virtual ~RosLink() = default;
  /// What is published now.
  virtual std::vector<RosTopic> topics() = 0;
  /// Of what is not taken in time the newest `max_queued` messages wait.
  virtual void subscribe(const std::string& topic, std::uint32_t max_queued) = 0;
  /// Hands on the messages that have come, waiting for the first at most so long.
  virtual void receive(std::chrono::milliseconds most,
                       const std::function<void(const RosMessage&)>& take) = 0;
};

}  // namespace sweepscope
