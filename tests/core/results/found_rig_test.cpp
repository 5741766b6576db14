#include "core/results/found_rig.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/results/rig_json.hpp"
#include "tests/core/results/solved_rig_by_hand.hpp"

namespace sweepscope {
namespace {

std::string document() {
  return nlohmann::ordered_json{{"parameters", rig_parameters_json(test::solved_rig_by_hand())}}.dump();
}

TEST(FoundRig, IsReadBackFromTheJsonOfAnEstimate) {
  const auto found = parse_found_rig(document(), "E.json");
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_TRUE(*found);
  EXPECT_EQ((*found)->rig.mount.laser_in_motor_rpy_deg, Eigen::Vector3d(0, 3.0021, -1.5));
  EXPECT_EQ((*found)->play.reason, "The motor turns at one speed only.");
  const auto nothing = parse_found_rig(R"({"offset_ms": 24})", "E.json");
  ASSERT_TRUE(nothing);
  EXPECT_FALSE(*nothing);
}

TEST(FoundRig, WhatIsNoSuchDocumentIsRefusedByItsName) {
  for (const char* text : {"{", R"({"parameters": 3, "offset_ms": 1})", R"({"parameters": {"mount": {}}})",
                           R"({"parameters": {"mount": {"identifiable": true, "rpy_deg": [1, 2]}}})"}) {
    const auto found = parse_found_rig(text, "E.json");
    ASSERT_FALSE(found) << text;
    EXPECT_EQ(found.error().code, ExitCode::kUnreadableInput);
    EXPECT_TRUE(found.error().message.starts_with("E.json: ")) << found.error().message;
  }
}

TEST(FoundRig, GoesIntoARigWithNotesOfItsSourceAndOfWhatWasNotDetermined) {
  DetectedRig detected;
  detected.rig.gear.play_deg = 0.2;
  detected = with_found(std::move(detected), **parse_found_rig(document(), "E.json"), "estimate --solve");
  EXPECT_EQ(detected.rig.mount.laser_in_motor_rpy_deg, Eigen::Vector3d(0, 3.0021, -1.5));
  EXPECT_EQ(detected.rig.gear.encoder_phase_deg, 40);
  EXPECT_EQ(detected.rig.gear.play_deg, 0.2) << "unchanged";
  EXPECT_TRUE(
      detected.mount_note.starts_with("found by estimate --solve: +- 0.0000, 0.0040, 0.0040 deg and "))
      << detected.mount_note;
  EXPECT_EQ(detected.play_note,
            "not determined by estimate --solve, unchanged: The motor turns at one speed only.");
  EXPECT_EQ(detected.encoder_note, "found by estimate --solve: +- 0.0100 deg");
}

}  // namespace
}  // namespace sweepscope
