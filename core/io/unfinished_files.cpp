#include "core/io/unfinished_files.hpp"

#include <fcntl.h>

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

int create_unfinished(const std::filesystem::path& path) {
  const std::lock_guard lock(unfinished().mutex);
  const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor >= 0) unfinished().paths.insert(path);
  return descriptor;
}

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
  unfinished().mutex.lock();
  for (const auto& path : unfinished().paths) std::remove(path.c_str());
}

}  // namespace sweepscope
