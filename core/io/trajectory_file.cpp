#include "core/io/trajectory_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/io/atomic_file.hpp"
#include "core/io/text_cursor.hpp"

namespace sweepscope {

Result<void> write_tum(const std::filesystem::path& path, std::span<const StampedPose> trajectory,
                       std::int64_t epoch_ns) {
  std::string text = "# time_s x_m y_m z_m qx qy qz qw\n";
  for (const StampedPose& pose : trajectory) {
    const auto& p = pose.position_m;
    const auto& q = pose.orientation;
    // Whole nanoseconds: a double does not hold them beside the seconds since 1970.
    const std::int64_t ns = epoch_ns + std::llround(pose.time_s * 1e9);
    fmt::format_to(std::back_inserter(text),
                   "{}{}.{:09} {:.9f} {:.9f} {:.9f} {:.12f} {:.12f} {:.12f} {:.12f}\n", ns < 0 ? "-" : "",
                   std::abs(ns) / 1'000'000'000, std::abs(ns) % 1'000'000'000, p.x(), p.y(), p.z(), q.x(),
                   q.y(), q.z(), q.w());
  }
  return write_file(path, text);
}

Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& path, std::int64_t epoch_ns) {
  const Result<std::string> text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  std::vector<StampedPose> trajectory;
  double last_time_s = -std::numeric_limits<double>::infinity();
  TextCursor cursor(*text);
  while (const auto line = cursor.next_line()) {
    if (line->find_first_not_of(" \t") == std::string_view::npos || line->front() == '#') continue;
    TextCursor words(*line);
    std::array<double, 8> value{};
    for (double& number : value) {
      const auto word = words.next_number();
      if (!word || !std::isfinite(*word)) {
        return unreadable(fmt::format("{}: line {}: a pose is eight numbers, time x y z qx qy qz qw",
                                      path.string(), cursor.line()));
      }
      number = *word;
    }
    const Eigen::Quaterniond orientation(value[7], value[4], value[5], value[6]);
    if (std::abs(orientation.norm() - 1) > 1e-3) {
      return unreadable(
          fmt::format("{}: line {}: the quaternion's length is not 1", path.string(), cursor.line()));
    }
    if (!trajectory.empty() && value[0] <= last_time_s) {
      return unreadable(fmt::format("{}: line {}: the times do not ascend", path.string(), cursor.line()));
    }
    last_time_s = value[0];
    const double time_s = value[0] - static_cast<double>(epoch_ns) * 1e-9;
    trajectory.push_back({time_s, {value[1], value[2], value[3]}, orientation.normalized()});
  }
  return trajectory;
}

}  // namespace sweepscope
