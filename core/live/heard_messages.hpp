#pragma once

#include "core/recording/messages/message_collector.hpp"

namespace sweepscope {

/// Whether to listen to a topic of that type (null: an unknown one): it may be of a laser or a motor.
inline bool may_be_laser_or_motor(const MessageType* type) {
  return type != nullptr && !is_motion(type->kind);
}

/// What a running system sent so far. Used by one thread.
class HeardMessages {
 public:
  /// `source` names it in messages; the rig must outlive this.
  HeardMessages(const std::string& source, const Rig& rig) : collector_(rig, raw_) {
    raw_.file = raw_.name = source;
  }
  HeardMessages(const HeardMessages&) = delete;
  HeardMessages& operator=(const HeardMessages&) = delete;

  /// As MessageCollector::number_of().
  std::size_t number_of(const MessageCollector::Topic& topic) { return collector_.number_of(topic); }
  /// Takes a message; ExitCode::kUnreadableInput, and which one it was, if there is too much of them.
  Result<void> add(std::size_t topic, std::int64_t receive_ns, std::span<const std::byte> message);

  /// Unmodified.
  const RawRecording& so_far() const { return raw_; }
  /// A copy with warnings about what was skipped.
  RawRecording with_warnings();
  /// See take_messages().
  RawRecording take();

 private:
  RawRecording raw_;
  MessageCollector collector_;
  std::size_t messages_ = 0;
};

}  // namespace sweepscope
