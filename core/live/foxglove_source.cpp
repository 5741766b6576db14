#include "core/live/foxglove_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <thread>

#include "core/live/foxglove_protocol.hpp"
#include "core/live/heard_messages.hpp"
#include "core/live/web_socket.hpp"

namespace sweepscope {
namespace {

using Clock = std::chrono::steady_clock;

/// When to try to connect again.
class Backoff {
 public:
  void wait(Clock::time_point now) {
    constexpr std::chrono::milliseconds kMost(3000);
    next_ = now + pause_;
    pause_ = std::min(2 * pause_, kMost);
  }
  void reset() { pause_ = kFirst; }
  Clock::time_point next() const { return next_; }

 private:
  static constexpr std::chrono::milliseconds kFirst{100};
  std::chrono::milliseconds pause_ = kFirst;
  Clock::time_point next_;
};

class FoxgloveSource : public LiveSource {
 public:
  FoxgloveSource(FoxgloveAddress address, std::unique_ptr<WebSocket> socket, const std::string& url,
                 const Rig& rig)
      : address_(std::move(address)), socket_(std::move(socket)), messages_(url, rig) {}

  Result<bool> listen(std::chrono::milliseconds max_wait) override {
    if (!socket_ && !reconnect(max_wait)) return true;
    const auto until = Clock::now() + max_wait;
    // All that is there is taken at once; a connection that ended is not the end of the input.
    for (auto wait = max_wait; socket_; wait = std::chrono::milliseconds(0)) {
      const auto message = socket_->receive(wait);
      if (!message) lose_connection();
      if (!message || !*message) break;
      if (const auto taken = take(**message); !taken) return tl::unexpected(taken.error());
      if (Clock::now() >= until) break;
    }
    return true;
  }
  const RawRecording& so_far() const override { return messages_.so_far(); }
  RawRecording heard() override {
    RawRecording heard = messages_.with_warnings();
    if (lost_ > 0)
      heard.warnings.push_back(
          fmt::format("The connection to {} was lost {} time{}; messages sent meanwhile may be missing.",
                      heard.file, lost_, lost_ == 1 ? "" : "s"));
    return heard;
  }
  RawRecording take() override {
    RawRecording taken = messages_.take();
    for (; told_ < lost_; ++told_)
      taken.warnings.push_back(fmt::format("the connection to {} was lost; it is opened again", taken.file));
    return taken;
  }

 private:
  /// Waits for at most so long; whether there is a connection then.
  bool reconnect(std::chrono::milliseconds max_wait) {
    const auto now = Clock::now();
    if (now < backoff_.next()) {
      std::this_thread::sleep_for(std::min<Clock::duration>(max_wait, backoff_.next() - now));
      if (Clock::now() < backoff_.next()) return false;
    }
    auto socket = WebSocket::connect(address_, kFoxgloveSubprotocols);
    if (socket)
      socket_ = std::move(*socket);
    else
      backoff_.wait(Clock::now());
    return socket.has_value();
  }

  void lose_connection() {
    socket_.reset();
    subscribed_.clear();
    ++lost_;
    backoff_.wait(Clock::now());
  }

  Result<void> take(const WebSocketMessage& message) {
    if (!message.binary) {
      const std::string_view text(reinterpret_cast<const char*>(message.bytes.data()), message.bytes.size());
      if (const auto news = parse_foxglove_text(text)) follow(*news);
      return {};
    }
    const auto data = parse_foxglove_bytes(message.bytes);
    if (!data) return {};
    const auto topic = subscribed_.find(data->subscription);
    if (topic == subscribed_.end()) return {};
    backoff_.reset();
    return messages_.add(topic->second, data->log_ns, data->bytes);
  }

  /// Subscribes to what may be a laser or a motor.
  void follow(const FoxgloveNews& news) {
    std::vector<FoxgloveSubscription> wanted;
    for (const FoxgloveChannel& channel : news.advertised) {
      const auto* const type = find_message_type(channel.type);
      const bool ros1 = channel.encoding == "ros1";
      if (!may_be_laser_or_motor(type) || (!ros1 && channel.encoding != "cdr")) continue;
      const std::size_t topic = messages_.number_of(
          {channel.topic, channel.type, ros1 ? Encoding::kRos1 : Encoding::kCdr, true, "*"});
      subscribed_[next_id_] = topic;
      wanted.push_back({next_id_++, channel.id});
    }
    if (!wanted.empty() && !socket_->send(foxglove_subscribe_text(wanted))) lose_connection();
  }

  FoxgloveAddress address_;
  std::unique_ptr<WebSocket> socket_;  // null: not connected
  HeardMessages messages_;
  std::map<std::uint32_t, std::size_t> subscribed_;  // the topic of a subscription's id
  std::uint32_t next_id_ = 0;
  Backoff backoff_;
  std::size_t lost_ = 0, told_ = 0;
};

}  // namespace

Result<std::unique_ptr<LiveSource>> open_foxglove_source(const std::string& url, const Rig& rig) {
  const auto address = parse_foxglove_address(url);
  if (!address)
    return failure(
        ExitCode::kWrongUsage,
        fmt::format("\"{}\" is not the address of a Foxglove server, such as ws://localhost:8765", url));
  auto socket = WebSocket::connect(*address, kFoxgloveSubprotocols);
  if (!socket) return tl::unexpected(socket.error());
  return std::make_unique<FoxgloveSource>(*address, std::move(*socket), url, rig);
}

}  // namespace sweepscope
