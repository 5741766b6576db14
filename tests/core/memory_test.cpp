#include "core/memory.hpp"

#include "tests/core/recording/test_bag.hpp"

namespace sweepscope {
namespace {

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

TEST(Memory, IsReadFromMeminfo) {
  const std::string text = "MemTotal:       24500000 kB\nMemAvailable:    2048 kB\nMemAvailableX: 7 kB\n";
  EXPECT_EQ(meminfo_bytes(text, "MemAvailable"), 2 * kMebibyte);
  EXPECT_EQ(meminfo_bytes(text, "MemFree"), std::nullopt);
  EXPECT_EQ(meminfo_bytes("MemAvailable: many\n", "MemAvailable"), std::nullopt);
  EXPECT_EQ(meminfo_bytes("", "MemAvailable"), std::nullopt);
}

TEST(Memory, TheNarrowestLimitCounts) {
  const test::ScratchFolder folder;
  MemorySources sources{folder / "meminfo", folder / "statm", folder / "group"};
  EXPECT_EQ(available_memory_bytes(sources), std::nullopt);
  test::write_file(folder / "meminfo", "MemAvailable: 4096 kB\n");
  EXPECT_EQ(available_memory_bytes(sources), 4 * kMebibyte);
  std::filesystem::create_directories(folder / "group" / "memory");
  test::write_file(folder / "group" / "memory.max", "max\n");
  EXPECT_EQ(available_memory_bytes(sources), 4 * kMebibyte);
  test::write_file(folder / "group" / "memory.max", "3145728\n");
  test::write_file(folder / "group" / "memory.current", "1048576\n");
  EXPECT_EQ(available_memory_bytes(sources), 2 * kMebibyte);
  test::write_file(folder / "group" / "memory.current", "4194304\n");
  EXPECT_EQ(available_memory_bytes(sources), 0U);
}

TEST(Memory, TheFirstVersionOfControlGroupsIsKnown) {
  const test::ScratchFolder folder;
  std::filesystem::create_directories(folder / "group" / "memory");
  test::write_file(folder / "group" / "memory" / "memory.limit_in_bytes", "3145728\n");
  test::write_file(folder / "group" / "memory" / "memory.usage_in_bytes", "1048576\n");
  EXPECT_EQ(available_memory_bytes({folder / "meminfo", folder / "statm", folder / "group"}), 2 * kMebibyte);
}

TEST(Memory, AWarningSaysBothNumbers) {
  EXPECT_EQ(memory_warning("a map", 3072 * kMebibyte, 1024 * kMebibyte),
            "a map needs about 3 GiB of memory, and 1 GiB are available");
  EXPECT_EQ(memory_warning("a map", kMebibyte, kMebibyte), std::nullopt);
  EXPECT_EQ(memory_warning("a map", kMebibyte, std::nullopt), std::nullopt);
}

}  // namespace
}  // namespace sweepscope
