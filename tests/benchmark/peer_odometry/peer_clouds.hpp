#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "sweepscope/core/recording/recording.hpp"

namespace sweepscope {

struct PeerPoint {
  Eigen::Vector3d p_in_base_m;
  double u = 0;  // where in the sweep: 0 at its begin, 1 at its end
};

/// What a spinning 3D scanner would have given for one sweep of the motor: the motor's motion is taken out,
/// the rig's is not.
struct PeerCloud {
  double begin_s = 0, end_s = 0;              // laser clock
  std::vector<std::vector<PeerPoint>> lines;  // one for each scan, in the order of time
};

/// Of every whole sweep, with each beam in the sweep of its own instant. Those that the recording's begin or
/// end cut short are left out: the peers predict each cloud's motion from the last one's, as if all lasted
/// equally long.
std::vector<PeerCloud> peer_clouds(const Recording& recording, double offset_s);

/// Those of a folder that `sweepscope apply --clouds-only` wrote, in the order of their names.
std::vector<PeerCloud> peer_clouds(const std::filesystem::path& folder);

}  // namespace sweepscope
