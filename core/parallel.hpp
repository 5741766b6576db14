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

/// Tells ThreadSanitizer what it cannot see inside libtbb: what came before a loop is known to every piece of
/// it, and what the pieces did is known after it. In every other build it does nothing.
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

/// body(i) for every i in [0, count) on all cores, in any order: a result belongs at an index of its own, so
/// that it is the same for any number of threads.
template <typename Body>
void for_each_index(std::size_t count, const Body& body) {
  LoopOrder order;
  tbb::parallel_for(std::size_t{0}, count, order.piece(body));
}

/// The same for few indices of long work: each is a task, since a run of several at the end would leave the
/// other threads idle.
template <typename Body>
void for_each_task(std::size_t count, const Body& body) {
  LoopOrder order;
  tbb::parallel_for(std::size_t{0}, count, order.piece(body), tbb::simple_partitioner());
}

/// body(block) for blocks of about `grain` indices that together cover [0, count): for loops whose indices
/// share what is dear to make. block.begin() and block.end() are the block's indices.
template <typename Index, typename Body>
void for_each_block(Index count, std::size_t grain, const Body& body) {
  LoopOrder order;
  tbb::parallel_for(tbb::blocked_range<Index>(0, count, grain), order.piece(body));
}

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
