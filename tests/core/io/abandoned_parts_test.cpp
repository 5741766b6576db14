#include "core/io/abandoned_parts.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "core/io/atomic_file.hpp"
#include "core/io/atomic_folder.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

class AbandonedParts : public test::FolderTest {
 protected:
  /// Begins a file and a folder in another process, which is killed.
  void killed() const {
    const pid_t child = fork();
    if (child == 0) {
      auto file = AtomicFile::create(folder_ / "out.bag");
      auto folder = AtomicFolder::create(folder_ / "out");
      const bool begun = file && folder && file->write("half");
      std::ofstream(folder->part_path() / "inside") << "half";
      raise(begun ? SIGKILL : SIGTERM);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_EQ(WTERMSIG(status), SIGKILL);
  }
  std::size_t entries() const {
    return std::size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
};

TEST_F(AbandonedParts, OfAKilledProgramGoWithTheNextRun) {
  killed();
  ASSERT_EQ(entries(), 2U);
  remove_abandoned_parts(folder_ / "out.bag");
  EXPECT_EQ(entries(), 1U);
  remove_abandoned_parts(folder_ / "out/");
  EXPECT_EQ(entries(), 0U);
}

TEST_F(AbandonedParts, OfARunningProgramStay) {
  auto file = AtomicFile::create(folder_ / "out.bag");
  auto folder = AtomicFolder::create(folder_ / "out");
  ASSERT_TRUE(file && folder);
  remove_abandoned_parts(folder_ / "out.bag");
  remove_abandoned_parts(folder_ / "out");
  EXPECT_EQ(entries(), 2U);
  EXPECT_TRUE(file->commit());
  EXPECT_TRUE(folder->commit());
  EXPECT_TRUE(fs::exists(folder_ / "out.bag") && fs::exists(folder_ / "out"));
}

TEST_F(AbandonedParts, OtherFilesStay) {
  for (const char* name : {"out.bag", "other.bag.01234567.part", "out.bag.part", "out.bag.0123456.part",
                           "out.bag.01234567.part2", "out.part-12345"})
    std::ofstream(folder_ / name) << "kept";
  fs::create_symlink("out.bag", folder_ / "out.bag.89abcdef.part");
  remove_abandoned_parts(folder_ / "out.bag");
  remove_abandoned_parts(folder_ / "out");
  EXPECT_EQ(entries(), 7U);
}

}  // namespace
}  // namespace sweepscope
