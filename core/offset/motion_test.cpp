#include "core/offset/motion_test.hpp"

#include <algorithm>

#include "core/offset/search_window.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kMostPairs = 16;
constexpr double kStillTranslation_m = 0.04;  // what noise of 30 mm leaves of a rig that stands still is half of this
constexpr double kStillRotation_rad = 0.02;

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

MotionTest test_motion(const std::vector<PlacedSweep>& sweeps, const MotorMotion& motor,
                       const OdometryOptions& options) {
  std::vector<std::size_t> candidates;
  const auto whole = [&](const PlacedSweep& s) { return s.end_s - s.begin_s > 0.7 * motor.median_sweep_s; };
  for (std::size_t k = 0; k + 2 < sweeps.size(); ++k)
    if (sweeps[k + 2].sweep == sweeps[k].sweep + 2 && whole(sweeps[k]) && whole(sweeps[k + 2])) candidates.push_back(k);
  MotionTest test;
  std::vector<double> translations_m, rotations_rad;
  const std::size_t stride = std::max<std::size_t>(1, candidates.size() / kMostPairs);
  for (std::size_t i = 0; i < candidates.size(); i += stride) {
    const std::size_t k = candidates[i];
    const Registration found = register_rigidly(map_of(sweeps[k]), sweeps[k + 2], options);
    const double translation_m = found.target_from_source.translation_m.norm();
    const double rotation_rad = vector_from_rotation(found.target_from_source.rotation).norm();
    if (found.features < std::size_t(options.least_matches)) continue;  // too little to see for either answer
    ++test.pairs;
    if (!found.succeeded || translation_m > kStillTranslation_m || rotation_rad > kStillRotation_rad) ++test.moved;
    if (!found.succeeded) continue;
    translations_m.push_back(translation_m);
    rotations_rad.push_back(rotation_rad);
  }
  test.median_translation_m = median(translations_m);
  test.median_rotation_rad = median(rotations_rad);
  return test;
}

Result<MotionTest> test_motion(const Recording& recording, const Job& job) {
  const auto problem = prepare_problem(recording, 0, 0, {}, job);
  if (!problem) return tl::unexpected(problem.error());
  return test_motion(place_sweeps(*problem, 0), problem->motor, {});
}

}  // namespace sweepscope
