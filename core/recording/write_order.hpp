#pragma once

#include <cstdint>
#include <vector>

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// A scan, a whole cloud or a joint's sample that is to be written.
struct WrittenMessage {
  std::int64_t receive_ns = 0;
  bool is_scan = false;  // or a cloud
  std::size_t number = 0;
};

/// All messages in the order in which they were received, or made where that is not known; of equal times
/// scans come first. Of clouds these are the clouds themselves: RawLaser::clouds.
std::vector<WrittenMessage> write_order(const RawLaser& laser, const RawJoint& joint);

}  // namespace sweepscope
