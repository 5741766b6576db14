#include "ui/serve/http/listen.hpp"

#include <fmt/format.h>

namespace sweepscope::ui {

Result<void> listen(boost::asio::ip::tcp::acceptor& acceptor, ListenAddress& address) {
  namespace asio = boost::asio;
  using Tcp = asio::ip::tcp;
  boost::system::error_code failed;
  const Tcp::endpoint place(asio::ip::make_address(address.host), address.port);
  // Each returns `failed` as well.
  (void)acceptor.open(place.protocol(), failed);
  if (!failed) (void)acceptor.set_option(Tcp::acceptor::reuse_address(true), failed);
  if (!failed) (void)acceptor.bind(place, failed);
  if (!failed) (void)acceptor.listen(asio::socket_base::max_listen_connections, failed);
  if (failed)
    return failure(
        ExitCode::kWrongUsage,
        fmt::format("--serve: cannot listen on {}: {}. Use another port, or 0 for a free one: --serve {}",
                    address.text(), failed.message(),
                    ListenAddress{address.host, 0, address.loopback}.text()));
  address.port = acceptor.local_endpoint().port();
  return {};
}

}  // namespace sweepscope::ui
