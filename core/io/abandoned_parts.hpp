#pragma once

#include <filesystem>

namespace sweepscope {

/// Removes what killed programs left beside an output: the parts of AtomicFile and AtomicFolder of this name
/// that belong to this user and are not locked, as those of running programs are. What cannot be removed
/// stays.
void remove_abandoned_parts(const std::filesystem::path& output);

}  // namespace sweepscope
