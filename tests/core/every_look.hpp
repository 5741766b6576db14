#pragma once

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/job.hpp"

namespace sweepscope::test {

/// Some of the looks 1 to `count`: the first ten, the last ones, where work concludes, and about `between` of
/// those between them, evenly.
inline std::vector<std::uint64_t> chosen_looks(std::uint64_t count, std::uint64_t between,
                                               std::uint64_t last) {
  constexpr std::uint64_t kFirst = 10;
  const std::uint64_t stride = std::max<std::uint64_t>(1, count / between);
  std::vector<std::uint64_t> looks;
  for (std::uint64_t look = 1; look <= count; ++look)
    if (look <= kFirst || look + last > count || look % stride == 0) looks.push_back(look);
  return looks;
}

/// Does the work with a job that is cancelled when the work looks at it for the k-th time, for many k, on one
/// thread and on two. `work` gives the answer as text, and none where it says that it was interrupted: that
/// is to be so wherever a look found the job cancelled, and the answer is to be the whole one everywhere
/// else.
template <typename Work>
void expect_interrupted_at_every_look(std::uint64_t between, const Work& work) {
  for (const std::size_t threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    LookCount all(std::numeric_limits<std::uint64_t>::max());
    Job whole;
    whole.obey(all);
    const std::optional<std::string> answer = work(whole);
    ASSERT_TRUE(answer);
    ASSERT_GT(all.looks(), 0U);
    // On two threads the looks come in any order: the last ones are no other than those before.
    for (const std::uint64_t look : chosen_looks(all.looks(), between, threads == 1 ? 25 : 5)) {
      LookCount looks(look);
      Job job;
      job.obey(looks);
      const std::optional<std::string> said = work(job);
      const bool cancelled = looks.looks() >= look;
      ASSERT_EQ(said.has_value(), !cancelled) << "at look " << look << " of " << all.looks();
      ASSERT_EQ(said.value_or(*answer), *answer) << "at look " << look;
    }
  }
}

}  // namespace sweepscope::test
