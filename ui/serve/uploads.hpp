#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ui/model/file_roots.hpp"
#include "ui/serve/protocol.hpp"

namespace sweepscope::ui {

/// A file that a page announced: it goes into the first folder of --root.
struct Upload {
  std::string id;
  int viewer = 0;
  std::filesystem::path path;
  std::uint64_t size_bytes = 0;
};

/// What pages may send, each once, under an address that cannot be guessed. The time is given.
class Uploads {
 public:
  using Time = std::chrono::steady_clock::time_point;
  explicit Uploads(const FileRoots& roots) : roots_(roots) {}

  /// The upload's id, which is good for a minute. Errors are sentences for the page: a name that is no plain
  /// name of a file, a file that is there already or on its way, too little space, too many at once.
  Result<std::string> announce(int viewer, const UploadMessage& message, Time now);
  /// Nothing if no such upload is waited for.
  std::optional<Upload> begin(std::string_view id, Time now);
  /// Whole or not, it is over. Call it for everything that begin returned.
  void end(const std::string& id);

 private:
  struct Announced {
    Upload upload;
    Time expires;
    bool running = false;
  };
  Result<std::filesystem::path> place_of(const UploadMessage& message) const;

  const FileRoots& roots_;
  std::vector<Announced> announced_;
};

}  // namespace sweepscope::ui
