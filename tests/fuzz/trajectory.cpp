// Trajectories as TUM.
#include "core/io/trajectory_file.hpp"
#include "tests/fuzz/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const sweepscope::test::MemoryFile file(bytes, size);
  sweepscope::test::expect_sentence(sweepscope::read_tum(file.path()));
  return 0;
}
