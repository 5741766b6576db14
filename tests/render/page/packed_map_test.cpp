#include "render/page/packed_map.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "core/map/offset_map.hpp"
#include "core/offset/walk.hpp"
#include "render/page/html.hpp"
#include "render/page/live_map.hpp"
#include "render/page/page.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

/// What a page reads of packed bytes, written down independently of the packing.
class Unpacked {
 public:
  explicit Unpacked(const PackedMap& packed)
      : head_(nlohmann::json::parse(packed.head_json)), bytes_(packed.bytes) {}

  template <typename Number>
  std::vector<Number> array(const char* name) const {
    const std::size_t begin = head_["arrays"][name][0], size = head_["arrays"][name][1];
    EXPECT_EQ(begin % 8, 0u) << name;
    std::vector<Number> numbers(size / sizeof(Number));
    std::memcpy(numbers.data(), bytes_.data() + begin, size);
    return numbers;
  }

  TurnableMap map() const {
    TurnableMap map;
    map.axis = Eigen::Vector3d(double(head_["axis"][0]), double(head_["axis"][1]), double(head_["axis"][2]));
    map.moving = head_["moving"];
    read_beams(map);
    const auto middles_s = array<double>("scans");
    const auto counts = array<std::uint32_t>("counts");
    for (std::size_t i = 0; i < middles_s.size(); ++i) map.scans.push_back({middles_s[i], counts[i]});
    const auto motor = array<double>("motor"), sweeps = array<double>("sweeps");
    for (std::size_t i = 0; i < motor.size(); i += 2) {
      map.motor.time_s.push_back(motor[i]);
      map.motor.angle_rad.push_back(motor[i + 1]);
    }
    for (std::size_t i = 0; i < sweeps.size(); i += 2) {
      map.sweeps.emplace_back().begin_s = sweeps[i];
      map.sweeps.back().end_s = sweeps[i + 1];
    }
    read_path(map);
    return map;
  }

 private:
  void read_beams(TurnableMap& map) const {
    const auto words = array<std::uint32_t>("beams");
    const double step_m = head_["step_m"], tick_s = head_["tick_s"], origin_s = head_["laser_origin_s"];
    for (std::size_t i = 0; i < words.size(); i += 3) {
      const std::uint32_t steps[3] = {words[i] & 0x1fffff, words[i] >> 21 | (words[i + 1] & 0x3ff) << 11,
                                      words[i + 1] >> 10};
      TurnableBeam& beam = map.beams.emplace_back();
      for (std::size_t axis = 0; axis < 3; ++axis)
        beam.p_in_motor_m[axis] = float(double(head_["corner_m"][axis]) + step_m * steps[axis]);
      beam.time_s = origin_s + tick_s * words[i + 2];
    }
  }

  void read_path(TurnableMap& map) const {
    const auto path = array<double>("path");
    const auto knots = array<float>("knots");
    std::size_t k = 0;
    for (std::size_t i = 0; i < path.size(); i += 4) {
      SweepPose& pose = map.path.emplace_back();
      pose.sweep = static_cast<std::size_t>(path[i]);
      pose.begin_s = path[i + 1];
      pose.end_s = path[i + 2];
      pose.knots.clear();
      for (int n = 0; n < int(path[i + 3]); ++n, k += 7) {
        pose.knots.push_back({Eigen::Quaterniond(knots[k + 6], knots[k + 3], knots[k + 4], knots[k + 5]),
                              Eigen::Vector3d(knots[k], knots[k + 1], knots[k + 2])});
      }
    }
  }

  nlohmann::json head_;
  const std::string& bytes_;
};

void expect_same_places(const TurnableMap& map, std::initializer_list<double> offsets_s) {
  const PackedMap packed = pack_map(map);
  const TurnableMap read = Unpacked(packed).map();
  ASSERT_EQ(read.beams.size(), map.beams.size());
  for (const double offset_s : offsets_s) {
    const auto was_m = positions_at(map, offset_s), is_m = positions_at(read, offset_s);
    double greatest_m = 0;
    for (std::size_t i = 0; i < was_m.size(); ++i) {
      ASSERT_EQ(std::isnan(was_m[i][0]), std::isnan(is_m[i][0]));
      for (std::size_t axis = 0; axis < 3 && !std::isnan(was_m[i][0]); ++axis)
        greatest_m = std::max(greatest_m, std::abs(double(was_m[i][axis]) - is_m[i][axis]));
    }
    EXPECT_LT(greatest_m, 0.2e-3) << offset_s;
  }
}

TEST(PackedMap, OfAStationaryRigIsReadBackWithinAFractionOfAMillimetre) {
  const PreparedRecording prepared = prepare(test::room(24 * kMs), FeatureOptions(), Job()).value();
  expect_same_places(turnable_map(prepared, nullptr, 10 * kMs, 40 * kMs), {10 * kMs, 24 * kMs, 39.99 * kMs});
}

TEST(PackedMap, OfAWalkIsReadBackWithinAFractionOfAMillimetre) {
  const Simulation& walk = test::simulated("metro-station", 24 * kMs, 8);
  const PreparedRecording prepared = prepare(walk.recording, FeatureOptions(), Job()).value();
  MapOptions options;
  options.assume = RigKind::kMoving;
  const std::vector<double> offsets_s{24 * kMs};
  const auto maps = build_maps(prepared, offsets_s, options, Job()).value();
  expect_same_places(turnable_map(prepared, &maps[0].walk->sweeps, 15 * kMs, 33 * kMs),
                     {15 * kMs, 24 * kMs, 33 * kMs});
}

TEST(PackedMap, OfALongRecordingHasCoarserTicksThatAreStillExact) {
  TurnableMap map;
  map.motor = {{0, 7200}, {0, 1}};
  map.scans = {{0, 1}, {7199, 1}};
  map.beams = {{{1, 0, 0}, 0, 0}, {{0, 1, 0}, 0, 7199}};
  const PackedMap packed = pack_map(map);
  EXPECT_NEAR(Unpacked(packed).map().beams[1].time_s, 7199, 4e-6);
}

TEST(PackedMap, OfNothingIsNothing) {
  EXPECT_TRUE(Unpacked(pack_map({})).map().beams.empty());
}

LiveMap live_room(std::size_t points) {
  const PreparedRecording prepared = prepare(test::room(24 * kMs), FeatureOptions(), Job()).value();
  const std::vector<double> offsets_s{19 * kMs, 24 * kMs};
  std::vector<ComparedMap> still;
  const auto maps = build_maps(prepared, offsets_s, {}, Job()).value();
  for (const OffsetMap& map : maps) {
    still.emplace_back().offset_s = map.offset_s;
    still.back().cloud = map.cloud;
    still.back().path = map.trajectory;
  }
  return live_map(prepared, nullptr, std::move(still), std::nullopt, points);
}

nlohmann::json head_of(const std::string& data) {
  const std::string begin = "id=\"live-head\">";
  const std::size_t at = data.find(begin) + begin.size();
  return nlohmann::json::parse(data.substr(at, data.find("</script>", at) - at));
}

TEST(LiveMap, HasTheNumberOfPointsAskedForAndThatDecidesTheSize) {
  const LiveMap few = live_room(2000), many = live_room(50'000);
  EXPECT_EQ(few.map.beams.size(), 2000u);
  EXPECT_EQ(many.map.beams.size(), 50'000u);
  const std::size_t more_bytes = live_map_data(many)->size() - live_map_data(few)->size();
  EXPECT_NEAR(double(more_bytes) / 48'000, 13 * 4 / 3.0, 0.1);  // 13 bytes a point as base64
  EXPECT_LT(kMaxLivePoints * 13 * 4 / 3, 9'000'000u) << "with pictures a page stays below 12 MB";
}

TEST(LiveMap, ColoursAreThoseOfThePictureThatStandsStill) {
  const LiveMap live = live_room(2000);
  const nlohmann::json head = head_of(*live_map_data(live));
  const nlohmann::json& elevation = head["colourings"][0];
  const ColourTable table = *colour_table("viridis");
  std::string bytes;
  for (const Colour& colour : table)
    for (const std::uint8_t channel : {colour.red, colour.green, colour.blue, colour.alpha})
      bytes += static_cast<char>(channel);
  EXPECT_EQ(elevation["by"], "elevation");
  EXPECT_EQ(elevation["table"], html::base64(bytes));
  EXPECT_LT(double(elevation["from"]), -0.8);
  EXPECT_GT(double(elevation["to"]), double(elevation["from"]) + 1);
  EXPECT_EQ(head["offset_ms"].dump(), "[19.0,24.0]");
}

TEST(LiveMap, CanBeTurnedByAQuarterOfThePeriodAtMost) {
  const PreparedRecording prepared = prepare(test::room(24 * kMs), FeatureOptions(), Job()).value();
  const OffsetSpan span = live_span(prepared, 19 * kMs, 24 * kMs);
  EXPECT_NEAR(span.from_s, 9 * kMs, 1e-9);
  EXPECT_NEAR(span.to_s, 34 * kMs, 1e-9);
}

TEST(HtmlPage, NamesAreEscapedInTextAndInData) {
  const std::string page =
      html_page("</title><script>x", "", html::json_block("j", R"({"n": "</script><b>"})"));
  EXPECT_NE(page.find("<title>&lt;/title&gt;&lt;script&gt;x</title>"), std::string::npos);
  EXPECT_NE(page.find(R"(\u003c/script>\u003cb>)"), std::string::npos);
}

TEST(HtmlPage, ItsPolicyAllowsNothingFromOutside) {
  const std::string with = html_page("t", "", html::json_block("j", "{}")), without = html_page("t", "", "");
  for (const std::string& page : {with, without}) {
    EXPECT_NE(page.find("Content-Security-Policy\" content=\"default-src 'none'; img-src data:;"),
              std::string::npos);
    EXPECT_EQ(page.find("unsafe"), std::string::npos);
    EXPECT_EQ(page.find("src=\"http"), std::string::npos);
  }
  EXPECT_NE(with.find("; script-src 'sha256-"), std::string::npos);
  EXPECT_EQ(without.find("<script"), std::string::npos);
  EXPECT_EQ(without.find("script-src"), std::string::npos);
}

}  // namespace
}  // namespace sweepscope
