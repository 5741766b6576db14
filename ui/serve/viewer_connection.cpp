#include "ui/serve/viewer_connection.hpp"

#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <optional>
#include <utility>

#include "ui/serve/http/answer.hpp"

namespace sweepscope::ui {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kMaxHandshake(10), kMaxGoodbye(2);
constexpr std::size_t kMaxQueue = 64;

/// A page's WebSocket. What is sent waits in order, a frame behind the texts before it.
class Viewer final : public ViewerLink, public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(beast::tcp_stream stream, OpenConnection context)
      : stream_(std::move(stream)), context_(std::move(context)) {}

  void accept(const http::request<http::empty_body>& request) {
    beast::get_lowest_layer(stream_).expires_never();
    limit(kMaxHandshake);
    stream_.read_message_max(kMaxPageMessage_bytes);
    stream_.auto_fragment(false);  // a frame goes out at once, not in pieces of 4 KiB
    stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, std::string(kSubprotocol));
    }));
    stream_.async_accept(request, [self = shared_from_this()](beast::error_code failed) {
      if (!failed) self->begin();
    });
  }

  void send_text(std::string text) override { queue({std::move(text), false}); }
  void send_frame(std::string bytes) override { queue({std::move(bytes), true}); }
  bool is_sending() const override { return !waiting_.empty(); }

  void close(std::string_view why) override {
    reason_ = websocket::close_reason(websocket::close_code::policy_error,
                                      beast::string_view(why.data(), std::min<std::size_t>(why.size(), 100)));
    // Not from here: the hub is in the middle of something. One who does not even read is cut off.
    boost::asio::post(stream_.get_executor(), [self = shared_from_this()] { self->end(); });
  }

 private:
  struct Outgoing {
    std::string bytes;
    bool binary;
  };

  /// For the handshake at the beginning, and for that of the end.
  void limit(std::chrono::seconds handshake) {
    stream_.set_option(websocket::stream_base::timeout{handshake, std::chrono::seconds(60), true});
  }

  void begin() {
    limit(kMaxGoodbye);
    id_ = context_->hub.join(*this, Clock::now());
    if (!id_) {
      reason_ = websocket::close_reason(websocket::close_code::try_again_later, "too many viewers");
      return end();
    }
    context_->after();
    read();
  }

  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](beast::error_code failed, std::size_t) {
      self->arrived(failed);
    });
  }

  void arrived(beast::error_code failed) {
    if (failed) return leave(failed != websocket::error::closed);
    if (!stream_.got_text()) {
      close("only texts are read");
    } else {
      const auto data = buffer_.data();
      context_->hub.receive(*id_, {static_cast<const char*>(data.data()), data.size()}, Clock::now());
    }
    buffer_.consume(buffer_.size());
    context_->after();
    read();
  }

  void queue(Outgoing outgoing) {
    if (ending_) return;
    if (waiting_.size() >= kMaxQueue) return close("the page does not read");
    waiting_.push_back(std::move(outgoing));
    if (waiting_.size() == 1) write();
  }

  void write() {
    stream_.binary(waiting_.front().binary);
    stream_.async_write(
        boost::asio::buffer(waiting_.front().bytes),
        [self = shared_from_this()](beast::error_code failed, std::size_t) { self->written(failed); });
  }

  void written(beast::error_code failed) {
    waiting_.pop_front();
    if (failed || ending_) return;  // the read that is under way fails as well
    if (!waiting_.empty()) return write();
    context_->hub.pump(Clock::now());
    context_->after();
  }

  /// Says why, and waits for the page's answer no longer than for any write.
  void end() {
    if (std::exchange(ending_, true)) return;
    if (waiting_.empty()) {
      stream_.async_close(reason_, [self = shared_from_this()](beast::error_code) { self->leave(false); });
    } else {
      beast::get_lowest_layer(stream_).close();
    }
  }

  void leave(bool lost) {
    ending_ = true;
    if (!id_) return;
    context_->hub.leave(*std::exchange(id_, std::nullopt), lost, Clock::now());
    context_->after();
  }

  websocket::stream<beast::tcp_stream> stream_;
  OpenConnection context_;
  beast::flat_buffer buffer_;
  std::deque<Outgoing> waiting_;
  websocket::close_reason reason_;
  std::optional<int> id_;
  bool ending_ = false;
};

}  // namespace

void take_viewer(beast::tcp_stream stream, OpenConnection context,
                 const http::request<http::empty_body>& request) {
  std::make_shared<Viewer>(std::move(stream), std::move(context))->accept(request);
}

}  // namespace sweepscope::ui
