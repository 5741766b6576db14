#include "core/recording/messages/scan_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/recording/message_bytes.hpp"

namespace sweepscope {
namespace {

using test::as_span, test::MessageBytes;
using Echoes = std::vector<std::vector<float>>;

MessageBytes& add_echoes(MessageBytes& message, const Echoes& echoes) {
  message.number(static_cast<std::uint32_t>(echoes.size()));
  for (const auto& of_beam : echoes) message.array(of_beam);
  return message;
}

class ScansOfEchoes : public testing::TestWithParam<MessageBytes::Form> {
 protected:
  Encoding encoding() const { return GetParam() == MessageBytes::kRos1 ? Encoding::kRos1 : Encoding::kCdr; }
  std::string message(const Echoes& ranges, const Echoes& intensities) const {
    MessageBytes message(GetParam());
    message.header(7, 8, "laser");
    for (const float value : {-0.5F, 0.5F, 0.25F, 0.001F, 0.025F, 0.1F, 30.0F}) message.number(value);
    add_echoes(message, ranges);
    return add_echoes(message, intensities).bytes();
  }
  std::vector<float> ranges(Echo echo, const std::string& bytes) const {
    ScanReader reader(MessageKind::kMultiEcho, encoding(), echo);
    const auto scan = reader.read(as_span(bytes));
    if (!scan) return {};
    std::vector<float> ranges;
    scan->ranges_m.append_to(ranges);
    return ranges;
  }
};
INSTANTIATE_TEST_SUITE_P(Ros1AndRos2, ScansOfEchoes,
                         testing::Values(MessageBytes::kRos1, MessageBytes::kCdr,
                                         MessageBytes::kCdrBigEndian));

const Echoes kRanges{{1, 2}, {3}, {}, {4, 5, 6}}, kIntensities{{10, 20}, {30}, {}, {40, 60, 50}};

TEST_P(ScansOfEchoes, TheNamedEchoIsUsedAndNoneIsInfinite) {
  const std::string bytes = message(kRanges, kIntensities);
  EXPECT_EQ(ranges(Echo::kFirst, bytes), (std::vector<float>{1, 3, HUGE_VALF, 4}));
  EXPECT_EQ(ranges(Echo::kLast, bytes), (std::vector<float>{2, 3, HUGE_VALF, 6}));
  EXPECT_EQ(ranges(Echo::kStrongest, bytes), (std::vector<float>{2, 3, HUGE_VALF, 5}));
}

TEST_P(ScansOfEchoes, IntensitiesAreThoseOfTheEcho) {
  const std::string bytes = message(kRanges, kIntensities);
  ScanReader reader(MessageKind::kMultiEcho, encoding(), Echo::kLast);
  const auto scan = reader.read(as_span(bytes));
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->header_ns, 7'000'000'008);
  EXPECT_EQ(scan->frame, "laser");
  EXPECT_EQ(scan->angle_increment_rad, 0.25F);
  EXPECT_EQ(scan->range_max_m, 30);
  std::vector<float> intensities;
  scan->intensities.append_to(intensities);
  EXPECT_EQ(intensities, (std::vector<float>{20, 30, 0, 50}));
  EXPECT_FALSE(reader.without_strength());
}

TEST_P(ScansOfEchoes, WithoutIntensitiesTheStrongestIsTheFirstAndThatIsSaid) {
  const std::string bytes = message(kRanges, {});
  ScanReader reader(MessageKind::kMultiEcho, encoding(), Echo::kStrongest);
  const auto scan = reader.read(as_span(bytes));
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->ranges_m[3], 4);
  EXPECT_EQ(scan->intensities.size(), 0U);
  EXPECT_TRUE(reader.without_strength());
}

TEST_P(ScansOfEchoes, EveryCutIsMalformed) {
  const std::string bytes = message(kRanges, kIntensities);
  ScanReader reader(MessageKind::kMultiEcho, encoding());
  for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(reader.read(as_span(bytes).first(n))) << n;
  const std::string counts = MessageBytes(GetParam()).header(1, 2, "l").fill(28).fill(4).bytes();
  EXPECT_FALSE(reader.read(as_span(counts + std::string(4, '\xFF'))));
}

class ScansWithin : public ScansOfEchoes {
 protected:
  MessageTopic topic(const std::string& members) const {
    return {"/head", "my_msgs/Head", encoding(), true, "*", members};
  }
  /// A message that begins with `before` bytes, holds a scan and ends with a number.
  std::string head(std::size_t before) const {
    MessageBytes message(GetParam());
    for (std::size_t i = 0; i < before; ++i) message.number(std::uint8_t{1});
    message.header(7, 8, "laser");
    for (const float value : {-0.5F, 0.5F, 0.25F, 0.001F, 0.025F, 0.1F, 30.0F}) message.number(value);
    return message.array(std::vector<float>{1, 2, 3}).array(std::vector<float>{}).number(2.5).bytes();
  }
};
INSTANTIATE_TEST_SUITE_P(Ros1AndRos2, ScansWithin,
                         testing::Values(MessageBytes::kRos1, MessageBytes::kCdr,
                                         MessageBytes::kCdrBigEndian));

TEST_P(ScansWithin, AScanIsFoundWhereverItLies) {
  for (std::size_t before = 0; before < 9; ++before) {
    const std::string members =
        "uint8[" + std::to_string(before) + "] before\nsensor_msgs/LaserScan scan\nfloat64 angle\n";
    auto reader = ScanReader::by_definition(topic(members), {}, Echo::kFirst);
    ASSERT_TRUE(reader) << reader.error().message;
    const std::string bytes = head(before);
    const auto scan = reader->read(as_span(bytes));
    ASSERT_TRUE(scan) << before;
    EXPECT_EQ(scan->header_ns, 7'000'000'008) << before;
    EXPECT_EQ(scan->ranges_m.size(), 3U) << before;
    EXPECT_EQ(scan->ranges_m[2], 3) << before;
    for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(reader->read(as_span(bytes).first(n))) << n;
  }
}

TEST_P(ScansWithin, SeveralScansAreListedAndOneIsAskedFor) {
  const std::string members = "sensor_msgs/LaserScan left\nsensor_msgs/MultiEchoLaserScan right\n";
  const auto refusal = [&](const std::string& definition, const std::optional<std::string>& field) {
    const auto reader = ScanReader::by_definition(topic(definition), field, Echo::kFirst);
    return reader ? "accepted" : reader.error().message;
  };
  EXPECT_EQ(refusal(members, {}),
            "topic /head (my_msgs/Head) holds several scans. Name one in a rig file (laser: {topic: /head, "
            "field: left}, given with --rig). Its scans: left, right");
  EXPECT_EQ(refusal(members, "right"), "accepted");
  EXPECT_EQ(refusal(members, "up"),
            "topic /head (my_msgs/Head) has no scan \"up\", the rig's laser.field. Its scans: left, right");
  EXPECT_EQ(refusal("int8 a\n", {}),
            "topic /head (my_msgs/Head) is neither a sensor_msgs/LaserScan nor holds one");
}

}  // namespace
}  // namespace sweepscope
