#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace sweepscope::ui {

/// Where a server listens.
struct ListenAddress {
  std::string host = "127.0.0.1";  // an IPv4 or IPv6 address, without brackets
  std::uint16_t port = 8717;       // 0: a free one
  bool loopback = true;            // only this machine reaches it

  /// "127.0.0.1:8717", "[::1]:8717"
  std::string text() const;
};

/// "PORT", ":PORT", "ADDRESS", "ADDRESS:PORT" or "[ADDRESS]:PORT", where ADDRESS is numbers or "localhost";
/// "" is the default, with this port. Errors are ExitCode::kWrongUsage.
Result<ListenAddress> parse_listen_address(std::string_view text, std::uint16_t port = ListenAddress().port);
/// The same; an address that other machines can reach is refused unless `anywhere`.
Result<ListenAddress> allowed_listen_address(std::string_view text, bool anywhere,
                                             std::uint16_t port = ListenAddress().port);

}  // namespace sweepscope::ui
