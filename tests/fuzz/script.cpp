// Scripts of the explorer, and its command line --run.
#include "ui/script/script.hpp"

#include "tests/fuzz/memory_file.hpp"

int fuzz_script(const std::uint8_t* bytes, std::size_t size) {
  for (const bool semicolons : {false, true})
    sweepscope::test::expect_sentence(
        sweepscope::ui::parse_script(sweepscope::test::text_of(bytes, size), "f", semicolons));
  return 0;
}
