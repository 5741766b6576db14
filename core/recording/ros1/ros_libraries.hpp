#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace sweepscope {

/// ROS's headers ask their allocator for rebind, which C++20's standard allocator no longer has.
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

/// While it lives, ROS's libraries keep what they keep in a folder of ours (ROS_HOME), which goes with it:
/// rosbag looks for its plugins with rospack, which else makes ~/.ros for a cache, and complains on stderr
/// where it cannot.
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
