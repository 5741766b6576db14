#include "core/offset/search/motor_images.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope {
namespace {

// By how much the ranges change from a scan to the next one; absent where too few beams return something.
std::optional<double> change_m(const Recording& recording, std::size_t scan) {
  constexpr double kCap_m = 0.3;  // beside edges ranges differ by metres
  constexpr std::size_t kMinBeams = 20;
  const std::span<const float> before = recording.ranges(recording.scans[scan]),
                               after = recording.ranges(recording.scans[scan + 1]);
  double sum_m = 0;
  std::size_t beams = 0;
  for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
    const double change_m = std::abs(double(after[i]) - double(before[i]));
    if (!std::isfinite(change_m) || !(before[i] > 0) || !(after[i] > 0)) continue;
    sum_m += std::min(change_m, kCap_m);
    ++beams;
  }
  return beams < kMinBeams ? std::nullopt : std::optional(sum_m / double(beams));
}

// How the scans changed, and how far the motor turned meanwhile.
struct Changes {
  std::vector<double> of_scans, of_motor;
};

double correlation(const Changes& changes) {
  const Eigen::Map<const Eigen::ArrayXd> x(changes.of_scans.data(), Eigen::Index(changes.of_scans.size())),
      y(changes.of_motor.data(), Eigen::Index(changes.of_motor.size()));
  const Eigen::ArrayXd dx = x - x.mean(), dy = y - y.mean();
  const double squares = dx.square().sum() * dy.square().sum();
  return squares > 0 ? (dx * dy).sum() / std::sqrt(squares) : 0;
}

}  // namespace

double best_of_images_s(const PreparedRecording& prepared, double given_s, double reach_s) {
  constexpr double kBetterCorrelation = 0.05;
  constexpr std::size_t kMinChanges = 20;
  const Recording& recording = *prepared.recording;
  const double sweep_s = prepared.motor.median_sweep_s;
  if (!recording.directions.empty() || recording.scans.size() < 2) return given_s;
  std::vector<std::optional<double>> changes_m;
  for (std::size_t i = 0; i + 1 < recording.scans.size(); ++i) changes_m.push_back(change_m(recording, i));
  const auto agreement = [&](double offset_s, const std::vector<char>& used) {
    Changes changes;
    for (std::size_t i = 0; i < changes_m.size(); ++i) {
      if (!changes_m[i] || !used[i] || !used[i + 1]) continue;
      const auto middle_s = [&](const LaserScan& scan) {
        return (scan.first_beam_s + scan.last_beam_s()) / 2 + offset_s;
      };
      changes.of_scans.push_back(*changes_m[i]);
      changes.of_motor.push_back(std::abs(recording.motor.angle_at(middle_s(recording.scans[i + 1])) -
                                          recording.motor.angle_at(middle_s(recording.scans[i]))));
    }
    return changes.of_scans.size() < kMinChanges ? -1 : correlation(changes);
  };
  double best_s = given_s, best = kBetterCorrelation;  // more than the given one
  const double first_s = given_s - sweep_s * std::floor((given_s + reach_s) / sweep_s);
  for (double image_s = first_s; image_s <= reach_s; image_s += sweep_s) {
    if (std::abs(image_s - given_s) < sweep_s / 2) continue;
    const auto [from_s, to_s] = std::minmax(image_s, given_s);
    const std::vector<char> used = scans_covered(recording, from_s, to_s);
    const double better = agreement(image_s, used) - agreement(given_s, used);
    if (better <= best) continue;
    best_s = image_s;
    best = better;
  }
  return best_s;
}

}  // namespace sweepscope
