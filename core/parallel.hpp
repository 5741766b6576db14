#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace sweepscope {

/// Annotates for ThreadSanitizer the synchronisation inside libtbb: what happened before a loop is visible to
/// each of its pieces, and their results are visible after it. A no-op in every other build.
class LoopOrder {
 public:
#ifdef __SANITIZE_THREAD__
  LoopOrder() {
    __tsan_release(&begun_);
  }
  ~LoopOrder() {
    __tsan_acquire(&done_);
  }
  LoopOrder(const LoopOrder&) = delete;
  LoopOrder& operator=(const LoopOrder&) = delete;
  void begin_piece() {
    __tsan_acquire(&begun_);
  }
  void end_piece() {
    __tsan_release(&done_);
  }

 private:
  char begun_ = 0, done_ = 0;

 public:
#else
  void begin_piece() {}
  void end_piece() {}
#endif
  /// `body` as a piece of this loop; both must outlive it.
  template <typename Body>
  auto piece(const Body& body) {
    return [this, &body](const auto& at) {
      begin_piece();
      body(at);
      end_piece();
    };
  }
};

/// body(i) for every i in [0, count) on all cores, in any order: write each result to its own index, so that
/// the results are the same for any number of threads.
template <typename Body>
void for_each_index(std::size_t count, const Body& body) {
  LoopOrder order;
  tbb::parallel_for(std::size_t{0}, count, order.piece(body));
}

/// The same for a few indices of long work: each is a separate task, so that no thread is idle at the end.
template <typename Body>
void for_each_task(std::size_t count, const Body& body) {
  LoopOrder order;
  tbb::parallel_for(std::size_t{0}, count, order.piece(body), tbb::simple_partitioner());
}

/// body(block) for blocks of about `grain` indices that together cover [0, count): for loops whose indices
/// share something expensive to make. block.begin() and block.end() are the block's indices.
template <typename Index, typename Body>
void for_each_block(Index count, std::size_t grain, const Body& body) {
  LoopOrder order;
  tbb::parallel_for(tbb::blocked_range<Index>(0, count, grain), order.piece(body));
}

/// Sorts ascending, on all cores. Equal values must be identical, so that the result is the same for any
/// number of threads. With ThreadSanitizer, which would report races inside libtbb, one thread sorts.
template <typename Value>
void sort_in_parallel(std::vector<Value>& values) {
#ifdef __SANITIZE_THREAD__
  std::sort(values.begin(), values.end());
#else
  tbb::parallel_sort(values.begin(), values.end());
#endif
}

}  // namespace sweepscope
