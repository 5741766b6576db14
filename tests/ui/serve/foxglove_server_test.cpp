#include "ui/serve/foxglove_server.hpp"

#include <gtest/gtest.h>

#include <map>

#include "core/live/foxglove_protocol.hpp"
#include "core/live/web_socket.hpp"

namespace sweepscope::ui {
namespace {

Request client(std::string_view host, std::string_view origin, std::string_view protocols) {
  Request request{"GET", "/", host, origin, protocols, ""};
  request.upgrade = true;
  return request;
}

TEST(FoxgloveAccess, ProgramsAndListedPagesMayConnect) {
  const FoxgloveAccess access{{}, {"https://app.foxglove.dev"}};
  const auto status = [&](std::string_view host, std::string_view origin) {
    return foxglove_answer(client(host, origin, "foxglove.websocket.v1"), access).status;
  };
  EXPECT_EQ(status("127.0.0.1:8766", ""), 101U);
  EXPECT_EQ(status("localhost:8766", "https://app.foxglove.dev"), 101U);
  for (const char* origin : {"https://attacker.example", "null", "http://localhost:8766", "file://",
                             "https://app.foxglove.dev.attacker.example"})
    EXPECT_EQ(status("localhost:8766", origin), 403U) << origin;
}

TEST(FoxgloveAccess, ANameThatIsNotListedIsRefused) {
  FoxgloveAccess access;
  const auto status = [&](std::string_view host) {
    return foxglove_answer(client(host, "", "foxglove.sdk.v1"), access).status;
  };
  for (const char* host : {"attacker.example:8766", "192.168.1.5:8766", ""}) EXPECT_EQ(status(host), 421U);
  access.hosts = {true, {"robot.example"}};
  EXPECT_EQ(status("192.168.1.5:8766"), 101U);
  EXPECT_EQ(status("robot.example"), 101U);
}

TEST(FoxgloveAccess, TheSubprotocolIsOneOfTheTwo) {
  const auto answer = [](std::string_view protocols) {
    return foxglove_answer(client("localhost", "", protocols), {});
  };
  EXPECT_EQ(answer("foxglove.websocket.v1").subprotocol, "foxglove.websocket.v1");
  EXPECT_EQ(answer("foxglove.websocket.v1, foxglove.sdk.v1").subprotocol, "foxglove.sdk.v1");
  EXPECT_EQ(answer("chat.v1").status, 400U);
  EXPECT_EQ(answer("").status, 400U);
  Request page = client("localhost", "", "foxglove.sdk.v1");
  page.upgrade = false;
  EXPECT_EQ(foxglove_answer(page, {}).status, 426U);
}

/// A server with two topics, of which the second keeps its last message.
class FoxgloveServing : public testing::Test {
 protected:
  void SetUp() override {
    FoxgloveServer::Options options;
    options.address.port = 0;
    options.topics = {StreamTopic{"/a", "std_msgs/Float64", "ros1", "ros1msg", "float64 data\n", "", {}},
                      StreamTopic{"/b", "std_msgs/Float64", "ros1", "ros1msg", "float64 data\n", "", {}}};
    options.kept_topic = 1;
    auto started = FoxgloveServer::start(std::move(options));
    ASSERT_TRUE(started) << started.error().message;
    server_ = std::move(*started);
  }
  std::unique_ptr<WebSocket> connected() const {
    const auto address = parse_foxglove_address("ws://" + server_->address().text());
    auto socket = WebSocket::connect(*address, kFoxgloveSubprotocols);
    EXPECT_TRUE(socket) << socket.error().message;
    return std::move(*socket);
  }
  static WebSocketMessage next(WebSocket& socket) {
    for (;;) {
      auto message = socket.receive(std::chrono::seconds(1));
      if (!message) throw std::runtime_error(message.error().message);
      if (*message) return std::move(**message);
    }
  }
  static std::string text_of(const WebSocketMessage& message) {
    return {reinterpret_cast<const char*>(message.bytes.data()), message.bytes.size()};
  }
  std::unique_ptr<FoxgloveServer> server_;
};

TEST_F(FoxgloveServing, SubscribersGetTheirTopicsAndTheKeptMessage) {
  server_->publish(1, 5, "kept");
  const auto socket = connected();
  EXPECT_NE(text_of(next(*socket)).find("\"serverInfo\""), std::string::npos);
  const auto news = parse_foxglove_text(text_of(next(*socket)));
  ASSERT_TRUE(news);
  ASSERT_EQ(news->advertised.size(), 2U);
  EXPECT_EQ(news->advertised[0].topic, "/a");
  EXPECT_EQ(news->advertised[1].encoding, "ros1");
  ASSERT_TRUE(socket->send(foxglove_subscribe_text({{7, news->advertised[1].id}})));
  const WebSocketMessage kept = next(*socket);
  const auto first = parse_foxglove_bytes(kept.bytes);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->subscription, 7U);
  EXPECT_EQ(first->log_ns, 5);
  EXPECT_EQ(first->bytes.size(), 4U);
  server_->publish(0, 6, "nobody asked");
  server_->publish(1, 7, "next");
  const WebSocketMessage later = next(*socket);
  EXPECT_EQ(parse_foxglove_bytes(later.bytes)->log_ns, 7);
}

TEST_F(FoxgloveServing, WhatIsNotOfTheProtocolIsIgnored) {
  const auto socket = connected();
  for (const char* text : {"{", "[]", R"({"op": "subscribe"})", R"({"op": "advertise", "channels": []})",
                           R"({"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 1}]})",
                           R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 99}]})"})
    ASSERT_TRUE(socket->send(text));
  server_->publish(1, 8, "kept");
  ASSERT_TRUE(socket->send(foxglove_subscribe_text({{3, 2}})));
  while (!parse_foxglove_bytes(next(*socket).bytes)) {
  }
}

TEST_F(FoxgloveServing, AClientThatReadsNothingDoesNotHoldUpOthersOrFillTheMemory) {
  const auto idle = connected(), reader = connected();
  ASSERT_TRUE(idle->send(foxglove_subscribe_text({{1, 1}})));
  ASSERT_TRUE(reader->send(foxglove_subscribe_text({{1, 2}})));
  const std::string large(std::size_t{1} << 20, 'x');
  for (int i = 0; i < 200; ++i) server_->publish(0, i, large);
  server_->publish(1, 99, "small");
  for (;;) {
    const WebSocketMessage message = next(*reader);
    const auto data = parse_foxglove_bytes(message.bytes);
    if (data && data->log_ns == 99) break;
  }
}

TEST_F(FoxgloveServing, APortInUseIsRefused) {
  FoxgloveServer::Options options;
  options.address = server_->address();
  const auto second = FoxgloveServer::start(std::move(options));
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ExitCode::kWrongUsage);
}

}  // namespace
}  // namespace sweepscope::ui
