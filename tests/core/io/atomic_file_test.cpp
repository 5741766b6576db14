#include "core/io/atomic_file.hpp"

#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <thread>
#include <vector>

#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

using AtomicFileTest = test::FolderTest;
using test::contents_of;

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  return names;
}

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
  ASSERT_TRUE(sweepscope::write_file(path, "old"));
  { ASSERT_TRUE(AtomicFile::create(path)->write("new")); }
  EXPECT_EQ(contents_of(path), "old");
  EXPECT_EQ(files_in(folder_), std::vector<std::string>{"out.txt"});
}

TEST_F(AtomicFileTest, NeverTouchesAPartFileOfSomeoneElse) {
  std::ofstream(folder_ / "out.txt.part") << "mine";
  ASSERT_TRUE(sweepscope::write_file(folder_ / "out.txt", "new"));
  EXPECT_EQ(contents_of(folder_ / "out.txt.part"), "mine");
}

TEST_F(AtomicFileTest, OfSeveralWritersTheLastThatCommitsWinsWhole) {
  const auto path = folder_ / "out.txt";
  auto first = AtomicFile::create(path), second = AtomicFile::create(path);
  ASSERT_TRUE(first && second);
  ASSERT_TRUE(first->write("first, "));
  ASSERT_TRUE(second->write("second"));
  ASSERT_TRUE(first->write("and longer"));
  ASSERT_TRUE(second->commit());
  EXPECT_EQ(contents_of(path), "second");
  ASSERT_TRUE(first->commit());
  EXPECT_EQ(contents_of(path), "first, and longer");
  EXPECT_EQ(files_in(folder_), std::vector<std::string>{"out.txt"});
}

TEST_F(AtomicFileTest, FollowsLinksAndKeepsThem) {
  std::filesystem::create_directory(folder_ / "sub");
  std::ofstream(folder_ / "sub/there.txt") << "old";
  std::filesystem::create_symlink("sub/there.txt", folder_ / "link.txt");
  std::filesystem::create_symlink("sub/new.txt", folder_ / "dangling.txt");
  ASSERT_TRUE(sweepscope::write_file(folder_ / "link.txt", "a"));
  ASSERT_TRUE(sweepscope::write_file(folder_ / "dangling.txt", "b"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link.txt"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "dangling.txt"));
  EXPECT_EQ(contents_of(folder_ / "sub/there.txt"), "a");
  EXPECT_EQ(contents_of(folder_ / "sub/new.txt"), "b");
}

TEST_F(AtomicFileTest, ALoopOfLinksIsRefused) {
  std::filesystem::create_symlink("b", folder_ / "a");
  std::filesystem::create_symlink("a", folder_ / "b");
  const auto written = sweepscope::write_file(folder_ / "a", "x");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("symbolic links"), std::string::npos) << written.error().message;
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "a"));
}

TEST_F(AtomicFileTest, HandsOnThePermissionsOfTheFileThatItReplaces) {
  using std::filesystem::perms;
  const auto path = folder_ / "private.txt";
  std::ofstream(path) << "old";
  std::filesystem::permissions(path, perms::owner_read | perms::owner_write);
  ASSERT_TRUE(sweepscope::write_file(path, "new"));
  EXPECT_EQ(std::filesystem::status(path).permissions(), perms::owner_read | perms::owner_write);
}

TEST_F(AtomicFileTest, ADeviceAndAPipeAreWrittenInPlace) {
  ASSERT_TRUE(sweepscope::write_file("/dev/null", "x"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  const auto pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = contents_of(pipe); });
  EXPECT_TRUE(sweepscope::write_file(pipe, "through the pipe"));
  reader.join();
  EXPECT_EQ(read, "through the pipe");
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST_F(AtomicFileTest, ANameOfFullLengthCanBeWritten) {
  const auto path = folder_ / std::string(255, 'n');
  ASSERT_TRUE(sweepscope::write_file(path, "x"));
  EXPECT_EQ(contents_of(path), "x");
}

TEST_F(AtomicFileTest, WhatDoesNotReachTheDiskIsNotCommitted) {
  const auto written = sweepscope::write_file("/dev/full", "x");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message, "/dev/full: cannot be written: No space left on device");
}

TEST_F(AtomicFileTest, AMissingFolderIsNamedInOneSentence) {
  const auto path = folder_ / "missing" / "out.txt";
  const auto written = sweepscope::write_file(path, "x");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ExitCode::kWrongUsage);
  EXPECT_EQ(written.error().message, path.string() + ": cannot be created: No such file or directory");
}

TEST_F(AtomicFileTest, AFolderIsNotWrittenOver) {
  const auto written = sweepscope::write_file(folder_, "x");
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
  const auto written = sweepscope::write_file(path, std::string(100'000, 'x'));
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
