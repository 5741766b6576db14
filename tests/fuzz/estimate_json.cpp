// Estimates: what was read is written and read again as the same.
#include "core/results/estimate_json.hpp"

#include "tests/fuzz/memory_file.hpp"

int fuzz_estimate_json(const std::uint8_t* bytes, std::size_t size) {
  const auto estimate = sweepscope::parse_estimate_json(sweepscope::test::text_of(bytes, size), "f");
  sweepscope::test::expect_sentence(estimate);
  if (!estimate) return 0;
  const std::string json = estimate_to_json(*estimate);
  const auto again = sweepscope::parse_estimate_json(json, "again");
  if (!again || estimate_to_json(*again) != json) __builtin_trap();
  return 0;
}
