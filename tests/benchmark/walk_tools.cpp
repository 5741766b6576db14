// What tests/benchmark/walks needs beside the shipped program.
//
//   walk_tools mesh SCENE OUT.ply                  one of the project's scenes as a mesh
//   walk_tools distance CLOUD MESH                 how far a cloud's points lie from a mesh
//   walk_tools error TRUTH.tum TRAJECTORY.tum      how far a trajectory is from the true one, aligned rigidly
//   walk_tools row NAME TRUTH_STEM ESTIMATE.json TRAJECTORY.tum     a line of the table; `head` for its first
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/io/cloud_file.hpp"
#include "core/io/trajectory_file.hpp"
#include "core/simulation/meshes/mesh_file.hpp"
#include "core/simulation/meshes/ray_caster.hpp"
#include "tests/scene_mesh.hpp"

namespace sweepscope {
namespace {

using Poses = std::vector<StampedPose>;

template <typename T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

/// Neither trajectory is needed beyond the other.
StampedPose at(const Poses& poses, double time_s) {
  const auto after = std::lower_bound(poses.begin() + 1, poses.end() - 1, time_s,
                                      [](const StampedPose& pose, double t_s) { return pose.time_s < t_s; });
  const StampedPose &from = *(after - 1), &to = *after;
  const double u = (time_s - from.time_s) / (to.time_s - from.time_s);
  return {time_s, from.position_m + u * (to.position_m - from.position_m),
          from.orientation.slerp(u, to.orientation)};
}

/// The root of the mean square distance after the best rigid alignment (Umeyama 1991, without scale).
double aligned_rms_m(const Poses& truth, const Poses& estimated) {
  std::vector<const StampedPose*> used;
  for (const StampedPose& pose : estimated)
    if (pose.time_s >= truth.front().time_s && pose.time_s <= truth.back().time_s) used.push_back(&pose);
  if (used.size() < 3) return std::nan("");
  Eigen::Matrix3Xd from(3, used.size()), to(3, used.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    from.col(Eigen::Index(i)) = used[i]->position_m;
    to.col(Eigen::Index(i)) = at(truth, used[i]->time_s).position_m;
  }
  const Eigen::Matrix4d to_from = Eigen::umeyama(from, to, false);
  const Eigen::Matrix3Xd off =
      (to_from.topLeftCorner<3, 3>() * from).colwise() + to_from.topRightCorner<3, 1>() - to;
  return std::sqrt(off.squaredNorm() / double(used.size()));
}

struct Motion {
  double length_m = 0, median_radps = 0, top_radps = 0;
};

/// Of a true trajectory, over 20 ms each.
Motion motion_of(const Poses& truth) {
  Motion motion;
  for (std::size_t i = 1; i < truth.size(); ++i)
    motion.length_m += (truth[i].position_m - truth[i - 1].position_m).norm();
  std::vector<double> rates_radps;
  for (double t_s = truth.front().time_s; t_s + 0.02 < truth.back().time_s; t_s += 0.02)
    rates_radps.push_back(at(truth, t_s).orientation.angularDistance(at(truth, t_s + 0.02).orientation) /
                          0.02);
  std::sort(rates_radps.begin(), rates_radps.end());
  motion.median_radps = rates_radps[rates_radps.size() / 2];
  motion.top_radps = rates_radps.back();
  return motion;
}

int print_distance(const std::string& cloud_file, const std::string& mesh_file) {
  const auto cloud = must(read_cloud(cloud_file));
  const simulation::RayCaster scene(must(simulation::read_mesh(mesh_file)));
  constexpr double kFar_m = 1;
  std::vector<double> distances_m;
  for (const auto& point : *cloud)
    distances_m.push_back(scene.distance_m({point.x, point.y, point.z}, kFar_m).value_or(kFar_m));
  std::sort(distances_m.begin(), distances_m.end());
  double squares_m2 = 0;
  for (const double distance_m : distances_m) squares_m2 += distance_m * distance_m;
  const double count = double(distances_m.size());
  fmt::print("{} points: RMS {:.2f} mm, median {:.2f} mm, 99 % below {:.2f} mm, farthest {:.2f} mm\n",
             distances_m.size(), std::sqrt(squares_m2 / count) * 1e3,
             distances_m[distances_m.size() / 2] * 1e3, distances_m[distances_m.size() * 99 / 100] * 1e3,
             distances_m.back() * 1e3);
  return 0;
}

int print_error(const std::string& truth_file, const std::string& file) {
  const Poses truth = must(read_tum(truth_file));
  const double rms_m = aligned_rms_m(truth, must(read_tum(file)));
  const double length_m = motion_of(truth).length_m;
  fmt::print("{:.4f} m, {:.3f} % of {:.1f} m\n", rms_m, 100 * rms_m / length_m, length_m);
  return 0;
}

void print_head() {
  fmt::print("{:<26} {:>7} {:>7} {:>6} {:>9} {:>9} {:>8} {:>7} {:>7} {:>8} {:>7}\n", "walk", "length",
             "median", "top", "answer", "truth", "error", "sigma", "error", "RMSE", "RMSE");
  fmt::print("{:<26} {:>7} {:>7} {:>6} {:>9} {:>9} {:>8} {:>7} {:>7} {:>8} {:>7}\n", "", "m", "rad/s",
             "rad/s", "ms", "ms", "ms", "ms", "sigmas", "m", "%");
}

int print_row(const std::string& name, const std::string& stem, const std::string& estimate_file,
              const std::string& trajectory_file) {
  using Json = nlohmann::json;
  const Json truth = Json::parse(std::ifstream(stem + ".truth.json"));
  const Json estimate = Json::parse(std::ifstream(estimate_file));
  const Poses path = must(read_tum(stem + ".truth.tum"));
  const Motion motion = motion_of(path);
  const double truth_ms = truth["offset_ms"];
  std::string row = fmt::format("{:<26} {:>7.1f} {:>7.2f} {:>6.2f} ", name, motion.length_m,
                                motion.median_radps, motion.top_radps);
  const bool sigma = !estimate["sigma_ms"].is_null();
  if (estimate["offset_ms"].is_null()) {
    row += fmt::format("{:>9} {:>9.3f} {:>8} {:>7} {:>7} ", "refused", truth_ms, "-", "-", "-");
  } else {
    const double answer_ms = estimate["offset_ms"], error_ms = answer_ms - truth_ms;
    row += fmt::format("{:>9.3f} {:>9.3f} {:>8.3f} ", answer_ms, truth_ms, error_ms);
    row += sigma ? fmt::format("{:>7.3f} {:>7.1f} ", double(estimate["sigma_ms"]),
                               std::abs(error_ms) / double(estimate["sigma_ms"]))
                 : fmt::format("{:>7} {:>7} ", "-", "-");
  }
  if (!std::filesystem::exists(trajectory_file)) {
    fmt::print("{}{:>8} {:>7}\n", row, "-", "-");
    return 0;
  }
  const double rms_m = aligned_rms_m(path, must(read_tum(trajectory_file)));
  fmt::print("{}{:>8.4f} {:>7.3f}\n", row, rms_m, 100 * rms_m / motion.length_m);
  return 0;
}

int run(const std::vector<std::string>& words) {
  const auto is = [&](const char* name, std::size_t count) {
    return words.size() == count + 1 && words[0] == name;
  };
  if (is("mesh", 2)) return test::write_scene_mesh(words[1], words[2]), 0;
  if (is("distance", 2)) return print_distance(words[1], words[2]);
  if (is("error", 2)) return print_error(words[1], words[2]);
  if (is("row", 4)) return print_row(words[1], words[2], words[3], words[4]);
  if (is("head", 0)) return print_head(), 0;
  fmt::print(stderr,
             "walk_tools mesh SCENE OUT.ply | distance CLOUD MESH | error TRUTH.tum TRAJECTORY.tum | row "
             "NAME TRUTH_STEM ESTIMATE.json TRAJECTORY.tum | head\n");
  return 2;
}

}  // namespace
}  // namespace sweepscope

int main(int argc, char** argv) {
  try {
    return sweepscope::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    fmt::print(stderr, "walk_tools: {}\n", error.what());
    return 1;
  }
}
