// Files of candidates: what was read is written and read again as the same. The input's lines are sealed, or
// no change would get past the hashes.
#include "core/results/candidate_file.hpp"
#include "core/results/sealed_line.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace {

std::string sealed(std::string_view text) {
  std::string whole;
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = text.find('\n', begin)) != text.npos; begin = end + 1)
    whole += end > begin ? sweepscope::sealed_line(text.substr(begin, end - begin)) : "\n";
  return whole.append(text.substr(begin));
}

void check(std::string_view text) {
  const auto held = sweepscope::parse_candidates(text, "f");
  sweepscope::test::expect_sentence(held);
  if (!held) return;
  const std::string written = candidates_text(held->search, held->points);
  const auto again = sweepscope::parse_candidates(written, "again");
  if (!again || candidates_text(again->search, again->points) != written) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const auto text = sweepscope::test::text_of(bytes, size);
  check(text);
  check(sealed(text));
  return 0;
}
