#include "core/io/temporary_file.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <optional>
#include <vector>

#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

/// A folder for temporary files of our own.
class TemporaryFiles : public test::FolderTest {
 protected:
  void SetUp() override { setenv("TMPDIR", folder_.c_str(), 1); }
  void TearDown() override { unsetenv("TMPDIR"); }

  /// Makes a temporary file in another process, which then runs `end`. Gives the file's path.
  template <typename End>
  fs::path made_by_another(const End& end) const {
    int words[2];
    EXPECT_EQ(pipe(words), 0);
    const pid_t child = fork();
    if (child == 0) {
      const auto file = TemporaryFile::create();
      const std::string path = file ? file->path().string() : "";
      if (write(words[1], path.data(), path.size()) < 0) _exit(1);
      close(words[1]);
      end();
      _exit(1);
    }
    close(words[1]);
    char path[4096] = {};
    const ssize_t length = read(words[0], path, sizeof path - 1);
    close(words[0]);
    children_.push_back(child);
    return std::string(path, length > 0 ? std::size_t(length) : 0);
  }
  void kill_children() const {
    for (const pid_t child : children_) {
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
    }
    children_.clear();
  }

  mutable std::vector<pid_t> children_;
};

TEST_F(TemporaryFiles, GoWithTheirObject) {
  fs::path path;
  {
    const auto file = TemporaryFile::create();
    ASSERT_TRUE(file);
    path = file->path();
    EXPECT_TRUE(fs::exists(path));
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(TemporaryFiles, OfAProgramThatWasKilledAreRemovedByTheNext) {
  const fs::path path = made_by_another([] { pause(); });
  ASSERT_TRUE(fs::exists(path)) << path;
  remove_abandoned_temporary_files();
  EXPECT_TRUE(fs::exists(path)) << "its program lives";
  kill_children();
  EXPECT_TRUE(fs::exists(path)) << "nothing else removes it";
  const auto next = TemporaryFile::create();
  ASSERT_TRUE(next);
  EXPECT_FALSE(fs::exists(path));
  EXPECT_TRUE(fs::exists(next->path()));
}

TEST_F(TemporaryFiles, AreNotRemovedWhileTheyMoveBetweenObjects) {
  std::optional<TemporaryFile> kept;
  {
    auto file = TemporaryFile::create();
    ASSERT_TRUE(file);
    kept.emplace(std::move(*file));
  }
  remove_abandoned_temporary_files();
  EXPECT_TRUE(fs::exists(kept->path()));
}

TEST_F(TemporaryFiles, NothingElseIsRemoved) {
  const fs::path outside = folder_ / "outside";
  std::ofstream(outside) << "a person's";
  chmod(outside.c_str(), 0600);
  const std::string name = ".sweepscope-temporary-";
  fs::create_symlink(outside, folder_ / (name + "symlnk"));
  fs::create_hard_link(outside, folder_ / (name + "second"));
  fs::create_directory(folder_ / (name + "folder"));
  ASSERT_EQ(mkfifo((folder_ / (name + "a-pipe")).c_str(), 0600), 0);
  for (const std::string& other : {name + "longer1", name + "short", name + "public"}) {
    std::ofstream(folder_ / other) << "another's";
    chmod((folder_ / other).c_str(), other.ends_with("public") ? 0644 : 0600);
  }
  const auto before = test::files_in(folder_);
  remove_abandoned_temporary_files();
  EXPECT_TRUE(test::files_in(folder_) == before);
}

}  // namespace
}  // namespace sweepscope
