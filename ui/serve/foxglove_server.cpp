#include "ui/serve/foxglove_server.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <map>
#include <set>
#include <thread>
#include <utility>

#include "core/live/foxglove_protocol.hpp"
#include "ui/serve/http/listen.hpp"
#include "ui/serve/http/response.hpp"
#include "ui/serve/rate_limit.hpp"

namespace sweepscope::ui {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = asio::ip::tcp;

constexpr std::size_t kMaxSubscriptions = 64;
constexpr std::size_t kMaxQueued_bytes = std::size_t{32} << 20;  // of a client
constexpr std::size_t kMaxRequest_bytes = std::size_t{64} << 10;
constexpr std::chrono::seconds kMaxRequest(10);

struct Published {
  std::size_t topic = 0;
  std::int64_t log_ns = 0;
  std::string bytes;
};

class Client;

/// What the clients share. All of it belongs to the thread of the network.
struct Clients {
  FoxgloveServer::Options options;
  std::string greeting, channels;
  std::set<Client*> all;
  std::shared_ptr<const Published> kept;
};

/// A connection: a request, and then messages for its subscriptions.
class Client : public std::enable_shared_from_this<Client> {
 public:
  Client(Tcp::socket socket, std::shared_ptr<Clients> clients)
      : stream_(std::move(socket)), clients_(std::move(clients)) {
    clients_->all.insert(this);
  }
  Client(const Client&) = delete;
  ~Client() { clients_->all.erase(this); }

  void run() {
    parser_.header_limit(kMaxHeader_bytes);
    beast::get_lowest_layer(stream_).expires_after(kMaxRequest);
    http::async_read_header(beast::get_lowest_layer(stream_), buffer_, parser_,
                            [self = shared_from_this()](beast::error_code failed, std::size_t) {
                              if (!failed) self->answer();
                            });
  }

  void send(const std::shared_ptr<const Published>& message) {
    for (const auto& [id, topic] : subscribed_)
      if (topic == message->topic) queue({foxglove_message_head(id, message->log_ns), message});
  }

 private:
  /// A text, or what stands before a message.
  struct Outgoing {
    std::string head;
    std::shared_ptr<const Published> message = nullptr;
    std::size_t size() const { return head.size() + (message ? message->bytes.size() : 0); }
  };

  void answer() {
    const auto& request = parser_.get();
    const auto field = [&](http::field name) { return view(request[name]); };
    const FoxgloveAnswer answer =
        foxglove_answer({view(request.method_string()), view(request.target()), field(http::field::host),
                         field(http::field::origin), field(http::field::sec_websocket_protocol),
                         field(http::field::authorization), websocket::is_upgrade(request)},
                        clients_->options.access);
    if (answer.subprotocol.empty())
      return send_last(beast::get_lowest_layer(stream_), make_text_response(answer.status, answer.why),
                       "localhost", shared_from_this());
    beast::get_lowest_layer(stream_).expires_never();
    stream_.set_option(websocket::stream_base::timeout{kMaxRequest, std::chrono::seconds(60), true});
    stream_.read_message_max(kMaxRequest_bytes);
    stream_.auto_fragment(false);
    stream_.set_option(
        websocket::stream_base::decorator([name = answer.subprotocol](websocket::response_type& response) {
          response.set(http::field::sec_websocket_protocol, std::string(name));
        }));
    stream_.async_accept(parser_.get(), [self = shared_from_this()](beast::error_code failed) {
      if (!failed) self->begin();
    });
  }

  void begin() {
    buffer_.clear();
    queue({clients_->greeting});
    queue({clients_->channels});
    read();
  }

  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](beast::error_code failed, std::size_t) {
      if (!failed && self->take_request()) self->read();
    });
  }

  /// False: it is no longer listened to.
  bool take_request() {
    const auto data = buffer_.data();
    const std::string_view text(static_cast<const char*>(data.data()), data.size());
    const auto now = RateLimit::Time::clock::now();
    if (!requests_.take(1, now)) return close();
    const auto request = stream_.got_text() ? parse_foxglove_request(text) : std::optional<FoxgloveRequest>();
    buffer_.consume(buffer_.size());
    if (!request) return true;
    for (const std::uint32_t id : request->unsubscribed) subscribed_.erase(id);
    for (const FoxgloveSubscription& one : request->subscribed) subscribe(one);
    return true;
  }

  void subscribe(const FoxgloveSubscription& wanted) {
    if (wanted.channel == 0 || wanted.channel > clients_->options.topics.size() ||
        subscribed_.size() >= kMaxSubscriptions)
      return;
    const std::size_t topic = wanted.channel - 1;
    if (!subscribed_.emplace(wanted.id, topic).second) return;
    if (clients_->kept && topic == clients_->options.kept_topic)
      queue({foxglove_message_head(wanted.id, clients_->kept->log_ns), clients_->kept});
  }

  void queue(Outgoing outgoing) {
    if (queued_bytes_ + outgoing.size() > kMaxQueued_bytes) return;  // it reads too slowly
    queued_bytes_ += outgoing.size();
    waiting_.push_back(std::move(outgoing));
    if (waiting_.size() == 1) write();
  }

  void write() {
    const Outgoing& next = waiting_.front();
    stream_.binary(next.message != nullptr);
    const std::array<asio::const_buffer, 2> parts{
        asio::buffer(next.head), next.message ? asio::buffer(next.message->bytes) : asio::const_buffer()};
    stream_.async_write(
        parts, [self = shared_from_this()](beast::error_code failed, std::size_t) { self->written(failed); });
  }

  void written(beast::error_code failed) {
    queued_bytes_ -= waiting_.front().size();
    waiting_.pop_front();
    if (failed) return waiting_.clear();
    if (!waiting_.empty()) write();
  }

  bool close() {
    beast::get_lowest_layer(stream_).close();
    return false;
  }

  websocket::stream<beast::tcp_stream> stream_;
  std::shared_ptr<Clients> clients_;
  beast::flat_buffer buffer_;
  http::request_parser<http::empty_body> parser_;
  std::map<std::uint32_t, std::size_t> subscribed_;  // the topic of a subscription's id
  std::deque<Outgoing> waiting_;
  std::size_t queued_bytes_ = 0;
  RateLimit requests_{50, 200, RateLimit::Time::clock::now()};
};

}  // namespace

FoxgloveAnswer foxglove_answer(const Request& request, const FoxgloveAccess& access) {
  const auto refusal = [](unsigned status, std::string_view why) { return FoxgloveAnswer{{}, status, why}; };
  if (!is_own_host(request.host, access.hosts))
    return refusal(421, "This server is not reached by that name. See --host of sweepscope live.\n");
  if (!request.origin.empty() && std::ranges::count(access.origins, request.origin) == 0)
    return refusal(403, "A page of this origin may not connect. See --origin of sweepscope live.\n");
  if (!request.upgrade)
    return refusal(426, "This is a Foxglove WebSocket server: open it as a data source.\n");
  // As a list: "foxglove.sdk.v1, foxglove.websocket.v1".
  for (const std::string_view known : {"foxglove.sdk.v1", "foxglove.websocket.v1"}) {
    std::string_view rest = request.protocols;
    while (!rest.empty()) {
      const std::size_t comma = std::min(rest.find(','), rest.size());
      std::string_view entry = rest.substr(0, comma);
      rest.remove_prefix(std::min(comma + 1, rest.size()));
      while (entry.starts_with(' ')) entry.remove_prefix(1);
      while (entry.ends_with(' ')) entry.remove_suffix(1);
      if (entry == known) return {known};
    }
  }
  return refusal(400, "The subprotocols are foxglove.sdk.v1 and foxglove.websocket.v1.\n");
}

struct FoxgloveServer::Parts {
  explicit Parts(Options with) : clients(std::make_shared<Clients>()) {
    clients->greeting = foxglove_server_text(with.name);
    clients->channels = foxglove_advertise_text(with.topics);
    clients->options = std::move(with);
  }

  void accept() {
    acceptor.async_accept([this](boost::system::error_code failed, Tcp::socket socket) {
      if (failed == asio::error::operation_aborted) return;
      // One too many is closed at once.
      if (!failed && clients->all.size() < std::size_t{kMaxConnections}) {
        boost::system::error_code ignored;
        (void)socket.set_option(Tcp::no_delay(true), ignored);
        std::make_shared<Client>(std::move(socket), clients)->run();
      }
      accept();
    });
  }

  void send(const std::shared_ptr<const Published>& message) {
    if (message->topic == clients->options.kept_topic) clients->kept = message;
    for (Client* client : clients->all) client->send(message);
  }

  std::shared_ptr<Clients> clients;
  asio::io_context context{1};
  Tcp::acceptor acceptor{context};
  std::thread thread;
};

FoxgloveServer::FoxgloveServer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Result<std::unique_ptr<FoxgloveServer>> FoxgloveServer::start(Options options) {
  auto parts = std::make_unique<Parts>(std::move(options));
  if (const auto listens = listen(parts->acceptor, parts->clients->options.address); !listens)
    return tl::unexpected(listens.error());
  parts->accept();
  parts->thread = std::thread([&p = *parts] { p.context.run(); });
  return std::unique_ptr<FoxgloveServer>(new FoxgloveServer(std::move(parts)));
}

FoxgloveServer::~FoxgloveServer() {
  parts_->context.stop();
  parts_->thread.join();
}

const ListenAddress& FoxgloveServer::address() const {
  return parts_->clients->options.address;
}

void FoxgloveServer::publish(std::size_t topic, std::int64_t log_ns, std::string bytes) {
  auto message = std::make_shared<const Published>(Published{topic, log_ns, std::move(bytes)});
  asio::post(parts_->context, [&p = *parts_, message = std::move(message)] { p.send(message); });
}

}  // namespace sweepscope::ui
