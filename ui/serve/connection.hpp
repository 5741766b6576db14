#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <memory>
#include <string>

#include "ui/serve/http/access.hpp"
#include "ui/serve/hub.hpp"

namespace sweepscope::ui {

/// What every connection of a server uses. All of it belongs to the thread of the network.
struct ConnectionContext {
  Hub& hub;
  HostPolicy hosts;
  std::string token;
  /// After everything that may have changed what the hub waits for.
  std::function<void()> after;
  /// Writes files, for which the network does not wait.
  boost::asio::thread_pool& disk;
  std::chrono::milliseconds max_request{10000};  // until a request came whole, and between pieces of a file
  int open = 0;                                  // connections
};

/// A connection's use of the context: while it lives the connection is counted.
class OpenConnection {
 public:
  explicit OpenConnection(std::shared_ptr<ConnectionContext> context) : context_(std::move(context)) {
    ++context_->open;
  }
  OpenConnection(OpenConnection&&) = default;
  OpenConnection(const OpenConnection&) = delete;
  ~OpenConnection() {
    if (context_) --context_->open;
  }
  ConnectionContext& operator*() const { return *context_; }
  ConnectionContext* operator->() const { return context_.get(); }

 private:
  std::shared_ptr<ConnectionContext> context_;
};

/// Takes care of a connection until it ends: a request and its answer, a WebSocket, or a file that a page
/// sends. A request that does not come whole in time, or is longer than 8 KiB, ends it.
void take_connection(boost::asio::ip::tcp::socket socket, std::shared_ptr<ConnectionContext> context);

}  // namespace sweepscope::ui
