// Names that would steer a terminal or break a file's format, through the shipped executable.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace sweepscope {
namespace {

// An escape sequence, a byte that is no UTF-8, DEL, CSI as a C1 control, and a turn of direction.
const std::string kSteering = "\x1b]0;x\x07\xff\x7f\u009b31m\u202e";
const std::string kShown = "\\x1b]0;x\\x07\\xff\\x7f\\u{009b}31m\\u{202e}";

class Names : public test::ProgramTest {
 protected:
  /// A folder of tables whose own name, topics and joint all steer.
  void SetUp() override {
    make({"simulate room-3 -o r.bag --duration-s 4", "convert r.bag -o plain"});
    std::filesystem::create_directory(folder_ / recording_);
    rename_in("scans.csv", ",/scan,", ",/scan" + kSteering + ",");
    rename_in("motor.csv", ",roll_motor", ",roll" + kSteering);
  }
  void rename_in(const std::string& table, const std::string& from, const std::string& to) const {
    std::string text = test::contents_of(folder_ / "plain" / table);
    ASSERT_NE(text.find(from), std::string::npos) << text.substr(0, 300);
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
    std::ofstream(folder_ / recording_ / table) << text;
  }
  std::string word() const { return "'" + recording_ + "'"; }

  const std::string recording_ = "rec\n" + kSteering;
  const std::string shown_ = "rec\\x0a" + kShown;
};

/// No control character but a line break, no C1 control, no turn of direction, and UTF-8 throughout.
void expect_harmless(const std::string& text, const std::string& what) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    ASSERT_TRUE(byte == '\n' || (byte >= ' ' && byte != 0x7f)) << what << ", byte " << i << " of " << text;
  }
  for (const char* control : {"\u009b", "\u202e"})
    EXPECT_EQ(text.find(control), std::string::npos) << what << ": " << text;
  EXPECT_NO_THROW((void)nlohmann::json(text).dump()) << what << " is no UTF-8";
}

TEST_F(Names, AreEscapedOnTheTerminal) {
  const Outcome info = run("info " + word());
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_EQ(info.out.rfind(shown_ + "\n\n", 0), 0U) << info.out;
  EXPECT_NE(info.out.find("/scan" + kShown), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("roll" + kShown + " on "), std::string::npos) << info.out;
  for (const std::string& arguments :
       {"info " + word(), "info --window 0:1000000 --assume x " + word(), "estimate " + word(),
        "estimate --window 90:91 " + word(), "map --offset-ms 24 -o 'm\x1b.pcd' " + word(),
        "info 'gone" + recording_ + "'", "convert -o 'c\n\x1b' " + word(), "rig " + word()}) {
    const Outcome outcome = run(arguments);
    expect_harmless(outcome.out, arguments + ", stdout");
    expect_harmless(outcome.err, arguments + ", stderr");
    EXPECT_FALSE(outcome.out.empty() && outcome.err.empty()) << arguments;
  }
}

TEST_F(Names, AreEscapedInJson) {
  for (const char* command : {"info", "estimate"}) {
    const Outcome outcome = run(std::string(command) + " --json - " + word());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_harmless(outcome.out, command);
    std::string name = recording_;
    name.replace(name.find('\xff'), 1, "\\xff");
    EXPECT_EQ(nlohmann::json::parse(outcome.out)["recording"], name);
  }
}

TEST_F(Names, AreEscapedInReportsPicturesAndTables) {
  ASSERT_EQ(run("report -o out " + word()).exit_code, 0);
  const std::string page = test::contents_of(folder_ / "out/report.html");
  expect_harmless(page, "report.html");
  EXPECT_NE(page.find("<h1>" + shown_ + "</h1>"), std::string::npos);
  ASSERT_EQ(run("map --offset-ms 24 -o a.pcd r.bag").exit_code, 0);
  std::filesystem::copy(folder_ / "a.pcd", folder_ / ("b" + kSteering + ".pcd"));
  for (const char* picture : {"out.svg", "out.pdf", "out.png"}) {
    const Outcome outcome = run("compare a.pcd 'b" + kSteering + ".pcd' -o " + picture);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
  }
  const std::string svg = test::contents_of(folder_ / "out.svg");
  expect_harmless(svg, "out.svg");
  EXPECT_NE(svg.find(">b" + kShown), std::string::npos);
  const Outcome converted = run("convert --to csv -o again " + word());
  ASSERT_EQ(converted.exit_code, 0) << converted.err;
  const std::string table = test::contents_of(folder_ / "again/motor.csv");
  expect_harmless(table, "motor.csv");
  EXPECT_NE(table.find("roll" + kShown), std::string::npos) << table.substr(0, 300);
  EXPECT_EQ(run("info again").exit_code, 0);
}

TEST_F(Names, ThatAreWrongOnTheCommandLineAreEscapedToo) {
  for (const char* arguments :
       {"'no\x1bsuch'", "info --no\x1bsuch r.bag", "map r.bag --offset-ms 'x\x9b' -o a.pcd"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    expect_harmless(outcome.err, arguments);
  }
}

}  // namespace
}  // namespace sweepscope
