#include "core/results/candidate_file.hpp"
#include "core/results/sealed_line.hpp"

#include <fmt/format.h>

#include <limits>

#include "tests/folder_test.hpp"

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

TEST_F(CandidateFiles, ASoundLineThatIsNoCandidateIsRefusedWithItsNumber) {
  const std::string text = candidates_text(search(), {point(0.001, 0.5)});
  const std::string last = text.substr(text.find('\n') + 1);
  for (const char* offset_ns : {"1e300", "0.5", "-9223372036854775807", "18446744073709551615", "null"}) {
    const auto wrong =
        parse_candidates(text + sealed_line(std::string("{\"offset_ns\": ") + offset_ns + "}") + last, "f");
    ASSERT_FALSE(wrong) << offset_ns;
    EXPECT_EQ(wrong.error().message, "f: line 3: is not a candidate") << offset_ns;
  }
  const auto doubled = parse_candidates(
      text + candidates_text(search(), {point(0.001, 0.6)}).substr(text.find('\n') + 1), "f");
  ASSERT_FALSE(doubled);
  EXPECT_EQ(doubled.error().message, "f: line 3: duplicate offset with other values");
}

/// A file after a change is refused with a line's number, or holds the same points; a line's end that is lost
/// leaves the last one aside, as a kill does.
void expect_refused_or_the_same(const std::string& changed, const std::string& text,
                                const std::string& what) {
  const auto read = parse_candidates(changed, "f");
  if (!read) {
    EXPECT_EQ(read.error().code, ExitCode::kUnreadableInput) << what;
    EXPECT_EQ(read.error().message.rfind("f: ", 0), 0U) << what;
    return;
  }
  const std::string held = candidates_text(read->search, read->points);
  const bool unended = !changed.ends_with('\n');
  const std::size_t last = text.rfind('\n', text.size() - 2) + 1;
  EXPECT_EQ(held, unended ? text.substr(0, last) : text) << what;
}

TEST_F(CandidateFiles, EveryChangeOfAByteIsRefusedOrHarmless) {
  const std::string text = candidates_text(search(), {point(0.001, 0.5), point(0.002, 0.25)});
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (const int flip : {0x01, 0x02, 0x04, 0x08, 0x10, 0x20, 0x40, 0x80}) {
      std::string changed = text;
      changed[at] = static_cast<char>(changed[at] ^ flip);
      expect_refused_or_the_same(changed, text, fmt::format("bits {:#x} of byte {}", flip, at));
    }
    for (const char other : {'0', '1', '9', '"', '{', '}', ',', ' ', '\n', '\0'}) {
      std::string changed = text;
      changed[at] = other;
      if (changed == text) continue;
      expect_refused_or_the_same(changed, text, fmt::format("{} as byte {}", int(other), at));
      expect_refused_or_the_same(std::string(text).insert(at, 1, other), text,
                                 fmt::format("{} before byte {}", int(other), at));
    }
    expect_refused_or_the_same(std::string(text).erase(at, 1), text, fmt::format("without byte {}", at));
    expect_refused_or_the_same(std::string(text).insert(at, 1, text[at]), text,
                               fmt::format("byte {} twice", at));
  }
}

TEST_F(CandidateFiles, AChangedLineIsRefusedWithItsNumberAndUntouched) {
  std::string text = candidates_text(search(), {point(0.001, 0.5), point(0.002, 0.25)});
  text.replace(text.find("0.25"), 4, "0.75");
  std::ofstream(path(), std::ios::binary) << text;
  const auto resumed = CandidateFile::open(path(), search());
  const auto merged = MergedCandidates::read({path()});
  ASSERT_FALSE(resumed || merged);
  EXPECT_EQ(resumed.error().code, ExitCode::kUnreadableInput);
  EXPECT_NE(resumed.error().message.find("kept.candidates: line 3: is damaged"), std::string::npos)
      << resumed.error().message;
  EXPECT_EQ(merged.error().message, resumed.error().message);
  EXPECT_EQ(test::contents_of(path()), text);
}

constexpr const char* kVersion1 =
    "{\"schema\":\"sweepscope.candidates/"
    "1\",\"program\":\"p\",\"recording\":\"walk.bag\",\"recording_hash\":\"h\",\"rig\":\"\",\"rig_hash\":"
    "\"\",\"options\":[\"--range=1:3:1\"],\"shard\":[1,2]}\n"
    "{\"offset_ns\":1000000,\"n\":12345.0,\"e_m\":0.5}\n";

TEST_F(CandidateFiles, AnotherVersionIsRefusedWithWhatToDo) {
  std::ofstream(path(), std::ios::binary) << kVersion1;
  const auto file = CandidateFile::open(path(), search());
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, ExitCode::kUnreadableInput);
  EXPECT_EQ(file.error().message, path().string() +
                                      ": line 1: another version of sweepscope wrote this candidate file. "
                                      "Delete it and run the estimate again");
  EXPECT_EQ(test::contents_of(path()), kVersion1);
}

TEST_F(CandidateFiles, WhatACommandKeepsForItselfIsBegunAnewWhereItIsOfNoUse) {
  const std::string whole = candidates_text(search(), {point(0.001, 0.5), point(0.002, 0.25)});
  CandidateSearch other = search();
  other.recording_hash = "another";
  std::string damaged = whole;
  damaged.replace(damaged.find("0.5"), 3, "0.7");
  const std::string of_another = candidates_text(other, {point(0.001, 0.5)});
  for (const std::string& text :
       {std::string(kVersion1), damaged, of_another, of_another.substr(0, of_another.find('\n') - 9),
        whole.substr(0, 5), std::string()}) {
    std::ofstream(path(), std::ios::binary) << text;
    const auto file = CandidateFile::open_while_working(path(), search());
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ((*file)->taken_up(), 0U) << text;
    (*file)->keep(point(0.003, 0.125));
    EXPECT_EQ(test::contents_of(path()), candidates_text(search(), {point(0.003, 0.125)})) << text;
  }
  std::ofstream(path(), std::ios::binary) << whole;
  EXPECT_EQ((*CandidateFile::open_while_working(path(), search()))->taken_up(), 2U);
}

TEST_F(CandidateFiles, WhatIsNotACommandsOwnStaysAsItIs) {
  for (const char* text :
       {"my notes\n", "{\"offsets\": [1, 2]}\n", "{\"schema\":\"sweepscope.estimate/1\"}\n"}) {
    std::ofstream(path(), std::ios::binary) << text;
    const auto file = CandidateFile::open_while_working(path(), search());
    ASSERT_FALSE(file) << text;
    EXPECT_EQ(file.error().code, ExitCode::kUnreadableInput);
    EXPECT_EQ(test::contents_of(path()), text);
  }
  const auto first = CandidateFile::open_while_working(folder_ / "busy.candidates", search());
  CandidateSearch other = search();
  other.recording_hash = "another";
  const auto second = CandidateFile::open_while_working(folder_ / "busy.candidates", other);
  ASSERT_TRUE(first);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ExitCode::kWrongUsage);
}

TEST_F(CandidateFiles, AShardIsTwoWholeNumbers) {
  const std::string text = candidates_text(search(), {});
  const std::string object = text.substr(0, text.find(",\"hash\"")) + "}";
  const std::size_t at = object.find("[1,2]");
  ASSERT_NE(at, std::string::npos) << text;
  ASSERT_EQ(sealed_line(object), text);
  for (const char* shard : {"[4294967297,4294967298]", "[1e300,2]", "[1.5,2]", "[0,2]", "[3,2]", "[1,2,3]"}) {
    std::string wrong = object;
    EXPECT_FALSE(parse_candidates(sealed_line(wrong.replace(at, 5, shard)), "f")) << shard;
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
