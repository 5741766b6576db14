#include "app/memory.hpp"

#include <malloc.h>

namespace sweepscope::app {

void return_memory() {
  constexpr int kKept_bytes = 1 << 20, kMaxArenas = 4;
  mallopt(M_MMAP_THRESHOLD, kKept_bytes);
  mallopt(M_ARENA_MAX, kMaxArenas);
}

void reuse_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
}

}  // namespace sweepscope::app
