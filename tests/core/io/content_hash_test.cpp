#include "core/io/content_hash.hpp"

#include "core/io/atomic_file.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

using ContentHash = test::FolderTest;

TEST_F(ContentHash, OfAFileIsThatOfItsBytes) {
  ASSERT_TRUE(sweepscope::write_file(folder_ / "a", "hello"));
  EXPECT_EQ(file_content_hash(folder_ / "a").value(), content_hash("hello"));
  EXPECT_FALSE(file_content_hash(folder_ / "none"));
}

TEST_F(ContentHash, OfAFolderTellsContentsAndNamesApart) {
  const auto folder = folder_ / "bag";
  std::filesystem::create_directory(folder);
  ASSERT_TRUE(sweepscope::write_file(folder / "a", "one"));
  ASSERT_TRUE(sweepscope::write_file(folder / "b", "two"));
  ASSERT_TRUE(sweepscope::write_file(folder / "empty", ""));
  const std::string hash = file_content_hash(folder).value();
  EXPECT_EQ(file_content_hash(folder).value(), hash);
  ASSERT_TRUE(sweepscope::write_file(folder / "a", "One"));
  const std::string changed = file_content_hash(folder).value();
  EXPECT_NE(changed, hash);
  std::filesystem::rename(folder / "b", folder / "c");
  EXPECT_NE(file_content_hash(folder).value(), changed);
}

}  // namespace
}  // namespace sweepscope
