#pragma once

#include <filesystem>

namespace sweepscope {

/// Creates a file that did not exist (O_EXCL) with the permissions of the umask, opens it for writing and
/// remembers it until it is forgotten. Returns its descriptor, or -1 with errno.
int create_unfinished(const std::filesystem::path& path);

/// Remembers a file that the caller created, until it is forgotten.
void remember_unfinished(const std::filesystem::path& path);
void forget_unfinished(const std::filesystem::path& path);

/// Removes the remembered files. Call it last, in a program that ends without returning to their writers:
/// every other function here waits forever from then on, so that no new file is created.
void remove_unfinished_files();

}  // namespace sweepscope
