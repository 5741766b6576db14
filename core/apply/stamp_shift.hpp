#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "core/recording/messages/messages.hpp"

namespace sweepscope {

/// What became of one message's header stamps.
enum class StampShift {
  kShifted,
  kNone,        // the message has no stamp (0)
  kMalformed,   // left as it is
  kOutOfRange,  // the new stamp is before 1970 or beyond what the format holds; left as it is
};

/// Gives a stamp's new value; both in ns since 1970.
using StampMap = std::function<std::int64_t(std::int64_t ns)>;

/// Moves the header stamp of a serialised message where it lies; all other bytes stay. Of transforms only
/// those of the frame `joint`.
StampShift shift_header_stamps(MessageKind kind, Encoding encoding, const std::string& joint,
                               const StampMap& moved, std::span<std::byte> message);

/// Whether a cloud's points have times of their own since 1970, which its header's stamp does not move; as
/// CloudReader tells them.
bool has_absolute_times(Encoding encoding, std::span<const std::byte> cloud);

}  // namespace sweepscope
