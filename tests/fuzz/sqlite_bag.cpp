// ROS 2 bags in SQLite databases, whole: the database, CDR messages, and the recording made of them.
#include "core/recording/read_recording.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/scratch_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const sweepscope::test::ScratchFolder folder;  // SQLite wants a file with a name
  folder.write("bag.db3", sweepscope::test::text_of(bytes, size));
  sweepscope::test::expect_sentence(
      sweepscope::read_recording(folder.path() / "bag.db3", {}, sweepscope::Job()));
  return 0;
}
