#include "core/io/candidate_file.hpp"

#include <limits>

#include "tests/core/io/test_files.hpp"

namespace sweepscope {
namespace {

class CandidateFiles : public test::FolderTest {
 protected:
  static CandidateSearch search() {
    CandidateSearch search;
    search.program = "p";
    search.recording = "walk.bag";
    search.recording_hash = "h";
    search.options = {"--range=1:3:1"};
    search.shard = Shard{1, 2};
    return search;
  }
  static CurvePoint point(double offset_s, double e_m) {
    CurvePoint point;
    point.offset_s = offset_s;
    point.n = 12345;
    point.e_m = e_m;
    return point;
  }
  std::filesystem::path path() const { return folder_ / "kept.candidates"; }
  std::unique_ptr<CandidateFile> opened() const {
    auto file = CandidateFile::open(path(), search());
    EXPECT_TRUE(file) << file.error().message;
    return file ? std::move(*file) : nullptr;
  }
};

TEST_F(CandidateFiles, ValuesComeBackToTheLastBit) {
  const double odd = 0.1 + 1e-17, third = 1.0 / 3;
  opened()->keep(point(0.0237, third));
  opened()->keep(point(-0.0005, std::nextafter(odd, 1.0)));
  opened()->keep(point(0.001, std::numeric_limits<double>::infinity()));
  const auto file = opened();
  EXPECT_EQ(file->taken_up(), 3U);
  EXPECT_EQ(file->find(23700000 * 1e-9)->e_m, third);
  EXPECT_EQ(file->find(-500000 * 1e-9)->e_m, std::nextafter(odd, 1.0));
  EXPECT_EQ(file->find(1000000 * 1e-9)->e_m, std::numeric_limits<double>::infinity());
  EXPECT_EQ(file->find(23700000 * 1e-9)->n, 12345);
  EXPECT_FALSE(file->find(23700000 * 1e-9)->d);
  EXPECT_FALSE(file->find(0.5));
}

TEST_F(CandidateFiles, AnyTruncationIsTakenUpWithTheWholeLinesBeforeIt) {
  const std::string text = candidates_text(search(), {point(0.001, 0.5), point(0.002, 0.25)});
  const std::size_t header = text.find('\n') + 1, first = text.find('\n', header) + 1;
  for (std::size_t size = 0; size <= text.size(); ++size) {
    std::ofstream(path(), std::ios::binary) << text.substr(0, size);
    const std::size_t whole = size == text.size() ? 2 : size >= first ? 1 : 0;
    const auto file = opened();
    ASSERT_NE(file, nullptr) << size;
    EXPECT_EQ(file->taken_up(), whole) << size;
    file->keep(point(0.002, 0.25));
    const auto read = read_candidates(path());
    ASSERT_TRUE(read) << size << read.error().message;
    EXPECT_EQ(read->whole_bytes, std::filesystem::file_size(path())) << size;
  }
}

TEST_F(CandidateFiles, WhatIsNoSuchFileIsRefusedAndUntouched) {
  for (const char* text :
       {"#ROSBAG V2.0\nabc", "hello", "{}\n", "{\"schema\": \"other\"}\n", "null\n", "[1]\n"}) {
    std::ofstream(path(), std::ios::binary) << text;
    const auto file = CandidateFile::open(path(), search());
    ASSERT_FALSE(file) << text;
    EXPECT_EQ(file.error().code, ExitCode::kUnreadableInput);
    EXPECT_EQ(test::contents_of(path()), text);
  }
}

TEST_F(CandidateFiles, ABrokenLineInTheMiddleIsRefusedWithItsNumber) {
  const std::string text = candidates_text(search(), {point(0.001, 0.5)});
  const auto refused = parse_candidates(text + "{\"offset_ns\":\n" + text.substr(text.find('\n') + 1), "f");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "f: line 3: not a candidate");
  for (const char* offset_ns : {"1e300", "0.5", "-9223372036854775807", "18446744073709551615", "null"}) {
    const auto wrong = parse_candidates(
        text + "{\"offset_ns\": " + offset_ns + "}\n" + text.substr(text.find('\n') + 1), "f");
    ASSERT_FALSE(wrong) << offset_ns;
    EXPECT_EQ(wrong.error().message, "f: line 3: not a candidate") << offset_ns;
  }
  const auto doubled = parse_candidates(
      text + candidates_text(search(), {point(0.001, 0.6)}).substr(text.find('\n') + 1), "f");
  ASSERT_FALSE(doubled);
  EXPECT_EQ(doubled.error().message, "f: line 3: the same offset again with other values");
}

TEST_F(CandidateFiles, AShardIsTwoWholeNumbers) {
  const std::string text = candidates_text(search(), {});
  const std::size_t at = text.find("[1,2]");
  ASSERT_NE(at, std::string::npos) << text;
  for (const char* shard : {"[4294967297,4294967298]", "[1e300,2]", "[1.5,2]", "[0,2]", "[3,2]", "[1,2,3]"}) {
    std::string wrong = text;
    EXPECT_FALSE(parse_candidates(wrong.replace(at, 5, shard), "f")) << shard;
  }
}

TEST_F(CandidateFiles, AFullDiskIsSaidAndWhatWasKeptStays) {
  std::filesystem::create_symlink("/dev/full", path());
  const auto file = CandidateFile::open(path(), search());
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, ExitCode::kWrongUsage);
}

TEST_F(CandidateFiles, ShardsTogetherHoldEveryCandidateOnce) {
  const std::vector<int> all{0, 1, 2, 3, 4, 5, 6};
  for (const int count : {1, 2, 3, 7, 9}) {
    std::vector<int> together;
    for (int number = 1; number <= count; ++number)
      for (const int one : Shard{number, count}.part_of(all)) together.push_back(one);
    std::sort(together.begin(), together.end());
    EXPECT_EQ(together, all) << count;
  }
}

}  // namespace
}  // namespace sweepscope
