#pragma once

#include <memory>

#include "core/live/live_source.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

/// Whether this build can listen to a running ROS 1 system: it was made where roscpp is installed.
bool ros_source_is_built();

/// Listens to a running ROS 1 system (the one of ROS_MASTER_URI): subscribes to every topic, also to those
/// that come later, whose type can be a laser's or a motor's and that the rig does not rule out. Fails where
/// no master answers, or this build has no ROS. The rig must outlive the source.
Result<std::unique_ptr<LiveSource>> open_ros_source(const Rig& rig);

}  // namespace sweepscope
