#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/apply/added_topics.hpp"
#include "core/apply/apply_output.hpp"
#include "core/apply/clock_shift.hpp"
#include "core/apply/survey.hpp"
#include "core/recording/messages/topic_reading.hpp"
#include "core/recording/streams/message_sink.hpp"

namespace sweepscope {

/// The stream to move, and the shift.
struct Move {
  MovedStream stream;
  MovedStream laser;  // where it is moved, the offset changes, or topics are added
  Rig rig;            // by which both are read
  ShiftedStream shifted = ShiftedStream::kMotor;
  ClockShift clocks{0};

  std::int64_t moved_ns(std::int64_t ns) const {
    return shifted == ShiftedStream::kMotor ? clocks.laser_ns(ns) : clocks.motor_ns(ns);
  }
};

/// Copies the messages of one output file.
class Copier {
 public:
  /// `added` is written between the messages of the laser.
  Copier(MessageSink& sink, StreamFormat format, const Move& move, AddedStreams& added, std::string name)
      : sink_(sink), format_(format), move_(move), added_(added), name_(std::move(name)) {}

  std::size_t add_topic(const StreamTopic& topic);
  std::optional<Error> add(const StreamMessage& message);
  /// Writes the rest of what is added: call it at the end of the recording.
  std::optional<Error> end();
  Result<void> finish(const std::vector<std::string>& records);

  std::uint64_t moved() const { return moved_; }
  std::uint64_t malformed() const { return malformed_; }
  const std::set<std::string>& other_joints() const { return other_joints_; }
  WrittenFile written() const { return written_; }

 private:
  struct Entry {
    TopicReading reading;
    bool moved = false;  // or its messages stay as they are
    bool laser = false;
    Encoding encoding = Encoding::kRos1;
  };
  std::optional<Error> write(const StreamMessage& message);
  std::optional<Error> write_added(const StreamTopic& topic, std::uint32_t sequence, std::int64_t log_ns,
                                   std::span<const std::byte> bytes);
  std::optional<Error> write_added_before(Entry& entry, const StreamMessage& message);
  std::optional<Error> write_moved(Entry& entry, StreamMessage message);
  std::optional<bool> is_of_motor(Entry& entry, std::span<const std::byte> plain);
  std::optional<Error> refuse_absolute_times(const Entry& entry, std::span<const std::byte> plain) const;
  Error out_of_range(const StreamMessage& message) const;

  MessageSink& sink_;
  StreamFormat format_;
  const Move& move_;
  AddedStreams& added_;
  std::string name_;           // of the recording, for messages
  std::deque<Entry> entries_;  // which stay in their places while topics are added
  std::optional<Error> problem_;
  WrittenFile written_;
  std::vector<std::byte> plain_, copy_;
  std::vector<DecodedJoint> joints_;
  std::set<std::string> other_joints_;  // in messages that were moved
  std::uint64_t moved_ = 0, malformed_ = 0;
};

}  // namespace sweepscope
