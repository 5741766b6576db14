// ROS 2 bags in SQLite databases, whole: the database, CDR messages, and the recording made of them.
#include "core/recording/formats/read_recording.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/scratch_folder.hpp"

int fuzz_sqlite_bag(const std::uint8_t* bytes, std::size_t size) {
  static const sweepscope::test::ScratchFolder folder(sweepscope::test::folder_in_memory());
  const auto path = folder / "bag.db3";  // SQLite needs a file with a name
  sweepscope::test::write_file(path, sweepscope::test::text_of(bytes, size));
  sweepscope::test::expect_sentence(sweepscope::read_recording(path, {}, sweepscope::Job()));
  return 0;
}
