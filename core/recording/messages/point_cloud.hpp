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

/// The clouds of one topic (sensor_msgs/PointCloud2 with a time per point) as scan lines: one per ring if
/// there is a field `ring`, `line` or `channel`, otherwise one per 10 ms, numbered within the cloud like
/// rings; points far from their neighbours in time then belong to several beams, and the cloud is refused.
/// The points of a line are sorted by time and placed on a grid of equal time steps, the median step between
/// points, since drivers leave out beams without a return; those are NaN. All lines of a ring begin near the
/// same azimuth, that of the first cloud.
///
/// A point's time is a field `t`, `time`, `timestamp` or `offset_time`, in the units of drivers: an integer
/// counts ns, or us where a cloud would take less than 0.5 ms; a number beyond any recording's length is a
/// time since 1970 in s, ms, us or ns; otherwise it counts from the stamp, in s, ms, us or ns, chosen by the
/// resulting duration of a cloud. Points without a range (0 0 0, NaN) are left out.
class CloudReader {
 public:
  /// Adds a cloud's lines; adds nothing and returns false if the message is malformed, or its points have no
  /// position or no time.
  bool add(Encoding encoding, std::span<const std::byte> message, std::int64_t receive_ns, RawLaser& laser);
  /// The last problem, for a person; empty if there was none.
  const std::string& problem() const { return problem_; }

 private:
  struct Point {
    double time = 0;  // as recorded
    Eigen::Vector3f p_m;
    float intensity = 0;
    std::uint32_t ring = 0;
  };
  bool read_points(const DecodedCloud& cloud);
  bool choose_unit(bool whole_numbers);
  std::size_t beams_before(double azimuth_rad, double step_rad);
  void add_line(std::span<const Point> points, const RawScan& common, double origin, bool ringed,
                RawLaser& laser);

  std::string problem_;
  std::vector<Point> points_;
  bool has_intensity_ = false, has_ring_ = false;
  double unit_s_ = 0;              // of the times; 0: not known yet
  bool absolute_ = false;          // they are since 1970
  std::optional<double> cut_rad_;  // a little before the azimuth at which turns begin
};

}  // namespace sweepscope
