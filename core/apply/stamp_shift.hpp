#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "core/recording/messages/messages.hpp"

namespace sweepscope {

/// The result of moving the header stamps of one message.
enum class StampShift {
  kShifted,
  kNone,        // the message has no stamp (0)
  kMalformed,   // left as it is
  kOutOfRange,  // the new stamp is before 1970 or beyond what the format holds; left as it is
};

/// From a stamp to the moved one; both in ns since 1970.
using StampMap = std::function<std::int64_t(std::int64_t ns)>;

/// Moves the header stamp of a serialised message in place; all other bytes stay as they are. Of transforms
/// only those of the frame `joint` are moved.
StampShift shift_header_stamps(MessageKind kind, Encoding encoding, const std::string& joint,
                               const StampMap& moved, std::span<std::byte> message);

/// The header's stamp of a message of a laser; absent if it is malformed or has none (0).
std::optional<std::int64_t> header_stamp_ns(MessageKind kind, Encoding encoding,
                                            std::span<const std::byte> message);

}  // namespace sweepscope
