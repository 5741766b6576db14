#include "core/together/common_offset.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sweepscope {
namespace {

// An answer whose sigma is made of a statistical part and one that all recordings have in common.
Estimate answer(double offset_s, double statistical_s, double encoder_s) {
  Estimate found;
  found.identifiable = true;
  found.offset_s = offset_s;
  found.sigma_s = std::hypot(statistical_s, encoder_s);
  found.sigma_parts = {{"statistical", statistical_s}, {"encoder", encoder_s}};
  return found;
}

double part(const CommonOffset& common, const std::string& name) {
  for (const SigmaPart& one : common.sigma_parts)
    if (one.name == name) return one.sigma_s;
  return 0;
}

TEST(CommonOffset, IsWeightedAndOnlyTheStatisticalPartAveragesOut) {
  const Estimate a = answer(0.023, 3e-4, 4e-4), b = answer(0.024, 3e-4, 4e-4);
  const CommonOffset common = common_offset({&a, &b});
  EXPECT_DOUBLE_EQ(*common.offset_s, 0.0235);
  EXPECT_NEAR(part(common, "encoder"), 4e-4, 1e-12);
  EXPECT_NEAR(part(common, "statistical"), 3e-4 / std::sqrt(2.0) * std::sqrt(2.0), 1e-12);  // chi-square is 2
  EXPECT_NEAR(*common.sigma_s, 5e-4, 1e-12);
  const Estimate sharper = answer(0.024, 1e-4, 0), blunt = answer(0.020, 3e-4, 0);
  const CommonOffset weighted = common_offset({&sharper, &blunt});
  EXPECT_NEAR(weighted.shares[0], 0.9, 1e-12);
  EXPECT_NEAR(*weighted.offset_s, 0.0236, 1e-12);
}

TEST(CommonOffset, OffsetsThatScatterMoreThanTheirSigmasWidenIt) {
  const Estimate a = answer(0.0230, 1e-4, 0), b = answer(0.0236, 1e-4, 0);
  const CommonOffset common = common_offset({&a, &b});
  EXPECT_NEAR(common.agreement.chi_square, 18, 1e-9);
  EXPECT_EQ(common.agreement.degrees_of_freedom, 1);
  EXPECT_NEAR(*common.sigma_s, 1e-4 / std::sqrt(2.0) * std::sqrt(18.0), 1e-12);
}

TEST(CommonOffset, TheOneWithoutWhichTheOthersAgreeIsNamed) {
  const Estimate a = answer(0.0240, 1e-4, 0), b = answer(0.0280, 1e-4, 0), c = answer(0.0241, 1e-4, 0);
  const OffsetAgreement agreement = common_offset({&a, &b, &c}).agreement;
  EXPECT_EQ(agreement.degrees_of_freedom, 2);
  ASSERT_TRUE(agreement.odd_one);
  EXPECT_EQ(*agreement.odd_one, 1u);
  EXPECT_NEAR(agreement.odd_apart_s, 0.0280 - 0.02405, 1e-9);
  EXPECT_FALSE(common_offset({&a, &b}).agreement.odd_one);
}

TEST(CommonOffset, AnEstimateWithoutAnOffsetHasNoShare) {
  const Estimate a = answer(0.024, 1e-4, 0);
  Estimate refused;
  const CommonOffset common = common_offset({&refused, &a});
  EXPECT_EQ(common.shares, (std::vector<double>{0, 1}));
  EXPECT_DOUBLE_EQ(*common.offset_s, 0.024);
  EXPECT_EQ(common.agreement.degrees_of_freedom, 0);
  EXPECT_FALSE(common_offset({&refused}).offset_s);
}

}  // namespace
}  // namespace sweepscope
