#include "core/io/printable_text.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace sweepscope {
namespace {

TEST(PrintableText, KeepsValidUtf8) {
  for (const char* text : {"", "/scan", "a b\\c", "Fußgänger", "激光", "µ ≤ 3°", "😀", "\u00a0", "\ufffd"}) {
    EXPECT_EQ(printable_line(text), text);
    EXPECT_EQ(printable_text(text), text);
    EXPECT_EQ(valid_utf8(text), text);
  }
}

TEST(PrintableText, EscapesControlCharacters) {
  EXPECT_EQ(printable_line("\x1b[31mred\x07\t\r\x7f"), "\\x1b[31mred\\x07\\x09\\x0d\\x7f");
  EXPECT_EQ(printable_line(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable_line("\u0080 \u009b31m \u009f"), "\\u{0080} \\u{009b}31m \\u{009f}");
}

TEST(PrintableText, EscapesWhatTurnsTheDirectionOrBreaksTheLine) {
  EXPECT_EQ(printable_line("bag\u202egnp\u2066\u200f\u061c"), "bag\\u{202e}gnp\\u{2066}\\u{200f}\\u{061c}");
  EXPECT_EQ(printable_line("a\nb\u2028c\u2029"), "a\\x0ab\\u{2028}c\\u{2029}");
  EXPECT_EQ(printable_line("\ufffe\uffff"), "\\u{fffe}\\u{ffff}") << "no characters of XML";
}

TEST(PrintableText, EscapesBytesThatAreNoUtf8OneByOne) {
  EXPECT_EQ(printable_line("\xff\x80z"), "\\xff\\x80z");
  EXPECT_EQ(printable_line("\xc0\xaf"), "\\xc0\\xaf") << "an overlong slash";
  EXPECT_EQ(printable_line("\xe0\x80\xaf"), "\\xe0\\x80\\xaf");
  EXPECT_EQ(printable_line("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(printable_line("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond U+10FFFF";
  EXPECT_EQ(printable_line("\xe2\x82"), "\\xe2\\x82") << "cut";
  EXPECT_EQ(valid_utf8("\x1b\xff"), "\x1b\\xff");
}

TEST(PrintableText, IsTheSameAppliedTwice) {
  const std::string once = printable_line("\x1b\xff\n\u202e");
  EXPECT_EQ(printable_line(once), once);
}

TEST(PrintableText, KeepsTheLineBreaksThatBelongToTheText) {
  EXPECT_EQ(printable_text("a\nb\x1b"), "a\nb\\x1b");
  EXPECT_EQ(printable_message("choose one:\n    /a\n    /b\nand\n"),
            "choose one:\n    /a\n    /b\\x0aand\\x0a");
}

TEST(PrintableText, JsonHoldsEveryNameAndSteersNoTerminal) {
  const std::string text = json_text({{"name", "\x1b\u009b\u202e\x7f\xff\xfeµ"}, {"list", {"\xff"}}});
  EXPECT_EQ(text,
            "{\n  \"name\": \"\\u001b\\u009b\\u202e\\u007f\\\\xff\\\\xfeµ\",\n  \"list\": [\n    "
            "\"\\\\xff\"\n  ]\n}\n");
  EXPECT_EQ(nlohmann::json::parse(text)["name"], "\x1b\u009b\u202e\x7f\\xff\\xfeµ");
}

}  // namespace
}  // namespace sweepscope
