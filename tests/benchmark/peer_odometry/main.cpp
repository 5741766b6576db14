// The odometry of others on the sweeps of a walk, at its true offset:
//
//   peer_odometry kiss-icp VOXEL_M STEM OUT.tum          kiss-icp-skewed: without its deskewing
//   peer_odometry loam_velodyne SCALE STEM OUT.tum
//
// STEM.bag and STEM.truth.json are the walk; or STEM is a folder that `sweepscope apply --clouds-only` wrote.
// Prints the seconds that a processor worked for a second of recording.
#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "peers.hpp"
#include "sweepscope/core/io/trajectory_file.hpp"
#include "sweepscope/core/recording/formats/read_recording.hpp"

namespace sweepscope {
namespace {

template <typename T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

std::vector<StampedPose> poses_of(const std::string& peer, const std::vector<PeerCloud>& clouds,
                                  double setting) {
  if (peer == "kiss-icp") return kiss_icp_poses(clouds, setting, true);
  if (peer == "kiss-icp-skewed") return kiss_icp_poses(clouds, setting, false);
  if (peer == "loam_velodyne") return loam_velodyne_poses(clouds, setting);
  throw std::runtime_error("there is no peer " + peer);
}

struct Walk {
  std::vector<PeerCloud> clouds;
  std::int64_t epoch_ns = 0;
};

Walk read_walk(const std::string& stem) {
  if (std::filesystem::is_directory(stem)) return {peer_clouds(std::filesystem::path(stem)), 0};
  const Recording recording = must(read_recording(stem + ".bag", {}, Job()));
  const double offset_ms = nlohmann::json::parse(std::ifstream(stem + ".truth.json"))["offset_ms"];
  return {peer_clouds(recording, offset_ms / 1e3), recording.epoch_ns};
}

int run(const std::vector<std::string>& words) {
  if (words.size() != 4) {
    fmt::print(stderr,
               "peer_odometry kiss-icp VOXEL_M STEM OUT.tum | kiss-icp-skewed VOXEL_M STEM OUT.tum | "
               "loam_velodyne SCALE STEM OUT.tum\n");
    return 2;
  }
  const double setting = std::stod(words[1]);
  const std::string& stem = words[2];
  const auto [clouds, epoch_ns] = read_walk(stem);
  if (clouds.empty()) throw std::runtime_error(stem + " has no whole sweep");
  const std::clock_t begin = std::clock();
  const std::vector<StampedPose> poses = poses_of(words[0], clouds, setting);
  const double worked_s = double(std::clock() - begin) / CLOCKS_PER_SEC;
  must(write_tum(words[3], poses, epoch_ns));
  fmt::print("{:.4f}\n", worked_s / (clouds.back().end_s - clouds.front().begin_s));
  return 0;
}

}  // namespace
}  // namespace sweepscope

int main(int argc, char** argv) {
  try {
    return sweepscope::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    fmt::print(stderr, "peer_odometry: {}\n", error.what());
    return 1;
  }
}
