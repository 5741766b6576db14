#include "core/recording/packed/unpacking_limit.hpp"

#include <bzlib.h>

#include "core/recording/formats/read_raw_recording.hpp"
#include "tests/core/recording/test_bag.hpp"
#include "tests/core/recording/test_database.hpp"
#include "tests/core/recording/zstd_bytes.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kBomb_bytes = std::size_t{150} << 20;  // two of them are refused

TEST(UnpackingLimit, SmallFilesMayUnpackFarBeyondTheirSize) {
  UnpackingLimit limit("a.bag", 10);
  EXPECT_FALSE(limit.take(kAlwaysUnpacked_bytes));
  const auto refused = limit.take(1);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->code, ExitCode::kUnreadableInput);
  EXPECT_EQ(refused->message,
            "a.bag: its 10 bytes unpack to more than 268435456 bytes, the limit for a file of this size; "
            "unpack it first if you trust it");
}

TEST(UnpackingLimit, LargeFilesMayUnpackToAMultipleOfTheirSize) {
  constexpr std::uint64_t kPacked_bytes = 10'000'000;
  UnpackingLimit limit("a.bag", kPacked_bytes);
  EXPECT_FALSE(limit.take(kMaxUnpackedPerPacked * kPacked_bytes));
  EXPECT_TRUE(limit.take(1));
  UnpackingLimit endless("a.bag", kMaxUnpacked_bytes);
  EXPECT_FALSE(endless.take(kMaxUnpacked_bytes));
  EXPECT_TRUE(endless.take(1));
}

TEST(UnpackingLimit, APartMayUnpackToOneByteMoreThanIsLeft) {
  UnpackingLimit limit("a.bag", 10);
  EXPECT_EQ(limit.max_bytes(1000), 1000U);
  EXPECT_FALSE(limit.take(kAlwaysUnpacked_bytes - 99));
  EXPECT_EQ(limit.max_bytes(1000), 100U);
  EXPECT_FALSE(limit.take(99));
  EXPECT_EQ(limit.max_bytes(1000), 1U);
}

/// Files of some hundred kilobytes that unpack to 300 MiB.
class UnpackingBombs : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_ / "tmp");
    setenv("TMPDIR", (folder_ / "tmp").c_str(), 1);
  }
  void TearDown() override { unsetenv("TMPDIR"); }
  void expect_refused(const std::string& name) const {
    const auto size = std::filesystem::file_size(folder_ / name);
    EXPECT_LT(size, 200'000U);
    const auto raw = read_raw_recording(folder_ / name, Rig(), Job());
    ASSERT_FALSE(raw) << name;
    EXPECT_EQ(raw.error().code, ExitCode::kUnreadableInput);
    EXPECT_EQ(raw.error().message.find((folder_ / name).string() + ": its " + std::to_string(size) +
                                       " bytes unpack to more than 268435456 bytes"),
              0U)
        << raw.error().message;
    EXPECT_TRUE(std::filesystem::is_empty(folder_ / "tmp"));
  }
  static std::string bomb(std::string beginning = "") {
    beginning.resize(kBomb_bytes);
    return test::packed_by_zstd(beginning);
  }

  test::ScratchFolder folder_;
};

TEST_F(UnpackingBombs, ABagOfChunksIsRefused) {
  std::string zeros(kBomb_bytes, '\0'), packed(1'000'000, '\0');
  auto bytes = static_cast<unsigned>(packed.size());
  ASSERT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &bytes, zeros.data(), static_cast<unsigned>(zeros.size()),
                                     9, 0, 0),
            BZ_OK);
  packed.resize(bytes);
  using test::RawBag;
  const std::string chunk = RawBag::chunk("bz2", kBomb_bytes, packed);
  test::write_file(folder_ / "a.bag", RawBag::magic() + RawBag::bag_header(0) + chunk + chunk);
  expect_refused("a.bag");
}

TEST_F(UnpackingBombs, AnMcapFileOfChunksIsRefused) {
  using test::RawBag;
  const std::string packed = bomb();
  const std::string content = RawBag::number(0, 16) + RawBag::number(kBomb_bytes, 8) + RawBag::number(0, 4) +
                              RawBag::number(4, 4) + "zstd" + RawBag::number(packed.size(), 8) + packed;
  const std::string chunk = "\x06" + RawBag::number(content.size(), 8) + content;
  test::write_file(folder_ / "a.mcap", "\x89MCAP0\r\n" + chunk + chunk);
  expect_refused("a.mcap");
}

TEST_F(UnpackingBombs, APackedFileIsRefused) {
  const std::string magic("SQLite format 3\0", 16);
  test::write_file(folder_ / "a.db3.zstd", bomb(magic) + bomb());
  expect_refused("a.db3.zstd");
}

TEST_F(UnpackingBombs, PackedMessagesAreRefused) {
  {
    test::TestDatabase database(folder_ / "a.db3");
    database.topic(1, "/scan", "sensor_msgs/msg/LaserScan");
    for (int i = 0; i < 2; ++i) database.message(1, 1 + i, bomb());
  }
  expect_refused("a.db3");
}

TEST_F(UnpackingBombs, PackedMessagesOfAPackedFileCountWithTheFile) {
  {
    test::TestDatabase database(folder_ / "plain");
    database.topic(1, "/scan", "sensor_msgs/msg/LaserScan");
    for (int i = 0; i < 2; ++i) database.message(1, 1 + i, bomb());
  }
  test::write_file(folder_ / "a.db3.zstd", test::packed_by_zstd(test::contents_of(folder_ / "plain")));
  expect_refused("a.db3.zstd");
}

}  // namespace
}  // namespace sweepscope
