#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/recording/streams/message_stream.hpp"

namespace sweepscope {

/// The part of the Foxglove WebSocket protocol that a listener uses, and a server of live clouds
/// (https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md). Its two subprotocols, foxglove.sdk.v1
/// and foxglove.websocket.v1, have these messages in common.
inline constexpr const char* kFoxgloveSubprotocols = "foxglove.sdk.v1, foxglove.websocket.v1";

struct FoxgloveChannel {
  std::uint64_t id = 0;
  std::string topic;
  std::string encoding;  // of the messages: "ros1", "cdr" or another one
  std::string type;      // sensor_msgs/LaserScan, sensor_msgs/msg/LaserScan
};

/// What a text from the server says about its channels; both empty for any other text.
struct FoxgloveNews {
  std::vector<FoxgloveChannel> advertised;
  std::vector<std::uint64_t> withdrawn;
};

/// Nothing if the text is not what the protocol says.
std::optional<FoxgloveNews> parse_foxglove_text(std::string_view text);

/// A message of a channel; points into the bytes that it was parsed from.
struct FoxgloveMessage {
  std::uint32_t subscription = 0;
  std::int64_t log_ns = 0;
  std::span<const std::byte> bytes;
};

/// Nothing if the bytes are another kind of message, or are cut off.
std::optional<FoxgloveMessage> parse_foxglove_bytes(std::span<const std::byte> bytes);

struct FoxgloveSubscription {
  std::uint32_t id = 0;
  std::uint64_t channel = 0;
};

/// The text that asks for the messages of these channels.
std::string foxglove_subscribe_text(const std::vector<FoxgloveSubscription>& subscriptions);

/// What a client asks of a server; both empty for anything else that it may send.
struct FoxgloveRequest {
  std::vector<FoxgloveSubscription> subscribed;
  std::vector<std::uint32_t> unsubscribed;
};
/// Nothing if the text is not what the protocol says.
std::optional<FoxgloveRequest> parse_foxglove_request(std::string_view text);

/// A server's first texts. The channel of topic i is i + 1.
std::string foxglove_server_text(const std::string& name);
std::string foxglove_advertise_text(const std::vector<StreamTopic>& topics);
/// What stands before a message's bytes.
std::string foxglove_message_head(std::uint32_t subscription, std::int64_t log_ns);

/// The address of a server: ws://HOST[:PORT][/PATH], port 8765 by default.
struct FoxgloveAddress {
  std::string host, port = "8765", path = "/";
};
/// Nothing if it is no such address.
std::optional<FoxgloveAddress> parse_foxglove_address(std::string_view url);

}  // namespace sweepscope
