// `--expect`: what is taken is a finite offset and a tolerance above 0, and its words mean the same.
#include "core/campaign/expected_offset.hpp"

#include <cmath>

#include "tests/fuzz/memory_file.hpp"

int fuzz_expected_offset(const std::uint8_t* bytes, std::size_t size) {
  using namespace sweepscope;
  const auto expected = parse_expected_offset(test::text_of(bytes, size));
  test::expect_sentence(expected);
  if (!expected) return 0;
  if (!std::isfinite(expected->offset_ms) || !(expected->tolerance_ms > 0)) __builtin_trap();
  const auto again = parse_expected_offset(expected->words());
  if (!again || again->offset_ms != expected->offset_ms || again->tolerance_ms != expected->tolerance_ms)
    __builtin_trap();
  return 0;
}
