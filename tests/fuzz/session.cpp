// Sessions of the explorer: what was read is written and read again as the same.
#include "ui/state/session.hpp"

#include "tests/fuzz/memory_file.hpp"

int fuzz_session(const std::uint8_t* bytes, std::size_t size) {
  const auto session = sweepscope::ui::parse_session(sweepscope::test::text_of(bytes, size), "f");
  sweepscope::test::expect_sentence(session);
  if (!session) return 0;
  const std::string json = session_to_json(*session);
  const auto again = sweepscope::ui::parse_session(json, "again");
  if (!again || session_to_json(*again) != json) __builtin_trap();
  return 0;
}
