#include "ui/serve/connection.hpp"

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <optional>
#include <utility>

#include "ui/serve/answer.hpp"

namespace sweepscope::ui {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = boost::asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using Context = std::shared_ptr<ConnectionContext>;

constexpr std::chrono::seconds kMaxHandshake(10), kMaxGoodbye(2);
constexpr std::chrono::minutes kMaxAnswer(30);  // of a large file over a slow link
constexpr std::uint32_t kMaxHeader_bytes = 8 * 1024;
constexpr std::size_t kMaxQueue = 64;

std::string_view view(beast::string_view text) {
  return {text.data(), text.size()};
}

/// Counts the connections that are open.
class Counted {
 public:
  explicit Counted(Context context) : context_(std::move(context)) { ++context_->open; }
  Counted(Counted&&) = default;
  Counted(const Counted&) = delete;
  ~Counted() {
    if (context_) --context_->open;
  }
  ConnectionContext& operator*() const { return *context_; }
  ConnectionContext* operator->() const { return context_.get(); }

 private:
  Context context_;
};

/// A page's WebSocket. What is sent waits in order, a frame behind the texts before it.
class Viewer final : public ViewerLink, public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(beast::tcp_stream stream, Counted context)
      : stream_(std::move(stream)), context_(std::move(context)) {}

  void accept(const http::request<http::empty_body>& request) {
    beast::get_lowest_layer(stream_).expires_never();
    limit(kMaxHandshake);
    stream_.read_message_max(kMaxPageMessage_bytes);
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
  Counted context_;
  beast::flat_buffer buffer_;
  std::deque<Outgoing> waiting_;
  websocket::close_reason reason_;
  std::optional<int> id_;
  bool ending_ = false;
};

/// A request and its answer.
class Exchange : public std::enable_shared_from_this<Exchange> {
 public:
  Exchange(Tcp::socket socket, Context context) : stream_(std::move(socket)), context_(std::move(context)) {}

  void run() {
    parser_.header_limit(kMaxHeader_bytes);
    parser_.body_limit(0);
    stream_.expires_after(context_->max_request);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](beast::error_code failed, std::size_t) {
                       if (!failed) self->answer();
                     });
  }

 private:
  void answer() {
    const auto& request = parser_.get();
    const auto field = [&](http::field name) { return view(request[name]); };
    const bool upgrade = websocket::is_upgrade(request);
    const Answer answer =
        answer_to({view(request.method_string()), view(request.target()), field(http::field::host),
                   field(http::field::origin), field(http::field::sec_websocket_protocol),
                   field(http::field::authorization), upgrade},
                  context_->hosts, context_->token);
    if (answer.kind == Answer::Kind::kWebSocket) {
      std::make_shared<Viewer>(std::move(stream_), std::move(context_))->accept(parser_.release());
    } else if (answer.kind == Answer::Kind::kDownload) {
      send_file(context_->hub.offered(answer.download_id));
    } else {
      auto response = std::make_shared<http::response<http::span_body<const char>>>(
          http::int_to_status(answer.status), 11);
      response->body() = {answer.body.data(), answer.body.size()};
      response->set(http::field::content_type, std::string(answer.type));
      send(response);
    }
  }

  void send_file(const std::optional<std::filesystem::path>& path) {
    auto response = std::make_shared<http::response<http::file_body>>(http::status::ok, 11);
    beast::error_code failed;
    if (path) response->body().open(path->c_str(), beast::file_mode::scan, failed);
    if (!path || failed) {
      auto none = std::make_shared<http::response<http::span_body<const char>>>(http::status::not_found, 11);
      static constexpr std::string_view kNone = "There is no such file any longer.\n";
      none->body() = {kNone.data(), kNone.size()};
      return send(none);
    }
    response->set(http::field::content_type, "application/octet-stream");
    response->set(http::field::content_disposition, "attachment");  // the address ends with the name
    send(response);
  }

  template <typename Response>
  void send(const std::shared_ptr<Response>& response) {
    const std::string host(view(parser_.get()[http::field::host]));
    const bool own = is_own_host(host, context_->hosts);
    response->set("Content-Security-Policy", security_policy(own ? host : "localhost"));
    response->set("X-Content-Type-Options", "nosniff");
    response->set("X-Frame-Options", "DENY");
    response->set("Referrer-Policy", "no-referrer");
    response->set("Cross-Origin-Opener-Policy", "same-origin");
    response->set("Cross-Origin-Resource-Policy", "same-origin");
    response->set(http::field::cache_control, "no-store");
    response->keep_alive(false);
    response->prepare_payload();
    stream_.expires_after(kMaxAnswer);
    http::async_write(stream_, *response,
                      [self = shared_from_this(), response](beast::error_code, std::size_t) {
                        beast::error_code ignored;
                        (void)self->stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
                      });
  }

  beast::tcp_stream stream_;
  Counted context_;
  beast::flat_buffer buffer_;
  http::request_parser<http::empty_body> parser_;
};

}  // namespace

void take_connection(Tcp::socket socket, Context context) {
  std::make_shared<Exchange>(std::move(socket), std::move(context))->run();
}

}  // namespace sweepscope::ui
