#include "core/io/unfinished_files.hpp"

#include <cstdio>
#include <mutex>
#include <set>

namespace sweepscope {
namespace {

struct Unfinished {
  std::mutex mutex;
  std::multiset<std::filesystem::path> paths;
};

// Never destroyed: another thread may end the program while it is in use.
Unfinished& unfinished() {
  static Unfinished* const all = new Unfinished;
  return *all;
}

}  // namespace

void remember_unfinished(const std::filesystem::path& path) {
  const std::lock_guard lock(unfinished().mutex);
  unfinished().paths.insert(path);
}

void forget_unfinished(const std::filesystem::path& path) {
  const std::lock_guard lock(unfinished().mutex);
  const auto found = unfinished().paths.find(path);
  if (found != unfinished().paths.end()) unfinished().paths.erase(found);
}

void remove_unfinished_files() {
  const std::lock_guard lock(unfinished().mutex);
  for (const auto& path : unfinished().paths) std::remove(path.c_str());
}

}  // namespace sweepscope
