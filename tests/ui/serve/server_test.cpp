// A server and real connections to it, good and bad.
#include "ui/serve/server.hpp"

#include <gtest/gtest.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <fstream>
#include <thread>

#include "core/io/atomic_file.hpp"
#include "tests/folder_test.hpp"
#include "ui/serve/served_window.hpp"

namespace sweepscope::ui {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Tcp = asio::ip::tcp;

constexpr const char* kToken = "secret";

class Serving : public test::FolderTest {
 protected:
  void SetUp() override { start(kNoLimit); }

  static constexpr std::chrono::hours kNoLimit{1};
  static constexpr std::chrono::milliseconds kShort{100};
  void start(std::chrono::milliseconds max_request) {
    Server::Options options;
    options.address = {"127.0.0.1", 0, true};
    options.token = kToken;
    options.hub.max_viewers = 2;
    options.hub.roots = FileRoots::of({{folder_}}).value();
    options.max_request = max_request;
    server_ = Server::start(options, mailbox_).value();
  }

  std::string place() const { return server_->address().text(); }

  Tcp::socket connected() {
    Tcp::socket socket(context_);
    socket.connect({asio::ip::make_address("127.0.0.1"), server_->address().port});
    return socket;
  }

  /// All that comes back to these bytes, until the server ends the connection.
  std::string answer_to(const std::string& bytes) {
    Tcp::socket socket = connected();
    asio::write(socket, asio::buffer(bytes));
    std::string answer;
    beast::error_code ended;
    asio::read(socket, asio::dynamic_buffer(answer), ended);
    return answer;
  }

  std::string upgrade(const std::string& host, const std::string& origin, const std::string& token) const {
    return "GET /socket HTTP/1.1\r\nHost: " + host + "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n" +
           (origin.empty() ? "" : "Origin: " + origin + "\r\n") +
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: "
           "sweepscope.1, token." +
           token + "\r\n\r\n";
  }

  using Socket = websocket::stream<Tcp::socket>;
  std::unique_ptr<Socket> viewer() {
    auto socket = viewer_if_in_time();
    EXPECT_TRUE(socket);
    return socket;
  }
  /// None if its request was not whole before the server's limit.
  std::unique_ptr<Socket> viewer_if_in_time() {
    auto socket = std::make_unique<Socket>(connected());
    socket->set_option(websocket::stream_base::decorator([this](websocket::request_type& request) {
      request.set(beast::http::field::origin, "http://" + place());
      request.set(beast::http::field::sec_websocket_protocol, std::string("sweepscope.1, token.") + kToken);
    }));
    beast::error_code failed;
    socket->handshake(place(), "/socket", failed);
    return failed ? nullptr : std::move(socket);
  }

  /// The next frame; texts before it are left out. Empty once the connection ended.
  static std::string next_frame(Socket& socket) {
    for (;;) {
      beast::flat_buffer buffer;
      beast::error_code failed;
      socket.read(buffer, failed);
      if (failed) return {};
      if (socket.got_binary()) return beast::buffers_to_string(buffer.data());
    }
  }

  static ServedPicture picture(int shade) {
    auto image = std::make_shared<Image>(320, 240);
    std::fill(image->rgba.begin(), image->rgba.end(), static_cast<std::uint8_t>(shade));
    image->make_opaque();
    return {image, 0, 0, 0, false};
  }

  asio::io_context context_;
  Mailbox mailbox_;
  std::unique_ptr<Server> server_;
};

TEST_F(Serving, AViewerWithTheTokenGetsPicturesAndSendsInput) {
  auto socket = viewer();
  while (!mailbox_.wait(10).repaint) {
  }
  server_->show(picture(10));
  EXPECT_GT(next_frame(*socket).size(), 24U);
  socket->write(asio::buffer(std::string(R"({"type":"input","number":1,"events":[["wheel",1]]})")));
  Mailbox::Arrived arrived;
  while (arrived.events.empty()) arrived = mailbox_.wait(10);
  EXPECT_EQ(arrived.events[0].wheel, 1);
  EXPECT_EQ(arrived.input_number, 1U);
}

TEST_F(Serving, APictureNamesTheLastInputThatItShowsAndNoneThatStillWaits) {
  ServedWindow window(std::move(*gl::make_resizable_context(320, 240)), mailbox_, *server_);
  bool came = false, waits = true;
  window.events.moved = [&](double, double) { came = true; };
  window.has_input = [&] { return waits; };
  const auto page = viewer();
  page->write(asio::buffer(std::string(R"({"type":"input","number":7,"events":[["move",1,2]]})")));
  while (!came) window.wait(0.1);
  for (const int number : {0, 7}) {
    window.present();
    const std::string frame = next_frame(*page);
    ASSERT_GT(frame.size(), 8U);
    EXPECT_EQ(frame[4], number);
    waits = false;
  }
}

TEST_F(Serving, WrongTokensOriginsAndHostsAreRefusedBeforeAnythingIsSent) {
  const std::string own = "http://" + place();
  EXPECT_TRUE(answer_to(upgrade(place(), own, "wrong")).starts_with("HTTP/1.1 403 "));
  EXPECT_TRUE(answer_to(upgrade(place(), own, "")).starts_with("HTTP/1.1 403 "));
  EXPECT_TRUE(answer_to(upgrade(place(), "http://evil.example", kToken)).starts_with("HTTP/1.1 403 "));
  EXPECT_TRUE(answer_to(upgrade(place(), "", kToken)).starts_with("HTTP/1.1 403 "));
  EXPECT_TRUE(answer_to(upgrade("evil.example", "http://evil.example", kToken)).starts_with("HTTP/1.1 421 "));
  EXPECT_FALSE(server_->has_viewers());
}

TEST_F(Serving, HalfARequestIsNotWaitedForWithoutEnd) {
  start(kShort);
  EXPECT_EQ(answer_to("GET /socket HTTP/1.1\r\nHost: local"), "");
  EXPECT_EQ(answer_to(""), "");
  start(kNoLimit);
  EXPECT_GT(answer_to("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n").size(), 500U) << "whole ones are served";
}

TEST_F(Serving, ARequestThatIsTooLongEndsTheConnection) {
  const std::string answer = answer_to("GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(20000, 'a'));
  EXPECT_EQ(answer.find("200 OK"), answer.npos);
  EXPECT_EQ(answer_to("\x16\x03\x01\x02\r\n\r\n").find("200 OK"), std::string::npos)
      << "what is no HTTP neither";
}

TEST_F(Serving, AFloodEndsTheConnectionAndLeavesTheOtherViewer) {
  auto good = viewer();
  auto bad = viewer();
  beast::error_code failed;
  while (!failed) bad->write(asio::buffer(std::string(R"({"type":"blur"})")), failed);
  server_->show(picture(20));
  EXPECT_GT(next_frame(*good).size(), 24U);
}

TEST_F(Serving, AMessageThatIsTooLongEndsTheConnection) {
  auto socket = viewer();
  beast::error_code failed;
  socket->write(asio::buffer(std::string(kMaxPageMessage_bytes + 1, ' ')), failed);
  EXPECT_EQ(next_frame(*socket), "");
}

TEST_F(Serving, AMessageThatIsNoTextEndsTheConnection) {
  auto socket = viewer();
  socket->binary(true);
  socket->write(asio::buffer(std::string(R"({"type":"blur"})")));
  EXPECT_EQ(next_frame(*socket), "");
  EXPECT_EQ(socket->reason().code, websocket::close_code::policy_error);
}

TEST_F(Serving, HalfAMessageHoldsNobodyUp) {
  auto half = viewer();
  // A text of 126 bytes by its header, of which the mask and one byte come.
  asio::write(half->next_layer(), asio::buffer(std::string("\x81\xfe\x00\x7e\x01\x02\x03\x04{", 9)));
  auto good = viewer();
  server_->show(picture(30));
  EXPECT_GT(next_frame(*good).size(), 24U);
  EXPECT_GT(next_frame(*half).size(), 24U);
}

TEST_F(Serving, ConnectionsBeyondTheLimitAreClosedAtOnce) {
  constexpr std::size_t kMaxConnections = 64;
  std::vector<Tcp::socket> silent;
  while (silent.size() < kMaxConnections) silent.push_back(connected());
  Tcp::socket one_more = connected();
  char byte = 0;
  beast::error_code ended;
  EXPECT_EQ(asio::read(one_more, asio::buffer(&byte, 1), ended), 0U);
  EXPECT_TRUE(ended);
  silent.pop_back();
  std::string answer;  // a place is free as soon as the server has noticed
  while (answer.empty()) {
    beast::error_code refused;
    Tcp::socket socket = connected();
    asio::write(socket, asio::buffer(std::string("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")), refused);
    asio::read(socket, asio::dynamic_buffer(answer), refused);
  }
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200 ")) << answer;
}

TEST_F(Serving, AViewerThatReadsNothingHoldsNobodyUp) {
  auto deaf = viewer();
  auto good = viewer();
  std::uint32_t number = 0;
  for (int i = 0; i < 100; ++i) {
    server_->show(picture(i));
    ASSERT_GT(next_frame(*good).size(), 24U) << i;
    good->write(asio::buffer(R"({"type":"shown","frame":)" + std::to_string(++number) + "}"));
  }
}

TEST_F(Serving, OneViewerTooManyIsToldSo) {
  auto first = viewer(), second = viewer();
  server_->show(picture(1));
  ASSERT_GT(next_frame(*second).size(), 24U);
  auto third = viewer();
  EXPECT_EQ(next_frame(*third), "");
  EXPECT_EQ(third->reason().code, websocket::close_code::try_again_later);
}

TEST_F(Serving, AFileIsFetchedUnderItsAddressAlone) {
  std::ofstream(folder_ / "curve.csv") << "offset_ms,d\n";
  auto socket = viewer();
  server_->offer(folder_ / "curve.csv");
  std::string address;
  while (address.empty()) {
    beast::flat_buffer buffer;
    socket->read(buffer);
    const std::string text = beast::buffers_to_string(buffer.data());
    const std::size_t at = text.find("/download/");
    if (at != text.npos) address = text.substr(at, text.find('"', at) - at);
  }
  const auto get = [&](const std::string& path) {
    return answer_to("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
  };
  const std::string fetched = get(address);
  EXPECT_TRUE(fetched.starts_with("HTTP/1.1 200 ")) << fetched;
  EXPECT_TRUE(fetched.ends_with("\r\n\r\noffset_ms,d\n")) << fetched;
  EXPECT_NE(fetched.find("Content-Disposition: attachment"), fetched.npos);
  std::string other = address;
  other[12] = other[12] == 'a' ? 'b' : 'a';
  EXPECT_TRUE(get(other).starts_with("HTTP/1.1 404 "));
  EXPECT_TRUE(get("/download/").starts_with("HTTP/1.1 404 "));
  std::filesystem::remove(folder_ / "curve.csv");
  EXPECT_TRUE(get(address).starts_with("HTTP/1.1 404 "));
}

/// The page's answer to a file that it announced.
std::string told(websocket::stream<Tcp::socket>& socket, const std::string& type) {
  for (;;) {
    beast::flat_buffer buffer;
    socket.read(buffer);
    std::string text = beast::buffers_to_string(buffer.data());
    if (socket.got_text() && text.find("\"type\":\"" + type + '"') != text.npos) return text;
  }
}

class Sending : public Serving {
 protected:
  void SetUp() override {
    Serving::SetUp();
    page_ = viewer();
  }

  std::string address_for(const std::string& name, std::size_t size) {
    page_->write(asio::buffer(R"({"type":"upload","name":")" + name + R"(","size_bytes":)" +
                              std::to_string(size) + "}"));
    const std::string answer = told(*page_, "upload");
    const std::size_t at = answer.find("/upload/");
    EXPECT_NE(at, answer.npos) << answer;
    return answer.substr(at, 8 + 64);
  }

  std::string put(const std::string& address, const std::string& origin, std::size_t size,
                  const std::string& body) {
    return answer_to("PUT " + address + " HTTP/1.1\r\nHost: " + place() + "\r\nOrigin: " + origin +
                     "\r\nContent-Length: " + std::to_string(size) + "\r\n\r\n" + body);
  }

  std::string own() const { return "http://" + place(); }

  std::size_t files() const {
    const std::filesystem::directory_iterator entries(folder_);
    return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
  }

  std::unique_ptr<Socket> page_;
};

TEST_F(Sending, AFileOfSeveralPiecesComesWholeAndIsOpened) {
  std::string body(1'000'003, 'x');
  for (std::size_t i = 0; i < body.size(); i += 7) body[i] = static_cast<char>(i);
  const std::string answer = put(address_for("run.bag", body.size()), own(), body.size(), body);
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200 ")) << answer;
  EXPECT_TRUE(answer.ends_with("\r\n\r\nopened\n")) << answer;
  EXPECT_EQ(read_file(folder_ / "run.bag").value(), body);
  Mailbox::Arrived arrived;
  while (arrived.events.empty()) arrived = mailbox_.wait(10);
  EXPECT_EQ(arrived.events[0].what, InputEvent::What::kDrop);
  EXPECT_EQ(arrived.events[0].text, std::filesystem::canonical(folder_ / "run.bag"));
}

TEST_F(Sending, AnEmptyFileIsAFile) {
  EXPECT_TRUE(put(address_for("empty.bag", 0), own(), 0, "").starts_with("HTTP/1.1 200 "));
  EXPECT_EQ(std::filesystem::file_size(folder_ / "empty.bag"), 0U);
}

TEST_F(Sending, WhatBreaksOffLeavesNothing) {
  {
    Tcp::socket socket = connected();
    asio::write(socket, asio::buffer("PUT " + address_for("gone.bag", 900'000) +
                                     " HTTP/1.1\r\nHost: " + place() + "\r\nOrigin: " + own() +
                                     "\r\nContent-Length: 900000\r\n\r\n" + std::string(300'000, 'x')));
    while (files() == 0) std::this_thread::yield();
    EXPECT_FALSE(std::filesystem::exists(folder_ / "gone.bag"));
  }
  while (files() > 0) std::this_thread::yield();
  start(kShort);
  for (page_.reset(); !page_;) page_ = viewer_if_in_time();
  // The answer ends when the server gave up on the rest.
  EXPECT_EQ(put(address_for("run.bag", 900'000), own(), 900'000, std::string(300'000, 'x')), "");
  while (files() > 0) std::this_thread::yield();
}

TEST_F(Sending, OnlyTheOwnPageSendsWhatItAnnounced) {
  const std::string address = address_for("run.bag", 3);
  EXPECT_TRUE(put(address, "http://evil.example", 3, "abc").starts_with("HTTP/1.1 403 "));
  EXPECT_TRUE(put("/upload/" + std::string(64, '0'), own(), 3, "abc").starts_with("HTTP/1.1 404 "));
  EXPECT_TRUE(put("/", own(), 3, "abc").starts_with("HTTP/1.1 405 "));
  EXPECT_TRUE(put(address, own(), 4, "abcd").starts_with("HTTP/1.1 404 ")) << "another length";
  EXPECT_TRUE(put(address, own(), 3, "abc").starts_with("HTTP/1.1 404 ")) << "after one try";
  EXPECT_EQ(files(), 0U);
}

TEST_F(Sending, AFileThatAppearedMeanwhileIsNotReplaced) {
  const std::string address = address_for("run.bag", 3);
  std::ofstream(folder_ / "run.bag") << "older";
  const std::string answer = put(address, own(), 3, "abc");
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 507 ")) << answer;
  EXPECT_EQ(read_file(folder_ / "run.bag").value(), "older");
  EXPECT_EQ(files(), 1U);
}

TEST_F(Serving, APortThatIsTakenIsOneSentence) {
  Server::Options options;
  options.address = server_->address();
  Mailbox mailbox;
  const auto second = Server::start(options, mailbox);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(second.error().message.find(place()), std::string::npos) << second.error().message;
}

}  // namespace
}  // namespace sweepscope::ui
