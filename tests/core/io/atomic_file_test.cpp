#include "core/io/atomic_file.hpp"

#include <sys/resource.h>

#include <csignal>

#include "tests/core/io/test_files.hpp"

namespace sweepscope {
namespace {

using AtomicFileTest = test::FolderTest;
using test::contents_of;

TEST_F(AtomicFileTest, AppearsOnlyOnCommit) {
  const auto path = folder_ / "out.txt";
  auto file = AtomicFile::create(path);
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->write("hello"));
  EXPECT_FALSE(std::filesystem::exists(path));
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(contents_of(path), "hello");
}

TEST_F(AtomicFileTest, WithoutCommitLeavesTheOldFileAndNothingBeside) {
  const auto path = folder_ / "out.txt";
  ASSERT_TRUE(write_file(path, "old"));
  { ASSERT_TRUE(AtomicFile::create(path)->write("new")); }
  EXPECT_EQ(contents_of(path), "old");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.txt.part"));
}

TEST_F(AtomicFileTest, AMissingFolderIsNamedInOneSentence) {
  const auto path = folder_ / "missing" / "out.txt";
  const auto written = write_file(path, "x");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ExitCode::kWrongUsage);
  EXPECT_EQ(written.error().message, path.string() + ": cannot be created: No such file or directory");
}

TEST_F(AtomicFileTest, AFolderIsNotWrittenOver) {
  const auto written = write_file(folder_, "x");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("it is a folder"), std::string::npos);
}

TEST_F(AtomicFileTest, AFullDiskIsAnErrorThatLeavesNothingBehind) {
  // A limit on the file size fails writes half-way, as a full disk does.
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = 4096;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto path = folder_ / "big.bin";
  const auto written = write_file(path, std::string(100'000, 'x'));
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("cannot be written: File too large"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(AtomicFileTest, ReadingRefusesWhatIsNotARegularFile) {
  EXPECT_FALSE(read_file(folder_));
  EXPECT_FALSE(read_file("/dev/zero"));
  EXPECT_EQ(read_file(folder_ / "none").error().message, (folder_ / "none").string() + ": no such file");
}

}  // namespace
}  // namespace sweepscope
