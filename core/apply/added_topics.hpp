#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/apply/clock_shift.hpp"
#include "core/apply/stamp_shift.hpp"
#include "core/error.hpp"
#include "core/job.hpp"
#include "core/map/sweep_clouds.hpp"
#include "core/recording/messages/messages.hpp"
#include "core/recording/streams/message_stream.hpp"

namespace sweepscope {

/// What is added to a recording whose offset is applied.
struct AddOptions {
  std::string clouds_topic;              // sweeps as clouds; empty: none
  bool transforms = false;               // the laser's pose in the base frame, at each of the motor's samples
  std::string base_frame = "base_link";  // of the clouds, and the transforms' parent
  MapOptions map;                        // how the rig's motion is found, which is removed
  std::optional<std::filesystem::path> poses;  // TUM: the rig's motion instead

  bool any() const { return !clouds_topic.empty() || transforms; }
};

/// The map options, with the poses read from their file.
Result<MapOptions> map_options(const AddOptions& options, const Recording& recording);

/// A topic that is added to a recording. Its messages are in the order of time, each made when it is written.
struct AddedTopic {
  StreamTopic topic;
  std::vector<std::int64_t> ready_ns;               // laser clock: when all that message i holds was measured
  std::function<std::string(std::size_t)> message;  // serialised
};

/// The recording with the motor's samples moved onto the laser's clock: its offset is 0.
Recording without_offset(Recording recording, const ClockShift& clocks);

struct AddedTopics {
  std::vector<AddedTopic> topics;
  std::vector<std::string> warnings;
};

/// The topics for a recording as without_offset gives it. `laser_frame` is the transforms' child; `stamped`
/// is the stamp in the output of an instant of the laser's clock. For the errors see build_maps.
Result<AddedTopics> add_topics(Recording recording, const AddOptions& options, Encoding encoding,
                               const std::string& laser_frame, const StampMap& stamped, const Job& job);

/// Writes the messages of added topics between those of a recording.
class AddedStreams {
 public:
  /// Writes a message of a topic; `log_ns` is its receive time.
  using Write = std::function<std::optional<Error>(const StreamTopic& topic, std::uint32_t sequence,
                                                   std::int64_t log_ns, std::span<const std::byte> bytes)>;

  AddedStreams() = default;
  explicit AddedStreams(std::vector<AddedTopic> topics)
      : topics_(std::move(topics)), written_(topics_.size(), 0) {}

  /// Writes what was measured before an instant of the laser's clock.
  std::optional<Error> write_until(std::int64_t laser_ns, std::int64_t log_ns, const Write& write);
  bool any() const { return !topics_.empty(); }
  const std::vector<AddedTopic>& topics() const { return topics_; }

 private:
  std::vector<AddedTopic> topics_;
  std::vector<std::size_t> written_;  // by topic
};

}  // namespace sweepscope
