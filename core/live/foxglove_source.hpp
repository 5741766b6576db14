#pragma once

#include <memory>
#include <string>

#include "core/live/live_source.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

/// Listens to a server of the Foxglove WebSocket protocol, such as ROS 2's foxglove_bridge, at
/// ws://HOST[:PORT][/PATH]: subscribes to every channel, also to later ones, with ROS 1 or CDR messages whose
/// type can be a laser's or a motor's. A connection that ends is made again, at first after 0.1 s and then
/// after twice as long each time, up to 3 s. Messages that the server repeats are counted once, as in files.
///
/// Fails with ExitCode::kWrongUsage if `url` is no such address, and with kUnreadableInput if no such server
/// answers there. The rig must outlive the source.
Result<std::unique_ptr<LiveSource>> open_foxglove_source(const std::string& url, const Rig& rig);

}  // namespace sweepscope
