#pragma once

#ifdef __SANITIZE_THREAD__
#include <algorithm>
#else
#include <tbb/parallel_sort.h>
#endif

#include <vector>

namespace sweepscope {

/// Ascending, on all cores. Equal values must be the same in everything, so that the result is for any number
/// of threads. ThreadSanitizer would take every access of the sort inside libtbb, whose order it cannot see,
/// for a race: there one thread sorts.
template <typename Value>
void sort_in_parallel(std::vector<Value>& values) {
#ifdef __SANITIZE_THREAD__
  std::sort(values.begin(), values.end());
#else
  tbb::parallel_sort(values.begin(), values.end());
#endif
}

}  // namespace sweepscope
