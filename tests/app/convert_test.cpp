#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace sweepscope {
namespace {

class ConvertCommand : public test::ProgramTest {
 protected:
  void SetUp() override { make({"simulate room-1 --duration-s 2 -o room.bag"}); }
  std::string offset_of(const std::string& recording) const {
    const Outcome outcome =
        run("estimate " + recording + " --method stationary --range 23:25:1 --no-timing --json -");
    const auto json = nlohmann::json::parse(outcome.out, nullptr, false);
    return json.is_object() ? json["curve"].dump() + json["offset_ms"].dump() : outcome.err;
  }
};

TEST_F(ConvertCommand, TheOutputsNameChoosesTheFormat) {
  for (const char* output : {"out", "out.mcap", "out.bag"}) {
    const Outcome outcome = run(std::string("convert room.bag -o ") + output);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.out.rfind(std::string(output) + ": 80 scans of /scan and ", 0), 0U) << outcome.out;
  }
  EXPECT_TRUE(exists("out/scans.csv"));
  EXPECT_EQ(test::contents_of(folder_ / "out.mcap").substr(1, 4), "MCAP");
  EXPECT_EQ(test::contents_of(folder_ / "out.bag").substr(0, 7), "#ROSBAG");
  const std::string expected = offset_of("room.bag");
  EXPECT_NE(expected.find("offset_ms"), std::string::npos) << expected;
  for (const char* output : {"out", "out.mcap", "out.bag"}) EXPECT_EQ(offset_of(output), expected);
}

TEST_F(ConvertCommand, ToAndCompressionOverrideTheName) {
  EXPECT_EQ(run("convert room.bag -o packed --to mcap --compression zstd").exit_code, 0);
  EXPECT_EQ(test::contents_of(folder_ / "packed").substr(1, 4), "MCAP");
  EXPECT_EQ(run("convert packed -o back.dat --to csv").exit_code, 0);
  EXPECT_TRUE(exists("back.dat/motor.csv"));
}

TEST_F(ConvertCommand, WrongUsageSaysWhatIsWrong) {
  const auto refused = [&](const std::string& arguments) {
    const Outcome outcome = run("convert " + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    return outcome.err;
  };
  EXPECT_NE(refused("room.bag -o out.xyz").find("unknown format; name it OUT.bag"), std::string::npos);
  EXPECT_NE(refused("room.bag -o out.bag --compression zstd").find("--compression zstd is not available"),
            std::string::npos);
  EXPECT_NE(refused("room.bag -o room.bag").find("is an input of this command"), std::string::npos);
  EXPECT_NE(refused("room.bag -o out --to ros3").find("the formats are csv, ros1 and mcap"),
            std::string::npos);
  EXPECT_NE(refused("room.bag -o no/such/out.mcap").find("cannot be created"), std::string::npos);
  EXPECT_EQ(run("convert missing.bag -o out").exit_code, 3);
  EXPECT_FALSE(exists("out"));
}

}  // namespace
}  // namespace sweepscope
