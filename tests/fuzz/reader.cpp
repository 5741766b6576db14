// Readers that give a value or refuse with a sentence.
#include "core/io/point_records.hpp"
#include "core/io/trajectory_file.hpp"
#include "core/recording/formats/read_recording.hpp"
#include "core/recording/rig.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace test = sweepscope::test;

int fuzz_pcd(const std::uint8_t* bytes, std::size_t size) {
  test::expect_sentence(sweepscope::parse_pcd(test::text_of(bytes, size), "f"));
  return 0;
}

int fuzz_ply(const std::uint8_t* bytes, std::size_t size) {
  test::expect_sentence(sweepscope::parse_ply(test::text_of(bytes, size), "f"));
  return 0;
}

int fuzz_trajectory(const std::uint8_t* bytes, std::size_t size) {
  test::expect_sentence(sweepscope::read_tum(test::MemoryFile(bytes, size).path()));
  return 0;
}

int fuzz_rig(const std::uint8_t* bytes, std::size_t size) {
  test::expect_sentence(sweepscope::read_rig(test::MemoryFile(bytes, size).path()));
  return 0;
}

// Whole bags: records, chunks and their compression, messages, and the recording made of them.
int fuzz_ros1_bag(const std::uint8_t* bytes, std::size_t size) {
  test::expect_sentence(
      sweepscope::read_recording(test::MemoryFile(bytes, size).path(), {}, sweepscope::Job()));
  return 0;
}

int fuzz_mcap(const std::uint8_t* bytes, std::size_t size) {
  return fuzz_ros1_bag(bytes, size);
}
