#include "core/results/estimate_json.hpp"

#include <gtest/gtest.h>

namespace sweepscope {
namespace {

Estimate stationary_estimate() {
  Estimate estimate;
  estimate.recording = "room-1.bag";
  estimate.method = Method::kStationary;
  estimate.kind = RigKind::kStationary;
  estimate.kind_reason = "As assumed.";
  estimate.identifiable = true;
  estimate.offset_s = 0.0239;
  estimate.sigma_s = 0.00005;
  estimate.criteria = {{"d", 0.0239, 0.0037}};
  CurvePoint point;
  point.offset_s = 0.0191;
  point.d = 0.05;
  point.translation_m = 0.01;
  point.rotation_rad = 0.049;
  point.signed_rotation_rad = -0.048;
  CurvePoint failed;
  failed.offset_s = 0.0201;
  estimate.curve = {point, failed};
  estimate.sweeps = 8;
  estimate.scans = 160;
  estimate.cpu_s = 1.5;
  estimate.wall_s = 0.75;
  return estimate;
}

TEST(EstimateJson, HasTheDocumentedKeysInTheDocumentedOrder) {
  const std::string expected = R"({
  "schema": "sweepscope.estimate/1",
  "recording": "room-1.bag",
  "method": "stationary",
  "equation": "t_motor = t_laser + offset",
  "identifiable": true,
  "offset_ms": 23.9,
  "sigma_ms": 0.05,
  "drift_ppm": null,
  "kind": "stationary",
  "kind_reason": "As assumed.",
  "lost_s": [],
  "warnings": [],
  "reasons": [],
  "reason_codes": [],
  "readings": [],
  "criteria": {
    "d": {
      "offset_ms": 23.9,
      "value": 0.0037
    }
  },
  "curve": [
    {
      "offset_ms": 19.1,
      "d": 0.05,
      "translation_m": 0.01,
      "rotation_rad": 0.049,
      "signed_rotation_rad": -0.048,
      "n": null,
      "e_m": null,
      "capped_cost_m": null
    },
    {
      "offset_ms": 20.1,
      "d": null,
      "translation_m": null,
      "rotation_rad": null,
      "signed_rotation_rad": null,
      "n": null,
      "e_m": null,
      "capped_cost_m": null
    }
  ],
  "sweeps": 8,
  "scans": 160,
  "cpu_s": 1.5,
  "wall_s": 0.75,
  "version": ")" SWEEPSCOPE_VERSION "\"\n}\n";
  EXPECT_EQ(estimate_to_json(stationary_estimate()), expected);
}

TEST(EstimateJson, WithoutTimingTwoRunsGiveTheSameBytes) {
  Estimate slow = stationary_estimate(), fast = stationary_estimate();
  slow.cpu_s = 9;
  slow.wall_s = 8;
  EXPECT_EQ(estimate_to_json(slow, Timing::kNull), estimate_to_json(fast, Timing::kNull));
  EXPECT_NE(estimate_to_json(slow, Timing::kNull).find("\"cpu_s\": null"), std::string::npos);
}

TEST(EstimateJson, ARefusalHasNoOffset) {
  Estimate estimate = stationary_estimate();
  estimate.identifiable = false;
  estimate.refusals = {refusal(RefusalKind::kMotorDoesNotMove, 0.1, 0.1)};
  const std::string text = estimate_to_json(estimate);
  EXPECT_NE(text.find("\"offset_ms\": null,\n  \"sigma_ms\": null"), std::string::npos);
  EXPECT_NE(text.find("\"The motor does not move: its angle stays within 0.10 deg.\""), std::string::npos);
  EXPECT_EQ(parse_estimate_json(text, "a.json").value().refusals.at(0).kind, RefusalKind::kMotorDoesNotMove);
}

TEST(EstimateJson, ReasonsOfAVersionWithoutCodesAreReadAsTheyAre) {
  Estimate estimate = stationary_estimate();
  estimate.refusals = {refusal(RefusalKind::kMotorDoesNotMove, 0.1, 0.1)};
  std::string text = estimate_to_json(estimate);
  const auto begin = text.find("  \"reason_codes\""), end = text.find("]", begin);
  text.erase(begin, text.find('\n', end) + 1 - begin);
  const Refusal read = parse_estimate_json(text, "a.json").value().refusals.at(0);
  EXPECT_EQ(read.kind, RefusalKind::kUnknown);
  EXPECT_EQ(read.text, estimate.refusals[0].text);
}

TEST(EstimateJson, ReadsBackWhatItWrote) {
  Estimate written = stationary_estimate();
  written.curve[1].n = 12345;
  written.curve[1].e_m = 0.0123;
  written.curve[1].capped_cost_m = 0.04;
  written.drift_ppm = -12.5;
  written.warnings = {"n and e are 1.2 ms apart."};
  const auto read = parse_estimate_json(estimate_to_json(written), "a.json");
  ASSERT_TRUE(read);
  EXPECT_EQ(estimate_to_json(*read), estimate_to_json(written));
  EXPECT_DOUBLE_EQ(*read->offset_s, 0.0239);
  EXPECT_FALSE(read->curve[1].d);
  EXPECT_EQ(*read->curve[1].n, 12345);
}

TEST(EstimateJson, TheTrajectoryUsedAndTheFitReadBack) {
  Estimate written = stationary_estimate();
  written.fit = FitEvidence{true, 5, 4000, 3900, 0.0071, 2.5, 4.25};
  for (const auto kind : {UsedMotion::Kind::kPoses, UsedMotion::Kind::kOdometry, UsedMotion::Kind::kImu}) {
    UsedMotion motion;
    motion.kind = kind;
    motion.name = kind == UsedMotion::Kind::kPoses ? "camera.tum" : "/topic";
    motion.trusted = kind == UsedMotion::Kind::kPoses;
    motion.time_shift_s = 0.137;
    written.motion = motion;
    const auto read = parse_estimate_json(estimate_to_json(written), "a.json");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(estimate_to_json(*read), estimate_to_json(written));
    ASSERT_TRUE(read->motion && read->fit);
    EXPECT_EQ(read->motion->kind, kind);
    EXPECT_EQ(read->motion->trusted, motion.trusted);
    EXPECT_EQ(read->motion->time_shift_s, 0.137);
    EXPECT_FALSE(read->motion->time_shift_sigma_s);
    EXPECT_EQ(read->fit->iterations, 5);
    EXPECT_EQ(read->fit->lever_m, 2.5);
  }
}

TEST(EstimateJson, WhatSeveralRecordingsContributeReadsBack) {
  Estimate estimate = stationary_estimate();
  Together& together = estimate.together.emplace();
  RecordingOfRig first;
  first.recording = "a.bag";
  first.offset_s = 24.02e-3, first.sigma_s = 0.04e-3;
  first.share = 0.75;
  first.turn_sigma_rad = 2e-3, first.shift_sigma_m = 8e-3;
  first.residual_before_m = 0.031, first.residual_after_m = 0.011;
  RecordingOfRig second;
  second.recording = "b.bag";
  second.reasons = {"The motor does not move."};
  together.recordings = {first, second};
  together.chi_square = 3.5, together.degrees_of_freedom = 2;
  const std::string json = estimate_to_json(estimate);
  const auto read = parse_estimate_json(json, "a.json");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(estimate_to_json(*read), json);
  std::string without = json;
  without.replace(without.find("\"share\""), 7, "\"part\"");
  EXPECT_NE(parse_estimate_json(without, "a.json").error().message.find("recordings.share"),
            std::string::npos);
}

TEST(EstimateJson, CountsAreWrittenWithoutADecimalPoint) {
  Estimate estimate = stationary_estimate();
  estimate.curve[0].n = 2'345'678;
  EXPECT_NE(estimate_to_json(estimate).find("\"n\": 2345678,"), std::string::npos);
}

TEST(EstimateJson, ErrorsNameTheFileAndThePlace) {
  const auto message = [](std::string_view text) {
    return parse_estimate_json(text, "a.json").error().message;
  };
  EXPECT_EQ(message("{\"schema\": "), "a.json: not JSON: invalid at byte 12");
  EXPECT_EQ(message("[]"), "a.json: not an estimate: it is not a JSON object");
  EXPECT_EQ(message("[1e999]"), "a.json: not an estimate: a number in it is too large");
  EXPECT_EQ(message(R"({"schema": "other/1"})"),
            "a.json: not an estimate: schema is not sweepscope.estimate/1");
  std::string text = estimate_to_json(stationary_estimate());
  text.replace(text.find("0.049"), 5, "\"abc\"");
  EXPECT_EQ(message(text), "a.json: not an estimate: curve[0].rotation_rad is neither a number nor null");
  text = estimate_to_json(stationary_estimate());
  text.replace(text.find("19.1"), 4, "1e12");
  EXPECT_EQ(message(text), "a.json: not an estimate: curve[0].offset_ms lies beyond 1000 s");
  for (const char* count : {"5e110", "-8", "1.5", "18446744073709551615", "null"}) {
    text = estimate_to_json(stationary_estimate());
    text.replace(text.find("\"sweeps\": 8"), 11, std::string("\"sweeps\": ") + count);
    EXPECT_EQ(message(text), "a.json: not an estimate: sweeps is not a whole number from 0 to 1000000000000")
        << count;
  }
}

TEST(EstimateJson, ANameThatIsNotUtf8StillMakesADocument) {
  Estimate estimate = stationary_estimate();
  estimate.recording = "r\xff.bag";
  EXPECT_TRUE(parse_estimate_json(estimate_to_json(estimate), "a.json"));
}

TEST(CurveCsv, NamesUnitsAndLeavesAbsentValuesEmpty) {
  EXPECT_EQ(curve_to_csv(stationary_estimate()),
            "offset_ms,d,translation_m,rotation_rad,signed_rotation_rad,n,e_m,capped_cost_m\n"
            "19.1,0.05,0.01,0.049,-0.048,,,\n"
            "20.1,,,,,,,\n");
}

}  // namespace
}  // namespace sweepscope
