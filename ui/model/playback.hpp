#pragma once

#include <array>
#include <optional>
#include <vector>

#include "ui/model/placed_cloud.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// The scan of a moment, as it lies in a map.
struct PlayedScan {
  std::optional<std::size_t> scan;             // its number; empty: the recording has none
  std::vector<std::array<float, 3>> points_m;  // in the map frame, those that are on the map
  std::optional<Eigen::Vector3d> sensor_m;     // the sensor's place on the path; empty: the path is not known
};

/// The last scan whose first beam was fired at or before `time_s`, in seconds since the first scan; of a 3D
/// scanner with the other rings of its turn.
PlayedScan played_scan(const Placement& placement, double time_s);

/// The moment at which the scanner is drawn (laser clock): the one that is played, else the end of the part
/// in time that is shown, else the end of the recording, which is infinite.
double scanner_time_s(const Recording& recording, const Settings& settings);

}  // namespace sweepscope::ui
