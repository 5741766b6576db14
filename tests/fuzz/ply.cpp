// Maps as PLY.
#include "core/io/point_records.hpp"
#include "tests/fuzz/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  sweepscope::test::expect_sentence(sweepscope::parse_ply(sweepscope::test::text_of(bytes, size), "f"));
  return 0;
}
