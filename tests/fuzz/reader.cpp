// Readers that give a value or refuse with a sentence; FUZZ_READER, which the build defines, is the target's
// name.
#include "core/io/point_records.hpp"
#include "core/io/trajectory_file.hpp"
#include "core/recording/formats/read_recording.hpp"
#include "core/recording/rig.hpp"
#include "tests/fuzz/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace sweepscope;
  constexpr std::string_view kReader = FUZZ_READER;
  const std::string_view text = test::text_of(bytes, size);
  if constexpr (kReader == "pcd") {
    test::expect_sentence(parse_pcd(text, "f"));
  } else if constexpr (kReader == "ply") {
    test::expect_sentence(parse_ply(text, "f"));
  } else if constexpr (kReader == "trajectory") {
    test::expect_sentence(read_tum(test::MemoryFile(bytes, size).path()));
  } else if constexpr (kReader == "rig") {
    test::expect_sentence(read_rig(test::MemoryFile(bytes, size).path()));
  } else {  // whole bags: records, chunks and their compression, messages, and the recording made of them
    test::expect_sentence(read_recording(test::MemoryFile(bytes, size).path(), {}, Job()));
  }
  return 0;
}
