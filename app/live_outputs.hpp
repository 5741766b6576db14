#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/live/live_clouds.hpp"
#include "core/live/live_messages.hpp"
#include "core/live/offset_follower.hpp"
#include "ui/serve/foxglove_server.hpp"

namespace sweepscope::app {

/// The names of frames in live messages. The laser's own frame has a parent already in most systems, and a
/// frame has one parent only.
struct LiveFrames {
  std::string base = "base_link";
  std::string laser;
};

/// Where the clouds of `live` go.
class LiveOutput {
 public:
  virtual ~LiveOutput() = default;
  virtual Result<void> write(const LiveNews& news, const LiveFrames& frames) = 0;
  /// The offset of the clouds that follow; `stamp_ns`: of the newest scan.
  virtual Result<void> write(const FollowedOffset& offset, std::int64_t stamp_ns) = 0;
};

/// Lines on standard output.
std::unique_ptr<LiveOutput> live_lines();
/// A file for each cloud in a folder, which is made: 000000.pcd, 000001.pcd ...
Result<std::unique_ptr<LiveOutput>> live_folder(const std::filesystem::path& folder);
/// Messages.
std::unique_ptr<LiveOutput> live_published(std::unique_ptr<LivePublisher> publisher);
/// Messages for Foxglove clients; the publisher owns the server.
std::unique_ptr<LivePublisher> served_by(std::unique_ptr<ui::FoxgloveServer> server);

}  // namespace sweepscope::app
