#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/recording/streams/message_stream.hpp"
#include "ui/serve/http/access.hpp"
#include "ui/serve/http/address.hpp"
#include "ui/serve/http/answer.hpp"

namespace sweepscope::ui {

/// Who may connect to a Foxglove server.
struct FoxgloveAccess {
  HostPolicy hosts;
  std::vector<std::string> origins;  // of pages, such as https://app.foxglove.dev
};

/// The subprotocol that is selected for a client; otherwise why it is refused. A program that is no browser
/// sends no Origin; a page of a browser needs one that is listed.
struct FoxgloveAnswer {
  std::string_view subprotocol = {};
  unsigned status = 101;
  std::string_view why = {};
};
FoxgloveAnswer foxglove_answer(const Request& request, const FoxgloveAccess& access);

/// A server of the Foxglove WebSocket protocol with a fixed list of topics, in a thread of its own. A client
/// that reads too slowly misses messages; memory stays bounded.
class FoxgloveServer {
 public:
  struct Options {
    ListenAddress address;
    FoxgloveAccess access;
    std::string name = "sweepscope live";
    std::vector<StreamTopic> topics;
    std::size_t kept_topic = 0;  // whose last message later subscribers get
  };
  /// An address that cannot be used is ExitCode::kWrongUsage.
  static Result<std::unique_ptr<FoxgloveServer>> start(Options options);
  ~FoxgloveServer();
  FoxgloveServer(const FoxgloveServer&) = delete;
  FoxgloveServer& operator=(const FoxgloveServer&) = delete;

  /// With the port that it has.
  const ListenAddress& address() const;
  /// Sends a message of a topic to its subscribers.
  void publish(std::size_t topic, std::int64_t log_ns, std::string bytes);

 private:
  struct Parts;
  explicit FoxgloveServer(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace sweepscope::ui
