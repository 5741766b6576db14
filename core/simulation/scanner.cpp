#include "core/simulation/scanner.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace sweepscope::simulation {
namespace {

constexpr std::array kBeamTimes{
    std::pair{BeamTimes::kSpread, std::string_view("spread")},
    std::pair{BeamTimes::kInstant, std::string_view("instant")},
    std::pair{BeamTimes::kReversed, std::string_view("reversed")},
};

// Where a data sheet states limits of the error and no standard deviation, the deviation is a third of them.
constexpr std::array kScanners{
    Scanner{},
    Scanner{.name = "utm30lx", .beams = 1081, .angle_min_deg = -135},
    Scanner{.name = "ust10lx", .beams = 1081, .angle_min_deg = -135, .range_min_m = 0.06, .range_max_m = 10},
    Scanner{.name = "urg04lx",
            .beams = 682,
            .angle_min_deg = -340 * 360.0 / 1024,
            .angle_increment_deg = 360.0 / 1024,
            .scan_period_s = 0.1,
            .time_increment_s = 0.1 / 1024,
            .range_min_m = 0.02,
            .range_max_m = 5.6,
            .noise_m = 0.003,
            .noise_per_m = 0.0033},
    Scanner{.name = "tim571",
            .beams = 811,
            .angle_min_deg = -135,
            .angle_increment_deg = 1.0 / 3,
            .scan_period_s = 1.0 / 15,
            .time_increment_s = 1.0 / 16200,
            .range_min_m = 0.05,
            .range_max_m = 25,
            .noise_m = 0.020},
    Scanner{.name = "lms111",
            .beams = 541,
            .angle_min_deg = -135,
            .angle_increment_deg = 0.5,
            .scan_period_s = 0.02,
            .time_increment_s = 0.02 / 720,
            .range_min_m = 0.5,
            .range_max_m = 20,
            .noise_m = 0.012},
    Scanner{.name = "rplidar-a1",
            .beams = 800,
            .angle_min_deg = -180,
            .angle_increment_deg = 0.45,
            .scan_period_s = 0.1,
            .time_increment_s = 0.1 / 800,
            .range_min_m = 0.15,
            .range_max_m = 12,
            .noise_m = 0.001,
            .noise_per_m = 0.0033,
            .beam_times = BeamTimes::kReversed},
    Scanner{.name = "rplidar-s2",
            .beams = 3200,
            .angle_min_deg = -180,
            .angle_increment_deg = 0.1125,
            .scan_period_s = 0.1,
            .time_increment_s = 0.1 / 3200,
            .range_min_m = 0.15,
            .range_max_m = 30,
            .noise_m = 0.010,
            .beam_times = BeamTimes::kReversed},
    Scanner{.name = "ld19",
            .beams = 450,
            .angle_min_deg = 0,
            .angle_increment_deg = 0.8,
            .scan_period_s = 0.1,
            .time_increment_s = 0.1 / 450,
            .range_min_m = 0.02,
            .range_max_m = 12,
            .noise_m = 0.010,
            .beam_times = BeamTimes::kReversed},
    Scanner{.name = "vlp16",
            .beams = 1808,
            .angle_min_deg = 180,
            .angle_increment_deg = -360 * 55.296e-6 / 0.1,
            .scan_period_s = 0.1,
            .time_increment_s = 55.296e-6,
            .range_min_m = 0.4,
            .range_max_m = 100,
            .noise_m = 0.010,
            .rings = 16,
            .lowest_ring_deg = -15,
            .ring_step_deg = 2,
            .ring_interval_s = 2.304e-6},
};

}  // namespace

std::optional<BeamTimes> beam_times(std::string_view name) {
  for (const auto& [times, its_name] : kBeamTimes)
    if (its_name == name) return times;
  return std::nullopt;
}

std::string_view name_of(BeamTimes times) {
  return std::ranges::find(kBeamTimes, times, [](const auto& entry) { return entry.first; })->second;
}

std::vector<std::string_view> beam_times_names() {
  std::vector<std::string_view> names;
  for (const auto& [times, name] : kBeamTimes) names.push_back(name);
  return names;
}

std::optional<Scanner> scanner(std::string_view name) {
  const auto found = std::ranges::find(kScanners, name, &Scanner::name);
  return found == kScanners.end() ? std::nullopt : std::optional(*found);
}

std::vector<std::string_view> scanner_names() {
  std::vector<std::string_view> names;
  for (const Scanner& one : kScanners) names.push_back(one.name);
  return names;
}

}  // namespace sweepscope::simulation
