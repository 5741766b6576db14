#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <cstdint>

#include "core/error.hpp"
#include "ui/serve/http/address.hpp"

namespace sweepscope::ui {

/// The limits of a server: of connections, and of what stands before a request's body.
inline constexpr int kMaxConnections = 64;
inline constexpr std::uint32_t kMaxHeader_bytes = 8 * 1024;

/// Listens there, and sets the port that it got. An address that cannot be used is ExitCode::kWrongUsage.
Result<void> listen(boost::asio::ip::tcp::acceptor& acceptor, ListenAddress& address);

}  // namespace sweepscope::ui
