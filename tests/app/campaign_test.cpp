// Many recordings in one command: its table, its exit code, and that it goes on where it was killed.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/results/sealed_line.hpp"
#include "tests/app/self_signal.hpp"
#include "tests/program.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kRecordings = 20;

/// Small recordings 01.bag to 20.bag, made once; each test works in a copy, with their times of change.
class Campaign : public test::ProgramTest {
 protected:
  static void SetUpTestSuite() {
    inputs_ = std::make_unique<test::ScratchFolder>();
    for (int i = 1; i <= kRecordings; ++i) {
      const std::string made =
          fmt::format("simulate room-{} -o {:02}.bag --duration-s 2.6 --seed {} --offset-ms {}", i % 6 + 1, i,
                      i, i == 7 ? 25.5 : 24.0);
      ASSERT_EQ(test::run_program(inputs_->path(), made).exit_code, 0);
    }
  }
  static void TearDownTestSuite() { inputs_.reset(); }
  void SetUp() override {
    ASSERT_EQ(test::run_shell(folder_, "cp -p '" + inputs_->path().string() + "'/*.bag .").exit_code, 0);
  }

  std::string file(const std::string& name) const { return test::contents_of(folder_ / name); }
  Json rows() const { return Json::parse(file("t.json"))["rows"]; }
  Outcome shell(const std::string& arguments) const {
    return test::run_shell(folder_, "env -u DISPLAY '" SWEEPSCOPE_EXECUTABLE "' " + arguments);
  }
  /// A table of all recordings whose rows were kept by the first test that asked for them.
  Outcome shell_with_all_kept(const std::string& arguments, const std::string& table) const {
    if (std::filesystem::exists(inputs_->path() / "all.rows"))
      std::filesystem::copy(inputs_->path() / "all.rows", folder_ / (table + ".rows"));
    const Outcome outcome = shell(arguments);
    std::filesystem::copy(folder_ / (table + ".rows"), inputs_->path() / "all.rows",
                          std::filesystem::copy_options::skip_existing);
    return outcome;
  }
  /// The exit code of the command, which sends a signal to itself.
  int shell_with(const test::SelfSignal& signal, const std::string& arguments) const {
    return test::run_shell(folder_,
                           "env " + signal.environment() + " '" SWEEPSCOPE_EXECUTABLE "' " + arguments)
        .exit_code;
  }
  static std::size_t count_of(const std::string& word, const std::string& text) {
    std::size_t count = 0;
    for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++count;
    return count;
  }
  /// Gives the kept row of a recording another offset, so that it shows whether it was used.
  void mark_kept(const std::string& recording, double offset_ms) const {
    std::string kept = file("t.json.rows");
    const std::size_t begin = kept.rfind('\n', kept.find("\"recording\":\"" + recording)) + 1;
    const std::size_t end = kept.find('\n', begin) + 1;
    auto line = Json::parse(kept.substr(begin, end - begin));
    line.erase("hash");
    line["row"]["offset_ms"] = offset_ms;
    kept.replace(begin, end - begin, sealed_line(line.dump()));
    std::ofstream(folder_ / "t.json.rows") << kept;
  }

  static std::unique_ptr<test::ScratchFolder> inputs_;
};

std::unique_ptr<test::ScratchFolder> Campaign::inputs_;

TEST_F(Campaign, HasALinePerRecordingInItsOrderAndFailsWhereAnOffsetLiesOutside) {
  const Outcome outcome = shell("estimate 0?.bag --expect '24 ± 0.5' --table t.json");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 9 + 1) << outcome.out;
  EXPECT_TRUE(outcome.out.starts_with("01.bag: 2")) << outcome.out;
  EXPECT_NE(outcome.out.find(", outside 24 +- 0.5 ms\n08.bag: "), std::string::npos) << outcome.out;
  EXPECT_TRUE(outcome.out.ends_with("\n9 recordings: 8 within 24 +- 0.5 ms, 1 outside\n")) << outcome.out;
  for (const Json& row : rows())
    EXPECT_EQ(row["outcome"], row["recording"] == "07.bag" ? "outside" : "within");
  EXPECT_EQ(shell("estimate 0[1-6].bag --expect 24+-0.5").exit_code, 0);
  EXPECT_EQ(shell("estimate 07.bag 08.bag").exit_code, 0) << "nothing is expected";
}

TEST_F(Campaign, ARecordingWithoutAnOffsetIsARowAndStopsNoOther) {
  make({"simulate room-1 -o stuck.bag --motor stuck"});
  std::ofstream(folder_ / "notes.bag") << "no recording";
  const auto outcome_of = [&](const std::string& recordings) {
    return run("estimate " + recordings + " --expect 24+-0.5 --table t.json").exit_code;
  };
  EXPECT_EQ(outcome_of("01.bag stuck.bag 02.bag"), 4);
  EXPECT_EQ(outcome_of("stuck.bag notes.bag 01.bag"), 3);
  EXPECT_EQ(outcome_of("missing.bag 07.bag stuck.bag notes.bag 01.bag"), 1);
  const Json table = rows();
  ASSERT_EQ(table.size(), 5U);
  for (const auto& [index, outcome] :
       {std::pair{0, "unreadable"}, {1, "outside"}, {2, "refused"}, {3, "unreadable"}, {4, "within"}})
    EXPECT_EQ(table[static_cast<std::size_t>(index)]["outcome"], outcome);
  EXPECT_EQ(table[0]["reasons"][0], "missing.bag: no such file");
  EXPECT_FALSE(table[2]["reasons"].empty());
}

TEST_F(Campaign, TheNumbersAreThoseOfASingleEstimate) {
  ASSERT_EQ(run("estimate 01.bag 02.bag --table t.json").exit_code, 0);
  ASSERT_EQ(run("estimate 02.bag --json one.json").exit_code, 0);
  const Json row = rows()[1], one = Json::parse(file("one.json"));
  for (const char* key : {"offset_ms", "sigma_ms", "method", "kind", "sweeps", "scans", "warnings"})
    EXPECT_EQ(row[key], one[key]) << key;
}

TEST_F(Campaign, IsTheSameBytesForAnyNumberOfThreads) {
  for (const char* format : {"csv", "md", "json", "xml"}) {
    // The first table's rows are estimated; those of the others are the same, and kept.
    const auto made_by = [&](const std::string& threads) {
      const std::string rows = threads + ".rows", kept = std::string("t.") + format + ".rows";
      std::filesystem::remove(folder_ / kept);
      if (exists(rows)) std::filesystem::copy(folder_ / rows, folder_ / kept);
      const Outcome outcome = shell("estimate 0?.bag --expect 24+-0.5 --table t." + std::string(format) +
                                    " --threads " + threads);
      if (!exists(rows)) std::filesystem::copy(folder_ / kept, folder_ / rows);
      return outcome;
    };
    const Outcome one = made_by("1");
    const std::string bytes = file(std::string("t.") + format),
                      kept = file(std::string("t.") + format + ".rows");
    const Outcome two = made_by("3");
    EXPECT_EQ(one.out, two.out);
    EXPECT_NE(bytes.find("09.bag"), std::string::npos) << bytes;
    EXPECT_EQ(file(std::string("t.") + format), bytes) << format;
    EXPECT_EQ(file(std::string("t.") + format + ".rows"), kept) << format;
  }
}

TEST_F(Campaign, KilledAndStartedAgainWritesTheSameTable) {
  for (const char* name : {"t.csv", "t.xml"}) {
    const std::string command = std::string("estimate *.bag --expect 24+-0.5 --table ") + name;
    const Outcome whole = shell_with_all_kept(command, name);
    const std::string bytes = file(name);
    std::filesystem::remove(folder_ / name);
    std::filesystem::remove(folder_ / (std::string(name) + ".rows"));
    // Once while rows are kept, and once while the table is written.
    const test::SelfSignal keeping{SIGKILL, "\"key\"", 7};
    ASSERT_EQ(shell_with(keeping, command), test::kKilled);
    EXPECT_EQ(count_of("\"key\"", file(std::string(name) + ".rows")), 7U);
    const test::SelfSignal writing{SIGKILL, name, 6};
    ASSERT_EQ(shell_with(writing, command), test::kKilled);
    EXPECT_FALSE(file(name).empty()) << "a whole table of what was finished";
    const Outcome resumed = shell(command);
    EXPECT_EQ(resumed.exit_code, whole.exit_code);
    EXPECT_EQ(resumed.out, whole.out);
    EXPECT_EQ(file(name), bytes);
  }
}

TEST_F(Campaign, InterruptedItKeepsWhatIsFinished) {
  const std::string command = "estimate *.bag --table t.json";
  shell_with_all_kept(command, "t.json");
  const std::string bytes = file("t.json");
  std::filesystem::remove(folder_ / "t.json.rows");
  const test::SelfSignal interrupt{SIGINT, "\"key\"", 5};
  EXPECT_EQ(shell_with(interrupt, command), 130);
  const Json table = Json::parse(file("t.json"));
  EXPECT_EQ(table["complete"], false);
  EXPECT_GE(table["rows"].size(), 5U);
  EXPECT_EQ(table["rows"].size() + table["pending"].size(), std::size_t{kRecordings});
  EXPECT_NE(file("said.err").find("of 20 recordings are finished and kept in t.json.rows"), std::string::npos)
      << file("said.err");
  EXPECT_EQ(shell(command).exit_code, 0);
  EXPECT_EQ(file("t.json"), bytes);
}

TEST_F(Campaign, ARowBelongsToItsRecordingItsOptionsAndItsRig) {
  const std::string command = "estimate 01.bag 02.bag --table t.json";
  const auto offset_after = [&](const std::string& more) {
    const int exit_code = run(command + more).exit_code;
    EXPECT_TRUE(exit_code == 0 || exit_code == 1) << more;
    return rows()[1]["offset_ms"].get<double>();
  };
  const double estimated = offset_after("");
  mark_kept("02.bag", 77.25);
  EXPECT_EQ(offset_after(""), 77.25) << "kept";
  EXPECT_EQ(offset_after(" --expect 24+-0.5"), 77.25) << "what is expected changes no row";
  EXPECT_EQ(rows()[1]["outcome"], "outside");
  EXPECT_EQ(offset_after(" --threads 1 --trend t.svg"), 77.25) << "nor does what is drawn";
  EXPECT_NE(offset_after(" --assume stationary"), 77.25) << "other options";
  EXPECT_EQ(offset_after(""), estimated);
  mark_kept("02.bag", 77.25);
  ASSERT_EQ(test::run_shell(folder_, "touch -d '2001-01-01' 02.bag").exit_code, 0);
  EXPECT_EQ(offset_after(""), estimated) << "the recording was changed";
  mark_kept("02.bag", 77.25);
  std::ofstream(folder_ / "rig.yaml") << "mount: {axis: [1, 0, 0]}\n";
  EXPECT_EQ(offset_after(" --rig rig.yaml"), estimated);
  mark_kept("02.bag", 77.25);
  std::ofstream(folder_ / "rig.yaml") << "mount: {axis: [1.0, 0, 0]}\n";
  EXPECT_EQ(offset_after(" --rig rig.yaml"), estimated) << "the rig file was changed";
}

TEST_F(Campaign, NoOutputDestroysAnInput) {
  const std::string before = file("01.bag");
  ASSERT_EQ(test::run_shell(folder_, "ln 01.bag t.csv && ln 02.bag u.csv.rows").exit_code, 0);
  EXPECT_EQ(run("estimate 01.bag 02.bag --table t.csv").exit_code, 2);
  EXPECT_EQ(run("estimate 01.bag 02.bag --table u.csv").exit_code, 2) << "nor does the file of its rows";
  EXPECT_EQ(run("estimate 01.bag t.csv --trend t.csv").exit_code, 2);
  EXPECT_EQ(file("01.bag"), before);
  EXPECT_FALSE(exists("u.csv"));
}

TEST_F(Campaign, WrongUsageIsRefused) {
  for (const char* arguments :
       {"01.bag 02.bag --json a.json", "01.bag 02.bag --csv a.csv", "01.bag 02.bag --resume a",
        "01.bag --table a.csv --rig-out r.yaml --solve mount", "01.bag 02.bag --poses t.tum",
        "01.bag --table a.txt", "01.bag --trend a.gif", "01.bag --table a.csv --trend a.csv",
        "01.bag --expect 24,5", "01.bag --expect 24"})
    EXPECT_EQ(run(std::string("estimate ") + arguments).exit_code, 2) << arguments;
  const Outcome comma = run("estimate 01.bag --expect 24,5");
  EXPECT_NE(comma.err.find("such as 24+-0.5"), std::string::npos) << comma.err;
  EXPECT_FALSE(exists("a.csv"));
  EXPECT_FALSE(exists("a.csv.rows"));
  EXPECT_EQ(run("estimate 01.bag 02.bag --rig missing.yaml --table a.csv").exit_code, 3);
}

TEST_F(Campaign, OneRecordingIsHeldToWhatIsExpectedToo) {
  const Outcome within = run("estimate 01.bag --expect 24+-0.5");
  EXPECT_EQ(within.exit_code, 0);
  EXPECT_NE(within.out.find(" ms is within 24 +- 0.5 ms\n"), std::string::npos) << within.out;
  const Outcome outside = run("estimate 07.bag --expect 24+-0.5 --json -");
  EXPECT_EQ(outside.exit_code, 1);
  EXPECT_TRUE(Json::parse(outside.out)["identifiable"]) << "the result is written all the same";
  EXPECT_NE(outside.err.find(" ms is outside 24 +- 0.5 ms\n"), std::string::npos) << outside.err;
}

TEST_F(Campaign, ATrendIsDrawnByTheCommandAndByARecipe) {
  EXPECT_EQ(run("estimate 06.bag 07.bag --expect 24+-0.5 --table t.json --trend t.svg").exit_code, 1);
  EXPECT_NE(file("t.svg").find("within 24 +- 0.5 ms, 1 outside"), std::string::npos) << "under its summary";
  const auto draw = [&](const std::string& figure) {
    std::ofstream(folder_ / "recipe.yaml") << "figures: {trend: {kind: trend, " << figure << "}}\n";
    return run("figures recipe.yaml -o drawn");
  };
  EXPECT_EQ(draw("table: t.json, formats: [svg, png], size: 900x500").exit_code, 0);
  EXPECT_NE(file("drawn/trend.svg").find("within 24 +- 0.5 ms"), std::string::npos);
  EXPECT_TRUE(exists("drawn/trend.png"));
  const Outcome without = draw("formats: [svg]");
  EXPECT_EQ(without.exit_code, 3);
  EXPECT_NE(without.err.find("figure trend needs a table"), std::string::npos) << without.err;
  ASSERT_EQ(run("estimate 06.bag --json one.json").exit_code, 0);
  EXPECT_EQ(draw("table: one.json").exit_code, 3) << "an estimate is no table";
}

TEST_F(Campaign, TheTestReportIsXmlWithItsCounts) {
  if (std::system("python3 -c 'import xml.etree.ElementTree' 2>/dev/null") != 0)
    GTEST_SKIP() << "python3 with xml is not installed";
  ASSERT_EQ(shell("estimate 0[678].bag \"a<&\\\"b.bag\" --expect 24+-0.5 --table t.xml").exit_code, 1);
  std::ofstream(folder_ / "counts.py")
      << "import xml.etree.ElementTree as xml\n"
         "root = xml.parse('t.xml').getroot()\n"
         "suite, = root\n"
         "cases = suite.findall('testcase')\n"
         "assert root.tag == 'testsuites' and suite.tag == 'testsuite'\n"
         "counted = dict(tests=len(cases), failures=len(suite.findall('testcase/failure')),\n"
         "               errors=len(suite.findall('testcase/error')),\n"
         "               skipped=len(suite.findall('testcase/skipped')))\n"
         "for name, count in counted.items():\n"
         "    assert int(suite.get(name)) == count, name\n"
         "    # Jenkins' schema knows no 'skipped' in the root\n"
         "    assert root.get(name) == (None if name == 'skipped' else str(count)), name\n"
         "assert all(c.get('classname') and c.get('name') and float(c.get('time')) == 0 for c in cases)\n"
         "print(counted, [c.get('name') for c in cases])\n";
  const Outcome counted = test::run_shell(folder_, "python3 counts.py");
  EXPECT_EQ(counted.out,
            "{'tests': 4, 'failures': 1, 'errors': 1, 'skipped': 0} ['06.bag', '07.bag', '08.bag', "
            "'a<&\"b.bag']\n")
      << counted.err;
}

}  // namespace
}  // namespace sweepscope
