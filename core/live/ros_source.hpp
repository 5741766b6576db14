#pragma once

#include <memory>

#include "core/live/live_messages.hpp"
#include "core/live/live_source.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

/// Whether this build can listen to a running ROS 1 system: true if roscpp was installed when it was built.
bool ros_source_is_built();

/// Listens to a running ROS 1 system (the one of ROS_MASTER_URI): subscribes to every topic, also to later
/// ones, whose type can be a laser's or a motor's and that the rig does not exclude. Fails if no master
/// answers or this build has no ROS. The rig must outlive the source.
Result<std::unique_ptr<LiveSource>> open_ros_source(const Rig& rig);

/// A running ROS 1 system that is listened to and published to.
struct RosSystem {
  std::unique_ptr<LiveSource> source;
  std::unique_ptr<LivePublisher> publisher;
};
/// The same, and publishes live_topics().
Result<RosSystem> open_ros_system(const Rig& rig);

}  // namespace sweepscope
