#include "core/io/table.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

Table results() {
  Table table;
  table.title = "Offsets of 50 % & more";
  table.columns = {{"recording", "", Alignment::kLeft, {}},
                   {"offset", "ms", Alignment::kRight, 2},
                   {"mean θ", "rad/s", Alignment::kCentre, {}}};
  table.rows = {{std::string("room-1"), 24.304, -0.25}, {std::string("metro"), {}, 1.0}};
  return table;
}

/// One cell of text alone.
Table table_of(const std::string& text) {
  Table table;
  table.columns = {{"a", "", Alignment::kLeft, {}}};
  table.rows = {{text}};
  return table;
}

std::string csv_of(const std::string& text) {
  return to_csv(table_of(text)).substr(2);  // after "a\n"
}

std::string markdown_of(const std::string& text) {
  const std::string all = to_markdown(table_of(text));
  const std::string row = all.substr(all.find("|\n| ", all.find("---")) + 4);
  return row.substr(0, row.find_last_not_of(" |\n") + 1);
}

std::string latex_of(const std::string& text) {
  const std::string all = to_latex(table_of(text));
  const std::size_t from = all.find("\\midrule\n  ") + 11;
  return all.substr(from, all.find(" \\\\\n  \\bottomrule") - from);
}

TEST(Csv, NamesUnitsAndKeepsAllDigits) {
  EXPECT_EQ(to_csv(results()),
            "recording,offset_ms,mean_θ_rad_per_s\n"
            "room-1,24.304,-0.25\n"
            "metro,,1\n");
}

TEST(Csv, QuotesWhatRfc4180Asks) {
  EXPECT_EQ(csv_of("plain"), "plain\n");
  EXPECT_EQ(csv_of("a,b"), "\"a,b\"\n");
  EXPECT_EQ(csv_of("say \"x\""), "\"say \"\"x\"\"\"\n");
  EXPECT_EQ(csv_of("two\nlines"), "\"two\nlines\"\n");
  EXPECT_EQ(csv_of("a|b %_&~\\ θ"), "a|b %_&~\\ θ\n");
}

TEST(Csv, NumbersReadBackExactly) {
  Table table = table_of("");
  table.rows = {{0.1}, {1.0 / 3}, {1e-20}, {1'850'000.0}};
  EXPECT_EQ(to_csv(table), "a\n0.1\n0.3333333333333333\n1e-20\n1850000\n");
}

TEST(Markdown, ColumnsAreAlignedForTheEyeToo) {
  EXPECT_EQ(to_markdown(results()),
            "**Offsets of 50 % &amp; more**\n"
            "\n"
            "| recording | offset [ms] | mean θ [rad/s] |\n"
            "| --------- | ----------: | :------------: |\n"
            "| room-1    |       24.30 |     −0.25      |\n"
            "| metro     |           – |       1        |\n");
}

TEST(Markdown, EscapesItsOwnSigns) {
  EXPECT_EQ(markdown_of("a|b"), "a\\|b");
  EXPECT_EQ(markdown_of("_x_ *y* `z` ~w~"), "\\_x\\_ \\*y\\* \\`z\\` \\~w\\~");
  EXPECT_EQ(markdown_of("back\\slash"), "back\\\\slash");
  EXPECT_EQ(markdown_of("two\nlines"), "two<br>lines");
  EXPECT_EQ(markdown_of("<b> & θ, \"x\""), "&lt;b> &amp; θ, \"x\"");
}

TEST(Latex, IsATabularWithRules) {
  EXPECT_EQ(to_latex(results()),
            "% Offsets of 50 \\% \\& more\n"
            "\\begin{tabular}{lrc}\n"
            "  \\toprule\n"
            "  recording & offset [ms] & mean $\\theta$ [rad/s] \\\\\n"
            "  \\midrule\n"
            "  room-1 & 24.30 & $-$0.25 \\\\\n"
            "  metro & -- & 1 \\\\\n"
            "  \\bottomrule\n"
            "\\end{tabular}\n");
}

TEST(Latex, EscapesItsOwnSigns) {
  EXPECT_EQ(latex_of("50 % & $5 #1 a_b {c}"), "50 \\% \\& \\$5 \\#1 a\\_b \\{c\\}");
  EXPECT_EQ(latex_of("~ ^ \\"), "\\textasciitilde{} \\textasciicircum{} \\textbackslash{}");
  EXPECT_EQ(latex_of("a<b>c|d"), "a$<$b$>$c$|$d");
  EXPECT_EQ(latex_of("--json \"x\", two\nlines"), "-{}-{}json ''x'', two lines");
}

TEST(Latex, GreekAndSignsAreMathematics) {
  EXPECT_EQ(latex_of("θ −3 ± 0.2° µm Ω 10³ …"),
            "$\\theta$ $-$3 $\\pm$ 0.2$^{\\circ}$ $\\mu$m $\\Omega$ 10$^{3}$ \\ldots{}");
  EXPECT_EQ(latex_of("Tübingen"), "Tübingen");
}

TEST(Latex, ARowThatLooksLikeAnArgumentIsNone) {
  EXPECT_EQ(latex_of("[1] x"), "{[}1] x");
  EXPECT_EQ(latex_of("*x"), "{*}x");
}

TEST(Tables, RoundedNumbersHaveNoNegativeZero) {
  Table table = table_of("");
  table.columns[0].decimals = 1;
  table.rows = {{-0.04}, {-0.06}, {-std::numeric_limits<double>::infinity()}};
  const std::string latex = to_latex(table);
  EXPECT_NE(latex.find("  0.0 \\\\\n  $-$0.1 \\\\\n  $-$inf \\\\\n"), std::string::npos) << latex;
}

TEST(Tables, WithoutRowsAreAHeader) {
  Table table = results();
  table.rows.clear();
  EXPECT_EQ(to_csv(table), "recording,offset_ms,mean_θ_rad_per_s\n");
}

class WriteTable : public test::FolderTest {};

TEST_F(WriteTable, TakesTheKindFromTheExtension) {
  for (const char* name : {"t.csv", "t.md", "t.tex"}) ASSERT_TRUE(write_table(folder_ / name, results()));
  EXPECT_EQ(test::contents_of(folder_ / "t.csv"), to_csv(results()));
  EXPECT_EQ(test::contents_of(folder_ / "t.md"), to_markdown(results()));
  EXPECT_EQ(test::contents_of(folder_ / "t.tex"), to_latex(results()));
}

TEST_F(WriteTable, RefusesOtherKindsAndLeavesNothing) {
  const auto written = write_table(folder_ / "t.xls", results());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(written.error().message.find("t.xls: a table is written as .csv, .md or .tex"),
            std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace sweepscope
