#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace sweepscope {
namespace {

class ReportCommand : public test::ProgramTest {
 protected:
  std::string page() const { return test::contents_of(folder_ / "out/report.html"); }
};

TEST_F(ReportCommand, IsOnePageWithTheAnswerAndItsEvidence) {
  make({"simulate room-3 -o 'a <room>.bag' --offset-ms 7 --duration-s 4"});
  const Outcome outcome = run("report 'a <room>.bag' -o out --threads 2");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "out/report.html\n");
  const std::string html = page();
  for (const char* part : {"t_motor = t_laser + offset", "7.0", "What was recorded", "Warnings", "<svg",
                           "data:image/png;base64,", "sweepscope " SWEEPSCOPE_VERSION,
                           "sweepscope report 'a &lt;room&gt;.bag' -o report", "<td>direct</td>",
                           "<td>d</td>", "The criteria over the offset"}) {
    EXPECT_NE(html.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(html.find("<room>"), std::string::npos) << "names are escaped";
  EXPECT_EQ(html.find("src=\"http"), std::string::npos);
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
}

TEST_F(ReportCommand, PointsDecideHowMuchOfTheMapIsInThePage) {
  make({"simulate room-3 -o r.bag --duration-s 4"});
  ASSERT_EQ(run("report r.bag -o out --points 0").exit_code, 0);
  EXPECT_EQ(page().find("<script"), std::string::npos);
  EXPECT_NE(page().find("data:image/png;base64,"), std::string::npos);
  ASSERT_EQ(run("report r.bag -o out --points 10000").exit_code, 0);
  const std::size_t of_few = page().size();
  ASSERT_EQ(run("report r.bag -o out --points 50000").exit_code, 0);
  EXPECT_NE(page().find("50,000 of "), std::string::npos);
  EXPECT_NEAR(double(page().size() - of_few), 40'000 * 16.25 * 4 / 3, 20'000);  // bytes a point, as base64
  EXPECT_EQ(run("report r.bag -o out --points 500001").exit_code, 2);
  EXPECT_EQ(run("report r.bag -o out --points -1").exit_code, 2);
}

TEST_F(ReportCommand, IsTheSameToTheByteEachTime) {
  make({"simulate room-3 -o r.bag --duration-s 4"});
  ASSERT_EQ(run("report r.bag -o out").exit_code, 0);
  const std::string first = page();
  ASSERT_EQ(run("report r.bag -o out").exit_code, 0);
  EXPECT_EQ(page(), first);
}

TEST_F(ReportCommand, IsTheSameToTheByteWhereverFilesLieAndForAnyNumberOfThreads) {
  std::filesystem::create_directories(folder_ / "far/away");
  std::ofstream(folder_ / "rig.yaml") << "mount: {axis: [1, 0, 0]}\n";
  std::filesystem::copy(folder_ / "rig.yaml", folder_ / "far/a rig.yaml");
  std::filesystem::copy(folder_ / "rig.yaml", folder_ / "a rig.yaml");
  make({"simulate room-3 -o r.bag --duration-s 4"});
  std::filesystem::copy(folder_ / "r.bag", folder_ / "far/away/r.bag");
  ASSERT_EQ(run("report r.bag -o out --rig 'a rig.yaml' --threads 1").exit_code, 0);
  const std::string elsewhere = "'" + (folder_ / "far/away/r.bag").string() + "'";
  const Outcome outcome = run("report --threads=2 --rig=\"$PWD/far/a rig.yaml\" -o far/other " + elsewhere);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(page().find("sweepscope report r.bag --rig 'a rig.yaml' -o report"), std::string::npos);
  for (const char* file : {"report.html", "estimate.json"})
    EXPECT_EQ(test::contents_of(folder_ / "far/other" / file), test::contents_of(folder_ / "out" / file))
        << file;
}

TEST_F(ReportCommand, SolvesForTheRigAsEstimateDoes) {
  make({"simulate room-2 --duration-s 4 --mount-error-deg 0,3,-4 -o r.bag"});
  const Outcome outcome = run("report r.bag -o out --points 0 --solve offset,mount,play --prior mount_deg=5");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(page().find(
                "sweepscope report r.bag --solve offset,mount,play --prior mount_deg=5 --points 0 -o report"),
            std::string::npos);
  EXPECT_NE(page().find("The motor turns at one speed only"), std::string::npos);
  const auto of = [&](const std::string& file) {
    return nlohmann::json::parse(test::contents_of(folder_ / file));
  };
  ASSERT_EQ(
      run("estimate r.bag --solve offset,mount,play --prior mount_deg=5 --no-timing --json e.json").exit_code,
      0);
  EXPECT_EQ(of("out/estimate.json").at("parameters"), of("e.json").at("parameters"));
  EXPECT_EQ(run("report r.bag -o out --solve offset,axis").exit_code, 2);
}

TEST_F(ReportCommand, ARecordingThatCannotAnswerGetsThePageWithTheReasons) {
  make({"simulate room-1 -o stuck.bag --motor stuck --duration-s 3"});
  const Outcome outcome = run("report stuck.bag -o out");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(page().find("cannot be determined from this recording"), std::string::npos);
  EXPECT_NE(page().find("The motor does not move"), std::string::npos);
}

TEST_F(ReportCommand, AFolderThatCannotBeMadeIsSaidInASentence) {
  make({"simulate room-1 -o r.bag --duration-s 3"});
  std::ofstream(folder_ / "taken") << "a file";
  const Outcome outcome = run("report r.bag -o taken");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("taken"), std::string::npos);
}

}  // namespace
}  // namespace sweepscope
