#include "core/apply/added_topics.hpp"

#include "tests/core/apply/seen_messages.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;
using namespace test;

/// A rig that stands in a room of its own time, with scans that can be placed.
fs::path turning_bag(const fs::path& path) {
  test::TestBag bag(path);
  for (int i = 0; i < 450; ++i) {
    const double stamp_s = test::kStart_s + 0.01 * i;
    bag.motor(stamp_s + 0.024);
    if (i % 3 != 0 || i < 20 || i > 420) continue;
    auto scan = test::sample_scan(stamp_s + 0.002, std::vector<float>(181, 4.0F));
    scan.angle_min = -1.57F;
    scan.angle_max = 1.57F;
    scan.angle_increment = 3.14F / 180;
    scan.time_increment = 5e-5F;
    bag.write("/scan", stamp_s + 0.030, scan);
  }
  bag.close();
  return path;
}

std::vector<Seen> of_topic(const std::vector<Seen>& all, const std::string& topic) {
  std::vector<Seen> some;
  for (const Seen& seen : all)
    if (seen.topic == topic) some.push_back(seen);
  return some;
}

class AddedTopics : public ApplyTest {};

TEST_F(AddedTopics, CloudsAndTransformsComeBesideTheMessagesThatAreThere) {
  const fs::path in = turning_bag(folder_ / "in.bag");
  ApplyOptions options = at_24_ms();
  options.add.clouds_topic = "/sweeps";
  options.add.transforms = true;
  options.add.map.assume = RigKind::kStationary;
  for (const char* name : {"out.bag", "out.mcap"}) {
    const auto applied = apply(in, name, options);
    ASSERT_TRUE(applied) << applied.error().message;
    EXPECT_EQ(applied->provenance.added, (std::vector<std::string>{"/tf", "/sweeps"}));
    const bool bag = std::string(name) == "out.bag";
    const auto after = bag ? of_bag(folder_ / name) : of_mcap(folder_ / name);
    std::vector<Seen> kept;
    for (const Seen& seen : after)
      if (seen.topic != "/tf" && seen.topic != "/sweeps") kept.push_back(seen);
    expect_moved(of_bag(in), kept, -24'000'000, bag);
    EXPECT_EQ(of_topic(after, "/tf").size(), 450U);
    const auto clouds = of_topic(after, "/sweeps");
    ASSERT_GE(clouds.size(), 8U);
    std::int64_t before_ns = 0;
    for (const Seen& cloud : clouds) {
      const auto decoded = decode_cloud(Encoding::kRos1, std::as_bytes(std::span(cloud.bytes)));
      ASSERT_TRUE(decoded);
      EXPECT_GT(decoded->points(), 0U);
      EXPECT_GT(decoded->header_ns, before_ns);
      EXPECT_GT(cloud.receive_ns, decoded->header_ns);  // once it was measured
      before_ns = decoded->header_ns;
    }
  }
}

TEST_F(AddedTopics, ATransformIsThatOfTheTrueTime) {
  ApplyOptions options = at_24_ms();
  options.add.transforms = true;
  ASSERT_TRUE(apply(turning_bag(folder_ / "in.bag"), "out.bag", options));
  std::vector<TransformMessage> transforms;
  for (const Seen& seen : of_topic(of_bag(folder_ / "out.bag"), "/tf")) {
    ASSERT_TRUE(decode_transforms(Encoding::kRos1, std::as_bytes(std::span(seen.bytes)), transforms));
    const TransformMessage& laser = transforms.front();
    EXPECT_EQ(laser.parent, "base_link");
    EXPECT_EQ(laser.child, "laser");
    const double since_s = static_cast<double>(laser.header_ns) * 1e-9 - test::kStart_s;
    const double angle_rad = test::sample_angle_rad(since_s + 0.024);
    const Eigen::Quaterniond expected(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitX()));
    EXPECT_LT(laser.rotation.angularDistance(expected), 1e-6);
  }
}

TEST_F(AddedTopics, ATopicThatIsThereIsNotAddedAgain) {
  ApplyOptions options = at_24_ms();
  options.add.clouds_topic = "/scan";
  const auto refused = apply(turning_bag(folder_ / "in.bag"), "out.bag", options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(refused.error().message.find("has a topic /scan already"), std::string::npos);
}

}  // namespace
}  // namespace sweepscope
