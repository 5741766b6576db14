#pragma once

#include <string>

#include "core/recording/messages/messages.hpp"

namespace sweepscope {

/// A topic as a recording describes it.
struct MessageTopic {
  std::string name, type;
  Encoding encoding = Encoding::kRos1;
  bool decodable = true;        // false: the encoding is another one; its messages are only counted
  std::string md5sum = "*";     // of the ROS 1 definition; "*" if unknown
  std::string definition = "";  // of the type; may be empty
};

}  // namespace sweepscope
