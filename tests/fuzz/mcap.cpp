// MCAP files, whole: records, chunks and their compression, CDR messages, and the recording made of them.
#include "core/recording/read_recording.hpp"
#include "tests/fuzz/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const sweepscope::test::MemoryFile file(bytes, size);
  sweepscope::test::expect_sentence(sweepscope::read_recording(file.path(), {}, sweepscope::Job()));
  return 0;
}
