#include "core/live/web_socket.hpp"

#include <fmt/format.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

namespace sweepscope {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
using Tcp = boost::asio::ip::tcp;

constexpr std::chrono::seconds kMaxWait(5);
constexpr std::size_t kMaxMessage_bytes = std::size_t{1} << 28;  // as of a message in a file

class BeastWebSocket : public WebSocket {
 public:
  explicit BeastWebSocket(const FoxgloveAddress& address)
      : name_(fmt::format("ws://{}:{}{}", address.host, address.port, address.path)) {}

  Result<void> open(const FoxgloveAddress& address, const std::string& subprotocols) {
    Tcp::resolver resolver(context_);
    beast::error_code error;
    const auto places = resolver.resolve(address.host, address.port, error);
    if (error) return failed("cannot be reached", error);
    beast::get_lowest_layer(stream_).expires_after(kMaxWait);
    run([&](auto done) {
      beast::get_lowest_layer(stream_).async_connect(
          places, [done](beast::error_code code, const Tcp::endpoint&) { done(code); });
    });
    if (error_) return failed("cannot be reached", error_);
    beast::get_lowest_layer(stream_).expires_never();
    return shake_hands(address, subprotocols);
  }

  Result<std::optional<WebSocketMessage>> receive(std::chrono::milliseconds max_wait) override {
    if (!reading_ && !arrived_) begin_reading();
    context_.restart();
    const auto until = std::chrono::steady_clock::now() + max_wait;
    while (!arrived_ && (context_.poll_one() > 0 || context_.run_one_until(until) > 0)) {
    }
    if (!arrived_) return std::nullopt;
    arrived_ = false;
    if (read_error_) return failed("the connection ended", read_error_);
    WebSocketMessage message;
    message.binary = stream_.got_binary();
    const auto* const bytes = static_cast<const std::byte*>(buffer_.data().data());
    message.bytes.assign(bytes, bytes + buffer_.size());
    buffer_.clear();
    return message;
  }

  Result<void> send(const std::string& text) override {
    stream_.text(true);
    run([&](auto done) {
      stream_.async_write(boost::asio::buffer(text),
                          [done](beast::error_code code, std::size_t) { done(code); });
    });
    if (error_) return failed("the connection ended", error_);
    return {};
  }

 private:
  Result<void> shake_hands(const FoxgloveAddress& address, const std::string& subprotocols) {
    namespace websocket = beast::websocket;
    auto timeouts = websocket::stream_base::timeout::suggested(beast::role_type::client);
    timeouts.handshake_timeout = kMaxWait;
    stream_.set_option(timeouts);
    stream_.read_message_max(kMaxMessage_bytes);
    stream_.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
      request.set(http::field::sec_websocket_protocol, subprotocols);
    }));
    websocket::response_type response;
    run([&](auto done) {
      stream_.async_handshake(response, address.host + ":" + address.port, address.path, done);
    });
    if (error_) return failed("does not answer as a WebSocket", error_);
    const std::string selected(response[http::field::sec_websocket_protocol]);
    if (!selected.empty() && (", " + subprotocols + ", ").find(", " + selected + ", ") != std::string::npos)
      return {};
    return unreadable(fmt::format("{}: the server supports none of {}", name_, subprotocols));
  }

  /// Begins something and waits for its end; its error is in error_ then.
  template <typename Begin>
  void run(const Begin& begin) {
    bool ended = false;
    begin([this, &ended](beast::error_code code) {
      error_ = code;
      ended = true;
    });
    context_.restart();
    while (!ended && context_.run_one() > 0) {
    }
  }

  void begin_reading() {
    reading_ = true;
    stream_.async_read(buffer_, [this](beast::error_code code, std::size_t) {
      reading_ = false;
      arrived_ = true;
      read_error_ = code;
    });
  }

  tl::unexpected<Error> failed(const char* what, beast::error_code error) const {
    return unreadable(fmt::format("{}: {}: {}", name_, what, error.message()));
  }

  std::string name_;
  boost::asio::io_context context_;
  beast::websocket::stream<beast::tcp_stream> stream_{context_};
  beast::flat_buffer buffer_;
  beast::error_code error_, read_error_;
  bool reading_ = false;  // a read is under way
  bool arrived_ = false;  // a read ended, and its message was not taken
};

}  // namespace

Result<std::unique_ptr<WebSocket>> WebSocket::connect(const FoxgloveAddress& address,
                                                      const std::string& subprotocols) {
  auto socket = std::make_unique<BeastWebSocket>(address);
  if (auto opened = socket->open(address, subprotocols); !opened) return tl::unexpected(opened.error());
  return socket;
}

}  // namespace sweepscope
