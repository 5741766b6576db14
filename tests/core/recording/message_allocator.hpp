#pragma once

#include <memory>

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

}  // namespace sweepscope
