#include "core/live/heard_messages.hpp"

#include <fmt/format.h>

#include "core/recording/take_messages.hpp"

namespace sweepscope {

Result<void> HeardMessages::add(std::size_t topic, std::int64_t receive_ns,
                                std::span<const std::byte> message) {
  ++messages_;
  if (auto error = collector_.add(topic, receive_ns, message,
                                  [&] { return fmt::format("message {} heard", messages_); }))
    return tl::unexpected(std::move(*error));
  return {};
}

RawRecording HeardMessages::with_warnings() {
  const std::size_t warnings = raw_.warnings.size();
  collector_.finish();
  RawRecording heard = raw_;
  raw_.warnings.resize(warnings);
  return heard;
}

RawRecording HeardMessages::take() {
  collector_.forget_messages();
  return take_messages(raw_);
}

}  // namespace sweepscope
