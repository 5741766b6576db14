// A small server of the Foxglove WebSocket protocol that plays a recording.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <cstring>
#include <future>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/recording/streams/message_stream.hpp"

namespace sweepscope::foxglove_test {

namespace beast = boost::beast;
namespace http = beast::http;
using Tcp = boost::asio::ip::tcp;
using Json = nlohmann::json;
using Socket = beast::websocket::stream<Tcp::socket>;

struct Played {
  std::size_t topic = 0;
  std::int64_t log_ns = 0;
  std::vector<std::byte> bytes;
};

/// All messages of a file, in their order.
struct Playlist {
  std::vector<StreamTopic> topics;
  std::vector<Played> messages;
};

inline Playlist playlist_of(const std::filesystem::path& path) {
  Playlist list;
  const auto stream = open_stream(path, Job());
  EXPECT_TRUE(stream) << stream.error().message;
  const StreamVisitor visitor{
      [&](const StreamTopic& topic) {
        const auto there = std::ranges::find(list.topics, topic);
        if (there != list.topics.end()) return static_cast<std::size_t>(there - list.topics.begin());
        list.topics.push_back(topic);
        return list.topics.size() - 1;
      },
      [&](const StreamMessage& message) -> std::optional<Error> {
        list.messages.push_back(
            {message.topic, message.log_ns, {message.bytes.begin(), message.bytes.end()}});
        return std::nullopt;
      }};
  EXPECT_TRUE(read_stream(stream->files.front(), visitor, Job()));
  return list;
}

/// Plays messages to one client after the other: to each but the last so many, after which it cuts the
/// connection without a word.
class FoxglovePlayer {
 public:
  FoxglovePlayer(Playlist list, std::string subprotocol, std::vector<std::size_t> cut_after,
                 bool waits = false)
      : list_(std::move(list)),
        waits_(waits),
        subprotocol_(std::move(subprotocol)),
        acceptor_(context_, {boost::asio::ip::address_v4::loopback(), 0}),
        address_(acceptor_.local_endpoint()) {
    thread_ = std::thread([this, cuts = std::move(cut_after)] {
      try {
        for (const std::size_t count : cuts) serve(count);
        serve(list_.messages.size());
      } catch (const std::exception& gone) {
        std::clog << "the client went: " << gone.what() << '\n';
      }
    });
  }
  ~FoxglovePlayer() {
    // Where a test failed before it came, the server waits for a client.
    try {
      Tcp::socket last(context_);
      last.connect(address_);
    } catch (const std::exception& refused) {
      std::clog << "the server has ended: " << refused.what() << '\n';
    }
    thread_.join();  // NOLINT(bugprone-exception-escape): it was started, and is not this thread
  }
  /// Before the first message it waits for play(), if it is made so.
  void play() { played_.set_value(); }
  std::string url() const { return "ws://127.0.0.1:" + std::to_string(address_.port()); }

 private:
  void serve(std::size_t until) {
    Tcp::socket connection(context_);
    acceptor_.accept(connection);
    beast::flat_buffer buffer;
    http::request<http::string_body> request;
    http::read(connection, buffer, request);
    const std::string offered(request[http::field::sec_websocket_protocol]);
    Socket socket(std::move(connection));
    socket.set_option(
        beast::websocket::stream_base::decorator([&](beast::websocket::response_type& response) {
          if (offered.find(subprotocol_) != std::string::npos)
            response.set(http::field::sec_websocket_protocol, subprotocol_);
        }));
    socket.accept(request);
    socket.text(true);
    socket.write(
        boost::asio::buffer(std::string(R"({"op": "serverInfo", "name": "test", "capabilities": []})")));
    socket.write(boost::asio::buffer(advertisement()));
    const auto subscriptions = subscribed(socket);
    if (waits_ && client_ == 0) played_.get_future().wait();
    // A message of a subscription that nobody has, one that is cut off, and another kind.
    send(socket, 4'000'000'000, list_.messages.front());
    socket.write(boost::asio::buffer("\1\0\0", 3));
    socket.write(boost::asio::buffer("\2\0\0\0\0\0\0\0\0", 9));
    // What was sent just before a cut comes again, as from a server that plays from a little earlier.
    for (std::size_t i = sent_ - std::min<std::size_t>(sent_, 20); i < until; ++i) {
      const auto id = subscriptions.find(channel_of(list_.messages[i].topic));
      if (id != subscriptions.end()) send(socket, id->second, list_.messages[i]);
    }
    sent_ = until;
    ++client_;
    if (until < list_.messages.size()) {
      // The client has them all before the connection is cut.
      wait_for_pong(socket);
      return;
    }
    beast::error_code ignored;
    for (beast::flat_buffer rest; !ignored;) socket.read(rest, ignored);  // until the client has enough
  }

  /// Each client gets other numbers.
  std::uint64_t channel_of(std::size_t topic) const { return topic + 10 + 7 * client_; }

  std::string advertisement() const {
    Json channels = Json::array();
    for (std::size_t i = 0; i < list_.topics.size(); ++i)
      channels.push_back({{"id", channel_of(i)},
                          {"topic", list_.topics[i].name},
                          {"encoding", list_.topics[i].encoding},
                          {"schemaName", list_.topics[i].type},
                          {"schema", list_.topics[i].definition}});
    channels.push_back(
        {{"id", 5000}, {"topic", "/log"}, {"encoding", "json"}, {"schemaName", "Log"}, {"schema", ""}});
    return Json{{"op", "advertise"}, {"channels", channels}}.dump();
  }

  static std::map<std::uint64_t, std::uint32_t> subscribed(Socket& socket) {
    beast::flat_buffer buffer;
    socket.read(buffer);
    const Json json = Json::parse(beast::buffers_to_string(buffer.data()));
    EXPECT_EQ(json.at("op"), "subscribe");
    std::map<std::uint64_t, std::uint32_t> ids;
    for (const Json& one : json.at("subscriptions"))
      ids[one.at("channelId").get<std::uint64_t>()] = one.at("id").get<std::uint32_t>();
    EXPECT_FALSE(ids.contains(5000)) << "no laser and no motor";
    return ids;
  }

  static void send(Socket& socket, std::uint32_t id, const Played& message) {
    std::vector<std::byte> bytes(13 + message.bytes.size());
    bytes[0] = std::byte{1};
    std::memcpy(bytes.data() + 1, &id, 4);
    std::memcpy(bytes.data() + 5, &message.log_ns, 8);
    std::ranges::copy(message.bytes, bytes.begin() + 13);
    socket.binary(true);
    socket.write(boost::asio::buffer(bytes));
  }

  static void wait_for_pong(Socket& socket) {
    bool answered = false;
    socket.control_callback([&](beast::websocket::frame_type kind, beast::string_view) {
      answered |= kind == beast::websocket::frame_type::pong;
      if (answered) socket.next_layer().close();
    });
    socket.ping({});
    beast::error_code ended;
    for (beast::flat_buffer rest; !ended && !answered;) socket.read(rest, ended);
  }

  Playlist list_;
  bool waits_;
  std::promise<void> played_;
  std::string subprotocol_;
  boost::asio::io_context context_;
  Tcp::acceptor acceptor_;
  Tcp::endpoint address_;
  std::size_t sent_ = 0, client_ = 0;
  std::thread thread_;
};

}  // namespace sweepscope::foxglove_test
