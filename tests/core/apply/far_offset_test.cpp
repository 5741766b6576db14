#include <gtest/gtest.h>

#include <cmath>

#include "core/apply/apply.hpp"
#include "core/apply/sweep_folder.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

/// The motor's period is 1 s.
class FarOffset : public test::FolderTest {
 protected:
  FarOffset() {
    SimulationOptions options;
    options.duration_s = 3;
    EXPECT_TRUE(write_bag(simulate(options, Job()).value(), folder_ / "in.bag", Job()));
  }
  Result<Applied> apply(double offset_s, bool far = false) const {
    ApplyOptions options;
    options.offset.offset_s = offset_s;
    options.far = far;
    return apply_offset(folder_ / "in.bag", folder_ / "out.bag", options, Job());
  }
};

TEST_F(FarOffset, BeyondTheMotorsPeriodIsRefusedUnlessItIsAskedFor) {
  for (const double offset_s : {24.0, -24.0, 1.01}) {
    const auto refused = apply(offset_s);
    ASSERT_FALSE(refused) << offset_s;
    EXPECT_EQ(refused.error().code, ExitCode::kWrongUsage);
    EXPECT_NE(refused.error().message.find("longer than the motor's period, 1"), std::string::npos)
        << refused.error().message;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.bag"));
    EXPECT_TRUE(apply(offset_s, true));
    std::filesystem::remove(folder_ / "out.bag");
  }
}

TEST_F(FarOffset, WithinTheMotorsPeriodIsApplied) {
  for (const double offset_s : {0.99, -0.5, 0.024}) EXPECT_TRUE(apply(offset_s)) << offset_s;
}

TEST_F(FarOffset, IsRefusedForSweepsAsFilesToo) {
  ApplyOptions options;
  options.offset.offset_s = 24;
  const auto refused = write_applied_sweeps(folder_ / "in.bag", options, folder_ / "sweeps", ".pcd", Job());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("longer than the motor's period"), std::string::npos);
}

}  // namespace
}  // namespace sweepscope
