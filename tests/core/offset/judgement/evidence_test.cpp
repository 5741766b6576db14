#include "core/offset/judgement/evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sweepscope {
namespace {

constexpr double kMillisecond_s = 1e-3;

/// Blocks of a second.
OffsetEvidence evidence_of(const std::vector<double>& offsets_ms, double min_window_s = 3,
                           double sigma_ms = 0) {
  OffsetEvidence evidence;
  std::vector<double> times_s, offsets_s;
  for (const double offset_ms : offsets_ms) {
    times_s.push_back(double(times_s.size()) + 0.5);
    offsets_s.push_back(offset_ms * kMillisecond_s);
    evidence.parts.push_back({times_s.back(), offsets_s.back(), 0, sigma_ms * kMillisecond_s});
  }
  evidence.trend = trend_of(times_s, offsets_s);
  evidence.duration_s = double(offsets_ms.size());
  evidence.min_window_s = min_window_s;
  return evidence;
}

RefusalKind kind_of(const Verdict& verdict) {
  return verdict.refusals.empty() ? RefusalKind::kUnknown : verdict.refusals.front().kind;
}

bool names_over_time(const Verdict& verdict) {
  return !verdict.refusals.empty() &&
         verdict.refusals.front().text.find("estimate --over-time") != std::string::npos;
}

TEST(Evidence, OfAConstantOffsetLeavesSigmaAsItIs) {
  const Verdict verdict =
      judge_constant(evidence_of({24, 24.02, 23.98, 24.01, 23.99}), 0.02 * kMillisecond_s);
  EXPECT_EQ(verdict.sigma_s, 0.02 * kMillisecond_s);
  EXPECT_TRUE(verdict.refusals.empty() && verdict.warnings.empty() && verdict.widened.empty());
}

TEST(Evidence, AJumpIsNoDrift) {
  for (const std::vector<double>& offsets_ms : {std::vector<double>{24, 24, 29, 29},
                                                {24, 24, 24, 27, 29, 29},
                                                {24, 24, 24, 24, 24, 24, 24, 24, 29, 29}}) {
    const Verdict verdict = judge_constant(evidence_of(offsets_ms), 0.5 * kMillisecond_s);
    EXPECT_EQ(kind_of(verdict), RefusalKind::kOffsetJumps);
  }
  const Verdict drift = judge_constant(evidence_of({24, 25, 26.02, 27, 27.99, 29}), 0.5 * kMillisecond_s);
  EXPECT_EQ(kind_of(drift), RefusalKind::kClocksDrift);
}

TEST(Evidence, AShortRecordingWhoseOffsetJumpsIsRefused) {
  EXPECT_EQ(kind_of(judge_constant(evidence_of({0, 3}), 0.17 * kMillisecond_s)), RefusalKind::kOffsetChanges);
  EXPECT_EQ(kind_of(judge_constant(evidence_of({0, 0.3}), 0.17 * kMillisecond_s)), RefusalKind::kUnknown);
}

TEST(Evidence, AChangeThatThePartsAreTooUncertainForIsNone) {
  for (const std::vector<double>& offsets_ms : {std::vector<double>{0, 3}, {24, 24, 29, 29}}) {
    const Verdict certain = judge_constant(evidence_of(offsets_ms, 3, 0.02), 0.04 * kMillisecond_s),
                  uncertain = judge_constant(evidence_of(offsets_ms, 3, 4), 0.04 * kMillisecond_s);
    EXPECT_TRUE(!certain.refusals.empty() || !certain.widened.empty());
    EXPECT_TRUE(uncertain.refusals.empty());
    EXPECT_GT(*uncertain.sigma_s, kMillisecond_s);  // it covers the difference
  }
}

TEST(Evidence, NamesOverTimeOnlyWhereThatAnswers) {
  const std::vector<double> jump_ms{24, 24, 24, 24, 24, 24, 24, 29, 29, 29, 29, 29, 29, 29},
      drift_ms{24, 25, 26.02, 27, 27.99, 29};
  EXPECT_TRUE(names_over_time(judge_constant(evidence_of(jump_ms, 3), 0.5 * kMillisecond_s)));
  EXPECT_FALSE(names_over_time(judge_constant(evidence_of(jump_ms, 4), 0.5 * kMillisecond_s)));
  EXPECT_TRUE(names_over_time(judge_constant(evidence_of(drift_ms, 1.5), 0.5 * kMillisecond_s)));
  const Verdict too_short = judge_constant(evidence_of(drift_ms, 3), 0.5 * kMillisecond_s);
  ASSERT_FALSE(too_short.refusals.empty());
  EXPECT_NE(too_short.refusals[0].text.find("Record at least 12 s"), std::string::npos)
      << too_short.refusals[0].text;
}

TEST(Evidence, HalvesThatDisagreeWidenSigma) {
  const Verdict verdict =
      judge_constant(evidence_of({24, 24.1, 24, 24.3, 24.4, 24.3}), 0.03 * kMillisecond_s);
  ASSERT_TRUE(verdict.sigma_s);
  EXPECT_NEAR(*verdict.sigma_s, 0.15 * kMillisecond_s, 0.01 * kMillisecond_s);
  EXPECT_TRUE(verdict.refusals.empty());
  EXPECT_EQ(verdict.warnings.size(), 1U);
}

TEST(Evidence, AFitThatDidNotConvergeHasNoAnswer) {
  OffsetEvidence evidence;
  evidence.converged = false;
  evidence.last_step_s = 0.003 * kMillisecond_s;
  EXPECT_EQ(kind_of(judge_constant(evidence, 0.02 * kMillisecond_s)), RefusalKind::kNotConverged);
  evidence.steps_may_alternate = true;
  const Verdict walk = judge_constant(evidence, 0.004 * kMillisecond_s);
  EXPECT_TRUE(walk.refusals.empty());
  EXPECT_EQ(walk.warnings.size(), 1U);
  EXPECT_NEAR(*walk.sigma_s, 0.005 * kMillisecond_s, 1e-9);
  EXPECT_EQ(kind_of(judge_constant(evidence, 0.002 * kMillisecond_s)), RefusalKind::kNotConverged);
}

TEST(Evidence, ResidualsAboveTheRangeNoiseWidenSigmaOrRefuse) {
  OffsetEvidence evidence;
  evidence.range_noise_m = 0.010;
  evidence.lever_m_s = 5;
  evidence.residual_m = 0.009;
  EXPECT_EQ(judge_constant(evidence, 0.02 * kMillisecond_s).sigma_s, 0.02 * kMillisecond_s);
  evidence.residual_m = 0.050;
  const Verdict wider = judge_constant(evidence, 0.02 * kMillisecond_s);
  EXPECT_NEAR(*wider.sigma_s, std::hypot(0.040 / 5, 0.02 * kMillisecond_s), 1e-9);
  EXPECT_EQ(wider.warnings.size(), 1U);
  evidence.residual_m = 0.099;
  EXPECT_EQ(kind_of(judge_constant(evidence, 0.02 * kMillisecond_s)), RefusalKind::kLargeResiduals);
}

TEST(Evidence, WindowsFarOffTheirCourseWidenSigmaOrRefuse) {
  OffsetEvidence evidence;
  evidence.parts = {{5, 24 * kMillisecond_s, 24 * kMillisecond_s, 0.02 * kMillisecond_s},
                    {15, 24.05 * kMillisecond_s, 24 * kMillisecond_s, 0.02 * kMillisecond_s}};
  EXPECT_EQ(judge_course(evidence, 0.01 * kMillisecond_s).sigma_s, 0.01 * kMillisecond_s);
  evidence.parts[1].offset_s = 24.3 * kMillisecond_s;
  EXPECT_NEAR(*judge_course(evidence, 0.01 * kMillisecond_s).sigma_s, 0.1 * kMillisecond_s,
              0.001 * kMillisecond_s);
  evidence.parts[1].offset_s = 28 * kMillisecond_s;
  const Verdict refused = judge_course(evidence, 0.01 * kMillisecond_s);
  ASSERT_EQ(kind_of(refused), RefusalKind::kNoCourse);
  EXPECT_NE(refused.refusals[0].text.find("at 15.0 s it is 28.0 ms, and 24.0 ms"), std::string::npos)
      << refused.refusals[0].text;
}

}  // namespace
}  // namespace sweepscope
