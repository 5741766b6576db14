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
/// scan lines: one per ring if there is a field `ring`, `line` or `channel`, otherwise one per 10 ms,
/// numbered within the cloud like rings; points far from their neighbours in time then belong to several
/// beams, and the cloud is refused. The points of a line are sorted by time and placed on a grid of equal
/// time steps, the median step between points, since drivers leave out beams without a return; those are NaN.
/// All lines of a ring begin near the same azimuth, that of the first cloud. If the points of a ring do not
/// go round, as with a pattern that does not repeat itself, each ring is cut into slices of 10 ms.
///
/// A point's time is a field `t`, `time`, `timestamp` or `offset_time`, in the units of drivers: an integer
/// counts ns, or us where a cloud would take less than 0.5 ms; a number beyond any recording's length is a
/// time since 1970 in s, ms, us or ns; otherwise it counts from the stamp, in s, ms, us or ns, chosen by the
/// resulting duration of a cloud. Points without a range (0 0 0, NaN) are left out, and of a
/// Livox scanner, whose points have a `line` and a `tag`, those marked as noise.
class CloudReader {
 public:
  /// Adds a cloud's lines; `cloud` is what decoding it gave, empty if the message is malformed. Adds nothing
  /// and returns false if it is, or if its points have no position or no time.
  bool add(const std::optional<CloudMessage>& cloud, std::int64_t receive_ns, RawLaser& laser);
  /// The same of a sensor_msgs/PointCloud2.
  bool add(Encoding encoding, std::span<const std::byte> message, std::int64_t receive_ns, RawLaser& laser) {
    return add(decode_cloud(encoding, message), receive_ns, laser);
  }
  /// The last problem, for a person; empty if there was none.
  const std::string& problem() const { return problem_; }

  /// Whether a cloud's points tell the time since 1970, so that its header's stamp does not matter.
  static bool counts_since_1970(const CloudMessage& cloud);

 private:
  struct Point {
    double time = 0;  // as recorded
    Eigen::Vector3f p_m;
    float intensity = 0;
    std::uint32_t ring = 0;
  };
  bool read_points(const CloudMessage& cloud);
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
  double first_azimuth_rad_ = 0;    // of the cloud's first point, of any ring
  std::optional<double> cut_rad_;   // a little before the azimuth at which turns begin: of the first cloud
};

}  // namespace sweepscope
