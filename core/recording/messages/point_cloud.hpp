#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/recording/messages/messages.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// The clouds of one topic (sensor_msgs/PointCloud2 with a time per point, or a Livox driver's CustomMsg) as
/// scan lines: one per ring where there is a field `ring`, `line` or `channel`, else one per 10 ms, numbered
/// within the cloud like rings; points that neighbours in time lie far beside are then of several beams, and
/// refused. Points of a line are sorted by time and laid on a grid of equal time steps, the median step from
/// point to point, since drivers leave out beams that returned nothing; those are NaN. All lines of a ring
/// begin near one azimuth, that of the first cloud. Where the points of a ring do not go round, as those of
/// scanners whose pattern does not repeat itself, each ring is cut into slices of 10 ms.
///
/// A point's time is a field `t`, `time`, `timestamp` or `offset_time`, in the units of drivers: an integer
/// counts ns, or us where a cloud would take less than 0.5 ms; a number beyond any recording's length is a
/// time since 1970 in s, ms, us or ns; else it is after the stamp, in s, ms, us or ns by how long a cloud
/// then takes. Points without a range (0 0 0, NaN) are left out, and of a Livox scanner, whose points have a
/// `line` and a `tag`, those that it holds for noise.
class CloudReader {
 public:
  /// Adds a cloud's lines; `cloud` is what decoding it gave, empty where the message is malformed. False, and
  /// nothing added, where it is, or its points have no place or no time.
  bool add(const std::optional<DecodedCloud>& cloud, std::int64_t receive_ns, RawLaser& laser);
  /// The same of a sensor_msgs/PointCloud2.
  bool add(Encoding encoding, std::span<const std::byte> message, std::int64_t receive_ns, RawLaser& laser) {
    return add(decode_cloud(encoding, message), receive_ns, laser);
  }
  /// What was last not as it should be, for a person; empty where nothing was.
  const std::string& problem() const { return problem_; }

 private:
  struct Point {
    double time = 0;  // as recorded
    Eigen::Vector3f p_m;
    float intensity = 0;
    std::uint32_t ring = 0;
  };
  bool read_points(const DecodedCloud& cloud);
  void number_slices(double first_time);
  bool choose_unit(bool whole_numbers, double known_s);
  std::size_t beams_before(double azimuth_rad, double step_rad);
  void add_line(std::span<const Point> points, const RawScan& common, double origin, bool ringed,
                RawLaser& laser);

  std::string problem_;
  std::vector<Point> points_;
  bool has_intensity_ = false, has_ring_ = false;
  std::optional<bool> goes_round_;  // the points of each ring, about the z axis; judged by the first cloud
  double unit_s_ = 0;               // of the times; 0: not known yet
  bool absolute_ = false;           // they are since 1970
  std::optional<double> cut_rad_;   // a little before the azimuth at which turns begin
};

}  // namespace sweepscope
