#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/live/foxglove_protocol.hpp"

namespace sweepscope {

/// A message of a WebSocket.
struct WebSocketMessage {
  bool binary = false;
  std::vector<std::byte> bytes;
};

/// The client's side of a WebSocket, used by one thread. The only code of core that uses Boost.Beast.
class WebSocket {
 public:
  /// Connects within 5 s, and offers these subprotocols, of which the server must select one. Errors are
  /// ExitCode::kUnreadableInput and name the address.
  static Result<std::unique_ptr<WebSocket>> connect(const FoxgloveAddress& address,
                                                    const std::string& subprotocols);
  virtual ~WebSocket() = default;
  /// The next message, waiting at most this long; nothing if none came. An error once the connection ended.
  virtual Result<std::optional<WebSocketMessage>> receive(std::chrono::milliseconds max_wait) = 0;
  virtual Result<void> send(const std::string& text) = 0;
};

}  // namespace sweepscope
