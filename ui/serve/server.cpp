#include "ui/serve/server.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "ui/serve/connection.hpp"
#include "ui/serve/http/listen.hpp"

namespace sweepscope::ui {
namespace {

namespace asio = boost::asio;
using Tcp = asio::ip::tcp;
using Clock = std::chrono::steady_clock;

}  // namespace

struct Server::Parts {
  Parts(Options with, Mailbox& mailbox)
      : options(std::move(with)), hub(options.hub, mailbox), acceptor(context), timer(context) {
    connections = std::make_shared<ConnectionContext>(
        ConnectionContext{hub, options.hosts, options.token, [this] { after(); }, disk, options.max_request});
    connections_mailbox = &mailbox;
  }

  void accept() {
    acceptor.async_accept([this](boost::system::error_code failed, Tcp::socket socket) {
      if (failed == asio::error::operation_aborted) return;
      // One too many is closed at once.
      if (!failed && connections->open < kMaxConnections) {
        boost::system::error_code ignored;
        (void)socket.set_option(Tcp::no_delay(true), ignored);
        take_connection(std::move(socket), connections);
      }
      accept();
    });
  }

  /// Sets the timer to the hub's next task, and wakes the explorer's thread if there is news for it.
  void after() {
    const auto now = Clock::now();
    has_viewers = hub.viewers() > 0;
    connections_mailbox->set_sendable(hub.sendable_at(now));
    if (hub.is_over(now) && !over.exchange(true)) connections_mailbox->wake();
    const auto next = hub.next_wake(now);
    if (next == wakes_at || over) return;
    wakes_at = next;
    timer.cancel();
    if (!next) return;
    timer.expires_at(*next);
    timer.async_wait([this](boost::system::error_code failed) {
      if (failed) return;
      wakes_at.reset();
      hub.pump(Clock::now());
      after();
    });
  }

  void take_picture() {
    std::optional<ServedPicture> picture;
    {
      const std::lock_guard lock(mutex);
      picture = std::exchange(latest, std::nullopt);
    }
    if (!picture) return;
    hub.show(std::move(*picture), Clock::now());
    after();
  }

  Options options;
  Hub hub;  // outlives what waits in the next two
  asio::io_context context{1};
  asio::thread_pool disk{1};  // its handlers hold sockets of the context
  Mailbox* connections_mailbox = nullptr;
  std::shared_ptr<ConnectionContext> connections;
  Tcp::acceptor acceptor;
  asio::steady_timer timer;
  std::optional<Clock::time_point> wakes_at;
  std::atomic<bool> has_viewers{false}, over{false};
  std::mutex mutex;
  std::optional<ServedPicture> latest;
  std::thread thread;
};

Server::Server(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Result<std::unique_ptr<Server>> Server::start(Options options, Mailbox& mailbox) {
  auto parts = std::make_unique<Parts>(std::move(options), mailbox);
  if (const auto listens = listen(parts->acceptor, parts->options.address); !listens)
    return tl::unexpected(listens.error());
  parts->accept();
  parts->thread = std::thread([&p = *parts] { p.context.run(); });
  return std::unique_ptr<Server>(new Server(std::move(parts)));
}

Server::~Server() {
  parts_->context.stop();
  parts_->thread.join();
  parts_->disk.stop();
  parts_->disk.join();
}

const ListenAddress& Server::address() const {
  return parts_->options.address;
}

bool Server::has_viewers() const {
  return parts_->has_viewers;
}

bool Server::is_over() const {
  return parts_->over;
}

void Server::show(ServedPicture picture) {
  {
    const std::lock_guard lock(parts_->mutex);
    if (std::exchange(parts_->latest, std::move(picture))) return;  // the network will take this one instead
  }
  asio::post(parts_->context, [&p = *parts_] { p.take_picture(); });
}

void Server::tell(PageState state) {
  asio::post(parts_->context, [&p = *parts_, state = std::move(state)]() mutable {
    p.hub.tell(std::move(state));
    p.after();
  });
}

void Server::copy(std::string text) {
  asio::post(parts_->context, [&p = *parts_, text = std::move(text)] { p.hub.copy(text); });
}

void Server::offer(std::filesystem::path file) {
  asio::post(parts_->context, [&p = *parts_, file = std::move(file)] { p.hub.offer(file); });
}

}  // namespace sweepscope::ui
