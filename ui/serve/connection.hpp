#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <functional>
#include <memory>
#include <string>

#include "ui/serve/access.hpp"
#include "ui/serve/hub.hpp"

namespace sweepscope::ui {

/// What every connection of a server uses. All of it belongs to the thread of the network.
struct ConnectionContext {
  Hub& hub;
  HostPolicy hosts;
  std::string token;
  /// After everything that may have changed what the hub waits for.
  std::function<void()> after;
  std::chrono::milliseconds max_request{10000};  // until a request came whole
  int open = 0;                                  // connections
};

/// Takes care of a connection until it ends: a request and its answer, or a WebSocket. A request that does
/// not come whole in time, or is longer than 8 KiB, ends it.
void take_connection(boost::asio::ip::tcp::socket socket, std::shared_ptr<ConnectionContext> context);

}  // namespace sweepscope::ui
