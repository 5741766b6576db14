#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace sweepscope {

/// ROS's headers use their allocator's rebind, which C++20's standard allocator no longer has.
template <typename T>
struct MessageAllocator : std::allocator<T> {
  MessageAllocator() = default;
  template <typename U>
  MessageAllocator(const MessageAllocator<U>&) {}
  template <typename U>
  struct rebind {
    using other = MessageAllocator<U>;
  };
};

/// While it lives, ROS's libraries use a temporary folder (ROS_HOME), which is removed with it: rosbag looks
/// for its plugins with rospack, which would otherwise create ~/.ros as a cache, and print an error if it
/// cannot.
class RosHome {
 public:
  RosHome();
  ~RosHome();
  RosHome(const RosHome&) = delete;
  RosHome& operator=(const RosHome&) = delete;

 private:
  std::filesystem::path folder_;       // empty: none could be made
  std::optional<std::string> before_;  // what ROS_HOME was
};

}  // namespace sweepscope
