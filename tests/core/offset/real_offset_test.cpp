#include <gtest/gtest.h>

#include "core/offset/estimator.hpp"
#include "core/offset/readings/fitting_recording.hpp"
#include "tests/core/recording/test_bag.hpp"

namespace sweepscope {
namespace {

// Two stampings of the same tilting scanner, of which one is known to lie 95.7 ms below the other. Its link
// stalls now and then and delivers messages up to 205 ms late; the robot stands still for the first 13 s.
TEST(RealOffset, ReceiveTimesAnswerAsMuchBelowHeaderStampsAsTheirDelaysSay) {
  const std::filesystem::path data = test::real_data();
  if (data.empty()) GTEST_SKIP() << "no real recordings: set SWEEPSCOPE_REAL_DATA to their folder";
  ReadOptions options;
  const auto rig = read_rig(std::filesystem::path(SWEEPSCOPE_SOURCE_DIR) / "assets/rigs/guardian_tilt.yaml");
  ASSERT_TRUE(rig) << rig.error().message;
  options.rig = *rig;
  for (const double until_s : {13.0, 14.5}) {
    std::vector<double> offsets_s;
    for (const StampSource stamps : {StampSource::kHeader, StampSource::kReceive}) {
      options.stamps = stamps;
      const auto part =
          read_fitting(data / "guardian_tilt/guardian_tilt_B.bag", options, Job(), TimeWindow{0, until_s});
      ASSERT_TRUE(part) << part.error().message;
      const auto found = estimate(*part, EstimateOptions(), Job());
      ASSERT_TRUE(found && found->identifiable);
      offsets_s.push_back(*found->offset_s);
    }
    EXPECT_NEAR(offsets_s[0] - offsets_s[1], 0.0957, 0.001) << "until " << until_s << " s";
  }
}

}  // namespace
}  // namespace sweepscope
