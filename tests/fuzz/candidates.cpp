// Files of candidates: what was read is written and read again as the same. The input's lines are sealed, or
// no change would get past the hashes.
#include "core/results/candidate_file.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/sealed_lines.hpp"

namespace {

void check_candidates(std::string_view text) {
  const auto held = sweepscope::parse_candidates(text, "f");
  sweepscope::test::expect_sentence(held);
  if (!held) return;
  const std::string written = candidates_text(held->search, held->points);
  const auto again = sweepscope::parse_candidates(written, "again");
  if (!again || candidates_text(again->search, again->points) != written) __builtin_trap();
}

}  // namespace

int fuzz_candidates(const std::uint8_t* bytes, std::size_t size) {
  const auto text = sweepscope::test::text_of(bytes, size);
  check_candidates(text);
  check_candidates(sweepscope::test::sealed_lines(text));
  return 0;
}
