#include "render/page/packed_map.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string_view>

#include "core/map/offset_map.hpp"
#include "core/map/place_beams.hpp"
#include "render/comparison/colouring.hpp"
#include "render/comparison/comparison.hpp"
#include "render/comparison/comparison_points.hpp"
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

// Where the page's shader puts its beams, by the formula of TurnableMap; NaN where a scan belongs to no
// sweep.
std::vector<std::array<float, 3>> positions_at(const TurnableMap& map, double offset_s) {
  std::vector<std::array<float, 3>> positions_m;
  std::size_t first = 0;
  for (const TurnableScan& scan : map.scans) {
    const auto in_sweep = [&](const Sweep& sweep) {
      return sweep.begin_s <= scan.middle_s + offset_s && scan.middle_s + offset_s < sweep.end_s;
    };
    const auto sweep = std::ranges::find_if(map.sweeps, in_sweep);
    const auto number = static_cast<std::size_t>(sweep - map.sweeps.begin());
    const auto pose = std::ranges::find(map.path, number, &SweepPose::sweep);
    for (std::size_t i = first; i < first + scan.beams; ++i) {
      const TurnableBeam& beam = map.beams[i];
      const auto& [x_m, y_m, z_m] = beam.p_in_motor_m;
      const Eigen::AngleAxisd turn(map.motor.angle_at(beam.time_s + offset_s), map.axis);
      Eigen::Vector3d p_m = turn * Eigen::Vector3d(x_m, y_m, z_m);
      if (map.moving && pose != map.path.end())
        p_m = pose->at((beam.time_s - pose->begin_s) / (pose->end_s - pose->begin_s)) * p_m;
      if (sweep == map.sweeps.end() || (map.moving && pose == map.path.end())) p_m.setConstant(std::nan(""));
      positions_m.push_back({float(p_m.x()), float(p_m.y()), float(p_m.z())});
    }
    first += scan.beams;
  }
  return positions_m;
}

double max_apart_m(const std::vector<std::array<float, 3>>& a_m,
                   const std::vector<std::array<float, 3>>& b_m) {
  double max_m = 0;
  for (std::size_t i = 0; i < a_m.size(); ++i) {
    EXPECT_EQ(std::isnan(a_m[i][0]), std::isnan(b_m[i][0])) << i;
    for (std::size_t axis = 0; axis < 3 && !std::isnan(a_m[i][0]); ++axis)
      max_m = std::max(max_m, std::abs(double(a_m[i][axis]) - double(b_m[i][axis])));
  }
  return max_m;
}

// A page places its beams where the engine does.
void expect_same_places(const PreparedRecording& prepared, const MapPath& path,
                        std::initializer_list<double> offsets_s) {
  const Beams beams = collect_beams(*prepared.recording, path.used, 7);
  std::vector<std::uint32_t> all(beams.size());
  std::iota(all.begin(), all.end(), 0);
  const TurnableMap map = turnable_map(beams, path, all);
  const PackedMap packed = pack_map(map);
  const TurnableMap read = Unpacked(packed).map();
  ASSERT_EQ(read.beams.size(), map.beams.size());
  for (const double offset_s : offsets_s) {
    const auto placed_m = place_beams(beams, path, offset_s);
    EXPECT_LT(max_apart_m(positions_at(map, offset_s), placed_m), 2e-5) << offset_s;
    EXPECT_LT(max_apart_m(positions_at(read, offset_s), placed_m), 0.2e-3) << offset_s;
  }
}

TEST(PackedMap, OfAStationaryRigIsReadBackWithinAFractionOfAMillimetre) {
  const PreparedRecording prepared = prepare(test::room(24 * kMs), FeatureOptions(), Job()).value();
  const MapPath path = path_without_solving(prepared, scans_covered(*prepared.recording, 10 * kMs, 40 * kMs));
  expect_same_places(prepared, path, {10 * kMs, 24 * kMs, 39.99 * kMs});
}

TEST(PackedMap, OfAWalkIsReadBackWithinAFractionOfAMillimetre) {
  const Simulation& walk = test::simulated("metro-station", 24 * kMs, 8);
  const PreparedRecording prepared = prepare(walk.recording, FeatureOptions(), Job()).value();
  MapOptions options;
  options.assume = RigKind::kMoving;
  const MapPath path = find_map_path(prepared, 15 * kMs, 33 * kMs, options, Job()).value();
  expect_same_places(prepared, path, {15 * kMs, 24 * kMs, 33 * kMs});
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
  EXPECT_NEAR(double(more_bytes) / 48'000, 16.25 * 4 / 3, 0.1);  // bytes a point as base64
}

TEST(LiveMap, OfTheMostPointsLeavesRoomForThePicturesInTwelveMegabytes) {
  LiveMap few = live_room(2000), many = live_room(50'000);
  for (LiveMap* live : {&few, &many}) live->colours.blur.resize(2);  // as with so many points
  const double bytes_a_point = double(live_map_data(many)->size() - live_map_data(few)->size()) / 48'000;
  EXPECT_LT(kMaxLivePoints * bytes_a_point, 10.2e6);
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

std::string decoded(const std::string& base64) {
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char digit : base64) {
    const std::size_t value =
        std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/").find(digit);
    if (value == std::string_view::npos) break;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  return bytes;
}

/// The colours that a page gives to its beams, as its data have them.
class PageColours {
 public:
  explicit PageColours(const LiveMap& live) : data_(*live_map_data(live)), head_(head_of(data_)) {
    const std::string begin = "id=\"live-data\">";
    const std::size_t at = data_.find(begin) + begin.size();
    bytes_ = decoded(data_.substr(at, data_.find("</script>", at) - at));
  }
  nlohmann::json colouring(const std::string& by) const {
    for (const auto& one : head_["colourings"])
      if (one["by"] == by) return one;
    return {};
  }
  std::string array(const std::string& name) const {
    return bytes_.substr(head_["arrays"][name][0], head_["arrays"][name][1]);
  }
  /// Red, green and blue of a place in the table.
  std::array<int, 3> colour(const std::string& by, char place) const {
    const std::string table = decoded(colouring(by)["table"]);
    const auto channel = [&](std::size_t i) {
      return int(static_cast<std::uint8_t>(table[4 * static_cast<std::uint8_t>(place) + i]));
    };
    return {channel(0), channel(1), channel(2)};
  }

 private:
  std::string data_;
  nlohmann::json head_;
  std::string bytes_;
};

/// Of each drawn beam its point in the map A or B of the room: no two beams of it have the same time.
std::vector<std::size_t> points_of(const LiveMap& live, std::size_t map) {
  const MapCloud& cloud = *live.still[map].cloud;
  std::map<double, std::size_t> at;
  for (std::size_t i = 0; i < cloud.size(); ++i) at[cloud[i].time_s] = i;
  EXPECT_EQ(at.size(), cloud.size());
  std::vector<std::size_t> points;
  for (const TurnableBeam& beam : live.map.beams) {
    const auto found = at.find(beam.time_s);
    points.push_back(found == at.end() ? cloud.size() : found->second);
  }
  return points;
}

std::array<int, 3> channels(const Colour& colour) {
  return {colour.red, colour.green, colour.blue};
}

/// The scale of a picture of both maps.
ColourScale scale_of(const LiveMap& live, ColourBy by) {
  ComparisonOptions options;
  options.colour_by = by;
  const auto slabs = choose_slabs(live.still, options);
  std::vector<SlabPoints> shown;
  for (const ComparedMap& map : live.still)
    shown.push_back(points_in_slabs(map, *colour_values(map, nullptr, by), slabs));
  const std::vector<std::span<const float>> values{shown[0].points.values, shown[1].points.values};
  return make_colouring(by, "viridis", values, std::nullopt)->scale;
}

TEST(LiveMap, BlurIsThatOfTheWholeMapsAtBothOffsetsInTheColoursOfThePicture) {
  const LiveMap live = live_room(20'000);
  const PageColours page(live);
  const ColourScale scale = scale_of(live, ColourBy::kBlur);
  const nlohmann::json given = page.colouring("blur")["given"];
  ASSERT_EQ(given.size(), 3u);
  EXPECT_EQ(given[2]["offset_ms"], 29.0);
  for (std::size_t map = 0; map < 2; ++map) {
    EXPECT_EQ(given[map]["offset_ms"], map == 0 ? 19.0 : 24.0);
    const std::string places = page.array(given[map]["array"]);
    const std::vector<float> thickness_mm = *colour_values(live.still[map], nullptr, ColourBy::kBlur);
    const std::vector<std::size_t> points = points_of(live, map);
    std::size_t none = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_LT(points[i], thickness_mm.size());
      const double value = double(thickness_mm[points[i]]);
      ASSERT_EQ(page.colour("blur", places[i]), channels(scale.at(value))) << i << ": " << value << " mm";
      none += std::isnan(value) ? 1 : 0;
    }
    EXPECT_GT(none, 0u);
    EXPECT_GT(points.size() - none, 1000u);
  }
}

TEST(LiveMap, BlurAsFarBeyondTheAnswerIsThatOfTheMapThere) {
  const LiveMap live = live_room(20'000);
  const std::vector<double> offsets_s{29 * kMs};
  const PreparedRecording prepared = prepare(test::room(24 * kMs), FeatureOptions(), Job()).value();
  ComparedMap map;
  map.offset_s = offsets_s[0];
  map.cloud = build_maps(prepared, offsets_s, {}, Job()).value()[0].cloud;
  measure_thickness(map);
  const BeamBlur expected = blur_of_beams(live.map, positions_at(live.map, offsets_s[0]), map),
                 &found = live.colours.blur.at(2);
  // The map here has the scans at its ends as well, which the motor does not cover at all offsets of the
  // page.
  std::size_t equal = 0;
  for (std::size_t i = 0; i < found.thickness_m.size(); ++i) {
    const float apart_m = std::abs(found.thickness_m[i] - expected.thickness_m[i]);
    equal += std::isnan(found.thickness_m[i]) ? std::isnan(expected.thickness_m[i]) : apart_m < 2e-3F;
  }
  EXPECT_DOUBLE_EQ(found.offset_s, 29 * kMs);
  EXPECT_GT(equal, found.thickness_m.size() * 9 / 10);
}

TEST(LiveMap, FeaturesAreThoseThatWereExtracted) {
  const LiveMap live = live_room(20'000);
  const PageColours page(live);
  const std::string packed = page.array("features");
  const std::vector<float> kinds = *colour_values(live.still[1], nullptr, ColourBy::kFeatures);
  const std::vector<std::size_t> points = points_of(live, 1);
  std::array<int, 3> of_kinds{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int kind = packed[i / 4] >> 2 * (i % 4) & 3;
    ASSERT_EQ(kind, int(kinds.at(points[i])));
    ++of_kinds.at(static_cast<std::size_t>(kind));
  }
  EXPECT_GT(*std::ranges::min_element(of_kinds), 100);
  const nlohmann::json classes = page.colouring("features")["classes"];
  ASSERT_EQ(classes.size(), 3u);
  EXPECT_EQ(classes[1].dump(), R"({"colour":[242,180,41],"name":"edge"})");
}

TEST(LiveMap, IntensitiesHaveTheColoursOfThePicture) {
  const LiveMap live = live_room(20'000);
  const PageColours page(live);
  const ColourScale scale = scale_of(live, ColourBy::kIntensity);
  const std::string places = page.array("intensity");
  for (std::size_t i = 0; i < places.size(); ++i)
    ASSERT_EQ(page.colour("intensity", places[i]), channels(scale.at(double(live.map.beams[i].intensity))));
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
