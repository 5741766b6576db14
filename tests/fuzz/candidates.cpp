// Files of candidates: what was read is written and read again as the same.
#include "core/io/candidate_file.hpp"
#include "tests/fuzz/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const auto held = sweepscope::parse_candidates(sweepscope::test::text_of(bytes, size), "f");
  sweepscope::test::expect_sentence(held);
  if (!held) return 0;
  const std::string text = candidates_text(held->search, held->points);
  const auto again = sweepscope::parse_candidates(text, "again");
  if (!again || candidates_text(again->search, again->points) != text) __builtin_trap();
  return 0;
}
