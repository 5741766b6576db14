// A small server of the Foxglove WebSocket protocol plays a recording; the offset is that of the file.
#include "core/live/foxglove_source.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <cstring>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/live/calibration.hpp"
#include "core/live/foxglove_protocol.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "core/recording/formats/read_recording.hpp"
#include "core/recording/formats/recording_writer.hpp"
#include "core/recording/streams/message_stream.hpp"
#include "core/simulation/simulate.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

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

Playlist playlist_of(const std::filesystem::path& path) {
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
class Server {
 public:
  Server(Playlist list, std::string subprotocol, std::vector<std::size_t> cut_after)
      : list_(std::move(list)),
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
  ~Server() {
    // Where a test failed before it came, the server waits for a client.
    try {
      Tcp::socket last(context_);
      last.connect(address_);
    } catch (const std::exception& refused) {
      std::clog << "the server has ended: " << refused.what() << '\n';
    }
    thread_.join();  // NOLINT(bugprone-exception-escape): it was started, and is not this thread
  }
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
  std::string subprotocol_;
  boost::asio::io_context context_;
  Tcp::acceptor acceptor_;
  Tcp::endpoint address_;
  std::size_t sent_ = 0, client_ = 0;
  std::thread thread_;
};

class FoxgloveSource : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::ScratchFolder>();
    SimulationOptions options;
    options.scene = "room-1";
    options.offset_s = 0.0173;
    options.duration_s = 5.0;
    const auto simulated = simulate(options, Job());
    ASSERT_TRUE(simulated);
    ASSERT_TRUE(write_bag(*simulated, *folder_ / "room.bag", Job()));
    const auto raw = read_raw_recording(*folder_ / "room.bag", {}, Job());
    ASSERT_TRUE(raw);
    ASSERT_TRUE(write_recording(raw->lasers.at(0), raw->joints.at(0), RecordingFormat::kMcap, "none",
                                *folder_ / "room.mcap", Job()));
  }
  static void TearDownTestSuite() { folder_.reset(); }
  /// Of the file, and of what a server that plays it says.
  void expect_same(const char* file, const char* subprotocol, std::vector<std::size_t> cuts) const {
    const auto recording = read_recording(*folder_ / file, {}, Job());
    ASSERT_TRUE(recording);
    const auto of_file = estimate(*recording, {}, Job());
    ASSERT_TRUE(of_file && of_file->offset_s);
    CalibrationOptions options;
    options.seconds = recording->scans.back().first_beam_s - recording->scans.front().first_beam_s - 1e-6;
    options.every_s = options.silence_s = 1e9;
    const Server server(playlist_of(*folder_ / file), subprotocol, std::move(cuts));
    auto source = open_foxglove_source(server.url(), options.rig);
    ASSERT_TRUE(source) << source.error().message;
    const auto end = listen(**source, options, Job(), [](const HeardSoFar&, const Result<Estimate>&) {});
    ASSERT_TRUE(end) << end.error().message;
    EXPECT_EQ(*end, ListeningEnd::kHeardEnough);
    // What comes behind the last scan counts in the file, too.
    const auto last_ns = [](const RawRecording& raw) { return raw.joints.at(0).stamps.back().header_ns; };
    const auto whole = read_raw_recording(*folder_ / file, {}, Job());
    ASSERT_TRUE(whole);
    while (last_ns((*source)->so_far()) != last_ns(*whole))
      ASSERT_TRUE((*source)->listen(std::chrono::seconds(1)));
    const auto heard = calibrate((*source)->heard(), options, Job());
    source->reset();
    ASSERT_TRUE(heard) << heard.error().message;
    ASSERT_TRUE(heard->offset_s);
    EXPECT_EQ(*heard->offset_s, *of_file->offset_s);
    EXPECT_EQ(heard->scans, of_file->scans);
  }
  inline static std::unique_ptr<test::ScratchFolder> folder_;
};

TEST_F(FoxgloveSource, FindsTheOffsetOfTheFileInBothDialectsAndEncodings) {
  expect_same("room.bag", "foxglove.websocket.v1", {});
  expect_same("room.bag", "foxglove.sdk.v1", {});
  expect_same("room.mcap", "foxglove.websocket.v1", {});
  expect_same("room.mcap", "foxglove.sdk.v1", {});
}

TEST_F(FoxgloveSource, GoesOnAfterACutConnection) {
  expect_same("room.mcap", "foxglove.sdk.v1", {150, 400});
  expect_same("room.bag", "foxglove.websocket.v1", {300});
}

TEST_F(FoxgloveSource, AServerOfAnotherProtocolIsRefused) {
  const Server server(playlist_of(*folder_ / "room.bag"), "chat.v1", {});
  const Rig rig;
  const auto source = open_foxglove_source(server.url(), rig);
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, ExitCode::kUnreadableInput);
  EXPECT_NE(source.error().message.find("the server supports none of foxglove.sdk.v1"), std::string::npos)
      << source.error().message;
}

TEST(FoxgloveAddress, IsReadWithItsDefaults) {
  const auto whole = parse_foxglove_address("ws://robot.local:9000/bridge?x=1");
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->host, "robot.local");
  EXPECT_EQ(whole->port, "9000");
  EXPECT_EQ(whole->path, "/bridge?x=1");
  const auto bare = parse_foxglove_address("ws://[::1]");
  ASSERT_TRUE(bare);
  EXPECT_EQ(bare->host, "::1");
  EXPECT_EQ(bare->port, "8765");
  EXPECT_EQ(bare->path, "/");
  for (const char* wrong :
       {"", "localhost:8765", "http://localhost", "wss://localhost", "ws://", "ws://:8765", "ws://host:port",
        "ws://host:65536", "ws://host:99999", "ws://host:0", "ws://[::1", "ws://a b:1"})
    EXPECT_FALSE(parse_foxglove_address(wrong)) << wrong;
}

TEST(FoxgloveSourceAddress, NobodyThereIsSaid) {
  const Rig rig;
  EXPECT_EQ(open_foxglove_source("localhost", rig).error().code, ExitCode::kWrongUsage);
  const auto nobody = open_foxglove_source("ws://127.0.0.1:9", rig);
  ASSERT_FALSE(nobody);
  EXPECT_EQ(nobody.error().code, ExitCode::kUnreadableInput);
  EXPECT_TRUE(nobody.error().message.starts_with("ws://127.0.0.1:9/: cannot be reached"))
      << nobody.error().message;
}

TEST(FoxgloveProtocol, WhatIsNotOfItIsLeftOut) {
  EXPECT_FALSE(parse_foxglove_text("{"));
  EXPECT_FALSE(parse_foxglove_text("[]"));
  EXPECT_FALSE(parse_foxglove_text(R"({"op": "advertise", "channels": [{"id": -1}]})"));
  EXPECT_FALSE(parse_foxglove_text(R"({"op": "unadvertise", "channelIds": [1e300]})"));
  EXPECT_FALSE(parse_foxglove_text(R"({"op": "unadvertise", "channelIds": [-1]})"));
  EXPECT_TRUE(parse_foxglove_text(R"({"op": "status", "level": 0, "message": ""})")->advertised.empty());
  EXPECT_EQ(parse_foxglove_text(R"({"op": "unadvertise", "channelIds": [1, 2]})")->withdrawn.size(), 2U);
  EXPECT_EQ(foxglove_subscribe_text({{1, 10}}),
            R"({"op":"subscribe","subscriptions":[{"channelId":10,"id":1}]})");
}

}  // namespace
}  // namespace sweepscope
