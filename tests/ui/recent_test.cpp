#include "ui/recent.hpp"

#include "tests/folder_test.hpp"

namespace sweepscope::ui {
namespace {

using Recent = test::FolderTest;

TEST_F(Recent, FilesAndFoldersAreRememberedAsLongAsTheyExist) {
  const auto list = folder_ / "state/recent";
  const std::string bag = folder_ / "a.bag", folder = folder_ / "ros2";
  std::ofstream(bag) << "bytes";
  std::filesystem::create_directory(folder);
  std::vector<std::string> recent = remember_recent(list, {}, bag);
  recent = remember_recent(list, recent, folder);
  EXPECT_EQ(recent, (std::vector<std::string>{folder, bag}));
  EXPECT_EQ(read_recent(list), recent);
  std::filesystem::remove(bag);
  EXPECT_EQ(read_recent(list), std::vector<std::string>{folder});
}

}  // namespace
}  // namespace sweepscope::ui
