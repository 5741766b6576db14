// Rig files.
#include "core/recording/rig.hpp"
#include "tests/fuzz/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const sweepscope::test::MemoryFile file(bytes, size);
  sweepscope::test::expect_sentence(sweepscope::read_rig(file.path()));
  return 0;
}
