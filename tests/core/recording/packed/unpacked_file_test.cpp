#include "core/recording/packed/unpacked_file.hpp"

#include <sys/resource.h>

#include <csignal>
#include <cstdlib>

#include "tests/core/recording/test_bag.hpp"
#include "tests/core/recording/zstd_bytes.hpp"

namespace sweepscope {
namespace {

/// Random enough not to shrink to nothing.
std::string sample_text(std::size_t bytes) {
  std::string text(bytes, '\0');
  std::uint32_t state = 1;
  for (char& c : text) c = static_cast<char>((state = state * 1664525 + 1013904223) >> 28);
  return text;
}

/// A folder for temporary files of our own.
class UnpackedFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_ / "tmp");
    setenv("TMPDIR", (folder_ / "tmp").c_str(), 1);
  }
  void TearDown() override { unsetenv("TMPDIR"); }
  Result<UnpackedFile> unpack(const std::string& packed, const Job& job = Job(),
                              std::uint64_t max_bytes = kMaxUnpackedFile_bytes) const {
    test::write_file(folder_ / "packed", packed);
    return UnpackedFile::unpack(folder_ / "packed", job, max_bytes);
  }
  bool nothing_left() const { return std::filesystem::is_empty(folder_ / "tmp"); }

  test::ScratchFolder folder_;
};

TEST_F(UnpackedFiles, HoldWhatWasPackedAndGoWithTheirObject) {
  const std::string plain = sample_text(3'000'000);
  {
    const auto file = unpack(test::packed_by_zstd(plain));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->problem(), "");
    EXPECT_EQ(file->path().parent_path(), folder_ / "tmp");
    EXPECT_EQ(test::contents_of(file->path()), plain);
  }
  EXPECT_TRUE(nothing_left());
}

TEST_F(UnpackedFiles, AreWholeWhereTheyFillTheBufferToItsEnd) {
  for (const std::size_t buffers : {1, 2, 24}) {
    const std::string plain = sample_text(buffers * ZSTD_DStreamOutSize());
    const auto file = unpack(test::packed_by_zstd(plain));
    ASSERT_TRUE(file);
    EXPECT_EQ(file->problem(), "") << buffers;
    EXPECT_EQ(test::contents_of(file->path()), plain);
  }
}

TEST_F(UnpackedFiles, FramesFollowEachOther) {
  const auto file = unpack(test::packed_by_zstd("one ") + test::packed_by_zstd("after the other"));
  ASSERT_TRUE(file);
  EXPECT_EQ(file->problem(), "");
  EXPECT_EQ(test::contents_of(file->path()), "one after the other");
}

TEST_F(UnpackedFiles, WhatComesBeforeTheDamageIsThere) {
  const std::string plain = sample_text(3'000'000), packed = test::packed_by_zstd(plain);
  const auto cut = unpack(packed.substr(0, packed.size() / 2));
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->problem(), "its zstd data ends too early; the part that exists was read");
  const std::string left = test::contents_of(cut->path());
  EXPECT_GT(left.size(), plain.size() / 4);
  EXPECT_EQ(left, plain.substr(0, left.size()));
  const std::string no_block(200'000, '\xff');
  EXPECT_EQ(unpack(packed.substr(0, packed.size() / 2) + no_block)->problem(),
            "its zstd data is damaged; the part before the damage was read");
}

TEST_F(UnpackedFiles, ABombIsRefusedAtTheLimit) {
  const std::string bomb = test::packed_by_zstd(std::string(20'000'000, '\0'));
  ASSERT_LT(bomb.size(), 4'000U);
  EXPECT_TRUE(unpack(bomb, Job(), 20'000'000));
  const auto refused = unpack(bomb, Job(), 19'999'999);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ExitCode::kUnreadableInput);
  EXPECT_NE(refused.error().message.find("packed: unpacks to more than 19999999 bytes"), std::string::npos);
  EXPECT_TRUE(nothing_left());
}

TEST_F(UnpackedFiles, AFullDiskLeavesASentenceAndNothingElse) {
  const std::string packed = test::packed_by_zstd(std::string(20'000'000, '\0'));
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1'000'000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto refused = unpack(packed);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(refused.error().message.find("set TMPDIR to a folder with room"), std::string::npos);
  EXPECT_TRUE(nothing_left());
}

TEST_F(UnpackedFiles, AFolderThatIsNotThereIsNamed) {
  setenv("TMPDIR", (folder_ / "gone").c_str(), 1);
  const auto refused = unpack(test::packed_by_zstd("x"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(refused.error().message.find("set TMPDIR"), std::string::npos) << refused.error().message;
}

TEST_F(UnpackedFiles, ACancelledJobLeavesNothing) {
  Job job;
  job.cancel();
  const auto refused = unpack(test::packed_by_zstd(sample_text(100'000)), job);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ExitCode::kInterrupted);
  EXPECT_TRUE(nothing_left());
}

}  // namespace
}  // namespace sweepscope
