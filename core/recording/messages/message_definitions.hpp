#pragma once

#include <string>
#include <string_view>

#include "core/recording/messages/messages.hpp"

namespace sweepscope {

/// The definition of a message that sweepscope writes, with those that it uses, as ROS 1 bags and MCAP's
/// schemas ("ros1msg", "ros2msg") hold it. `type` is in ROS 1's spelling or in ROS 2's; empty for other
/// types.
std::string message_definition(std::string_view type, Encoding encoding);

/// The members of a type that sweepscope knows, also of those that it only reads; empty for other types. The
/// name is in ROS 1's spelling.
std::string members_of(std::string_view type, Encoding encoding);

/// Whether these are only the first members, of a type whose versions differ in what follows.
bool only_beginning_known(std::string_view type);

}  // namespace sweepscope
