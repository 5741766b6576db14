#include "core/live/foxglove_protocol.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace sweepscope {
namespace {

using Json = nlohmann::json;

constexpr std::byte kMessageData{1};

template <typename T>
T little_endian(const std::byte* bytes) {
  T value{};
  std::memcpy(&value, bytes, sizeof value);  // the machine is little-endian, see messages.cpp
  return value;
}

/// The library would convert a fraction, and a number of any size.
std::uint64_t id_of(const Json& json) {
  if (!json.is_number_unsigned()) throw std::runtime_error("no id");
  return json.get<std::uint64_t>();
}

bool is_port(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size() && port > 0;
}

bool is_host(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c > ' ' && c < 0x7f && c != '@'; });
}

}  // namespace

std::optional<FoxgloveNews> parse_foxglove_text(std::string_view text) {
  FoxgloveNews news;
  try {
    const Json json = Json::parse(text);
    const auto op = json.at("op").get<std::string>();
    if (op == "advertise")
      for (const Json& channel : json.at("channels"))
        news.advertised.push_back({id_of(channel.at("id")), channel.at("topic").get<std::string>(),
                                   channel.at("encoding").get<std::string>(),
                                   channel.at("schemaName").get<std::string>()});
    if (op == "unadvertise")
      for (const Json& id : json.at("channelIds")) news.withdrawn.push_back(id_of(id));
  } catch (const std::exception&) {
    return std::nullopt;
  }
  return news;
}

std::optional<FoxgloveMessage> parse_foxglove_bytes(std::span<const std::byte> bytes) {
  constexpr std::size_t kId = 1, kTime = kId + 4, kHead = kTime + 8;
  if (bytes.size() < kHead || bytes[0] != kMessageData) return std::nullopt;
  return FoxgloveMessage{little_endian<std::uint32_t>(bytes.data() + kId),
                         static_cast<std::int64_t>(little_endian<std::uint64_t>(bytes.data() + kTime)),
                         bytes.subspan(kHead)};
}

std::string foxglove_subscribe_text(const std::vector<FoxgloveSubscription>& subscriptions) {
  Json list = Json::array();
  for (const FoxgloveSubscription& one : subscriptions)
    list.push_back({{"id", one.id}, {"channelId", one.channel}});
  return Json{{"op", "subscribe"}, {"subscriptions", list}}.dump();
}

std::optional<FoxgloveRequest> parse_foxglove_request(std::string_view text) {
  FoxgloveRequest request;
  const auto subscription_id = [](const Json& json) {
    const std::uint64_t id = id_of(json);
    if (id > std::numeric_limits<std::uint32_t>::max()) throw std::runtime_error("no id");
    return static_cast<std::uint32_t>(id);
  };
  try {
    const Json json = Json::parse(text);
    const auto op = json.at("op").get<std::string>();
    if (op == "subscribe")
      for (const Json& one : json.at("subscriptions"))
        request.subscribed.push_back({subscription_id(one.at("id")), id_of(one.at("channelId"))});
    if (op == "unsubscribe")
      for (const Json& id : json.at("subscriptionIds")) request.unsubscribed.push_back(subscription_id(id));
  } catch (const std::exception&) {
    return std::nullopt;
  }
  return request;
}

std::string foxglove_server_text(const std::string& name) {
  return Json{{"op", "serverInfo"},
              {"name", name},
              {"capabilities", Json::array()},
              {"supportedEncodings", Json::array()},
              {"metadata", Json::object()}}
      .dump();
}

std::string foxglove_advertise_text(const std::vector<StreamTopic>& topics) {
  Json channels = Json::array();
  for (std::size_t i = 0; i < topics.size(); ++i)
    channels.push_back({{"id", i + 1},
                        {"topic", topics[i].name},
                        {"encoding", topics[i].encoding},
                        {"schemaName", topics[i].type},
                        {"schema", topics[i].definition},
                        {"schemaEncoding", topics[i].schema_encoding}});
  return Json{{"op", "advertise"}, {"channels", channels}}.dump();
}

std::string foxglove_message_head(std::uint32_t subscription, std::int64_t log_ns) {
  std::string head(1 + sizeof subscription + sizeof log_ns, char(kMessageData));
  std::memcpy(head.data() + 1, &subscription, sizeof subscription);
  std::memcpy(head.data() + 1 + sizeof subscription, &log_ns, sizeof log_ns);
  return head;
}

std::optional<FoxgloveAddress> parse_foxglove_address(std::string_view url) {
  constexpr std::string_view kScheme = "ws://";
  if (!url.starts_with(kScheme)) return std::nullopt;
  url.remove_prefix(kScheme.size());
  FoxgloveAddress address;
  const std::size_t slash = std::min(url.find('/'), url.size());
  if (slash < url.size()) address.path = url.substr(slash);
  std::string_view host = url.substr(0, slash);
  const bool bracketed = host.starts_with('[');  // IPv6
  const std::size_t colon = host.find(':', bracketed ? std::min(host.find(']'), host.size()) : 0);
  if (colon != host.npos) {
    if (!is_port(host.substr(colon + 1))) return std::nullopt;
    address.port = host.substr(colon + 1);
    host = host.substr(0, colon);
  }
  if (bracketed && (host.size() < 2 || !host.ends_with(']'))) return std::nullopt;
  address.host = bracketed ? host.substr(1, host.size() - 2) : host;
  if (!is_host(address.host)) return std::nullopt;
  return address;
}

}  // namespace sweepscope
