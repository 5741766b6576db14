#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "ui/serve/http/access.hpp"
#include "ui/serve/http/address.hpp"
#include "ui/serve/hub.hpp"
#include "ui/serve/mailbox.hpp"

namespace sweepscope::ui {

/// Serves the explorer's page and its WebSocket on one port, in a thread of its own. Pages are fetched by
/// anyone who reaches the port and names the server as it expects; pictures and input need the token.
class Server {
 public:
  struct Options {
    ListenAddress address;
    HostPolicy hosts;
    std::string token;
    Hub::Options hub;
    std::chrono::milliseconds max_request{10000};  // until a request came whole
  };
  /// `mailbox` must outlive it. Errors, of an address that cannot be used, are ExitCode::kWrongUsage.
  static Result<std::unique_ptr<Server>> start(Options options, Mailbox& mailbox);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// With the port that it has.
  const ListenAddress& address() const;
  bool has_viewers() const;
  /// With Hub::Options::once: whether the last viewer left.
  bool is_over() const;

  // From the thread of the explorer.
  /// Of several pictures that were not sent yet the last one counts.
  void show(ServedPicture picture);
  void tell(PageState state);
  void copy(std::string text);
  void offer(std::filesystem::path file);

 private:
  struct Parts;
  explicit Server(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace sweepscope::ui
