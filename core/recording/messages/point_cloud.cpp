#include "core/recording/messages/point_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

constexpr double kSlice_s = 0.010;
constexpr std::uint32_t kMaxRings = 1024;
constexpr std::uint32_t kMaxBeams_a_line = 60'000;  // features count beams in 16 bits
constexpr std::size_t kSparsest = 8;                // steps of the time's grid per point, at the most

/// The first of the names that the cloud has, with a datatype that is a number.
const CloudField* field_of(const CloudMessage& cloud, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names)
    for (const CloudField& field : cloud.fields)
      if (field.name == name && field.size() > 0) return &field;
  return nullptr;
}

/// A Livox scanner's tag: bits 0 and 1 say how likely a point is noise by where it lies, bits 2 and 3 by its
/// intensity. Those above count returns, or mark other points that are near the scanner.
bool tagged_as_noise(double tag) {
  return (static_cast<unsigned>(std::clamp(tag, 0.0, 255.0)) & 0xfU) != 0;
}

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2 * std::numbers::pi);
}

template <typename Points>
double median_step(const Points& points) {
  std::vector<double> steps = spacings(points, &Points::value_type::time);
  std::erase_if(steps, [](double step) { return !(step > 0); });
  return median(std::move(steps));
}

/// How far one beam of a ring lies beside the next, about the z axis. Where returns are missing over more
/// than half a turn, as in the sky, the whole turns in between are those that the other beams tell.
double azimuth_step_rad(const std::vector<Eigen::Vector3f>& directions,
                        const std::vector<std::uint32_t>& beams) {
  const auto azimuth_rad = [&](std::size_t i) {
    return double{std::atan2(directions[beams[i]].y(), directions[beams[i]].x())};
  };
  std::vector<double> steps_rad;
  for (std::size_t i = 1; i < beams.size(); ++i)
    steps_rad.push_back(wrapped(azimuth_rad(i) - azimuth_rad(i - 1)) / (beams[i] - beams[i - 1]));
  const double step_rad = median(std::move(steps_rad));
  double turned_rad = 0;
  for (std::size_t i = 1; i < beams.size(); ++i) {
    const double expected_rad = step_rad * (beams[i] - beams[i - 1]);
    turned_rad += expected_rad + wrapped(azimuth_rad(i) - azimuth_rad(i - 1) - expected_rad);
  }
  return turned_rad / (beams.back() - beams.front());
}

/// The same of a slice of time, along its own path.
double path_step_rad(const std::vector<Eigen::Vector3f>& directions,
                     const std::vector<std::uint32_t>& beams) {
  double turned_rad = 0;
  for (std::size_t i = 1; i < beams.size(); ++i) {
    const Eigen::Vector3f &a = directions[beams[i - 1]], &b = directions[beams[i]];
    turned_rad += double{std::atan2(a.cross(b).norm(), a.dot(b))};
  }
  return turned_rad / (beams.back() - beams.front());
}

double angle_between_rad(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return double{std::atan2(a.cross(b).norm(), a.dot(b))};
}

/// Whether the points of each ring, in the order of time, go round the z axis one way.
template <typename Points>
bool go_round(const Points& points) {
  constexpr double kMaxBack = 0.1, kStationary_rad = 1e-5;
  std::size_t left = 0, right = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i].ring != points[i - 1].ring) continue;
    const Eigen::Vector3f &a = points[i - 1].p_m, &b = points[i].p_m;
    const double step_rad = wrapped(double{std::atan2(b.y(), b.x())} - double{std::atan2(a.y(), a.x())});
    if (std::abs(step_rad) < kStationary_rad) continue;
    ++(step_rad > 0 ? left : right);
  }
  return static_cast<double>(std::min(left, right)) <= kMaxBack * static_cast<double>(left + right);
}

/// Why points in the order of time are no line where no field says which beam each is of; empty where they
/// are.
template <typename Points>
std::string no_line(const Points& points) {
  constexpr double kMaxApart_rad = 3 * std::numbers::pi / 180;
  constexpr double kOneBeam_rad = 0.1 * kRadPerDeg;  // further returns of it come at its time
  std::size_t apart = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const bool at_once = points[i].time == points[i - 1].time;
    const double max_rad = at_once ? kOneBeam_rad : kMaxApart_rad;
    if (angle_between_rad(points[i - 1].p_m, points[i].p_m) > max_rad) ++apart;
  }
  if (4 * apart < points.size()) return "";
  return "its points have no field for the beam (ring, line or channel), and consecutive points are far "
         "apart";
}

}  // namespace

bool CloudReader::read_points(const CloudMessage& cloud) {
  const CloudField* const xyz[] = {field_of(cloud, {"x"}), field_of(cloud, {"y"}), field_of(cloud, {"z"})};
  const CloudField* const time = field_of(cloud, {"t", "time", "timestamp", "offset_time"});
  const CloudField* const ring = field_of(cloud, {"ring", "line", "channel"});
  const CloudField* const intensity = field_of(cloud, {"intensity", "reflectivity"});
  if (xyz[0] == nullptr || xyz[1] == nullptr || xyz[2] == nullptr)
    return problem_ = "its points have no x, y, z", false;
  if (time == nullptr)
    return problem_ = "its points have no times (a field t, time, timestamp or offset_time)", false;
  const CloudField* tag = ring != nullptr && ring->name == "line" ? field_of(cloud, {"tag"}) : nullptr;
  if (tag != nullptr && !tag->whole_number()) tag = nullptr;
  has_ring_ = ring != nullptr;
  has_intensity_ = intensity != nullptr;
  points_.clear();
  for (std::size_t i = 0; i < cloud.points(); ++i) {
    Point point;
    for (int k = 0; k < 3; ++k) point.p_m[k] = static_cast<float>(cloud.value(i, *xyz[k]));
    point.time = cloud.value(i, *time);
    if (!point.p_m.allFinite() || point.p_m.isZero() || !std::isfinite(point.time)) continue;
    if (tag != nullptr && tagged_as_noise(cloud.value(i, *tag))) continue;
    if (ring != nullptr) {
      const double number = cloud.value(i, *ring);
      if (!(number >= 0 && number < kMaxRings)) continue;
      point.ring = static_cast<std::uint32_t>(number);
    }
    if (intensity != nullptr) point.intensity = static_cast<float>(cloud.value(i, *intensity));
    points_.push_back(point);
  }
  std::ranges::stable_sort(points_, {}, [](const Point& p) { return std::pair(p.ring, p.time); });
  return points_.empty() || unit_s_ > 0 || choose_unit(time->whole_number(), cloud.time_unit_s);
}

/// False where the points have one time all together. `known_s`: the unit where the format says it, else 0.
bool CloudReader::choose_unit(bool whole_numbers, double known_s) {
  const auto [first, last] = std::ranges::minmax(points_, {}, &Point::time);
  if (!(last.time > first.time)) return problem_ = "its points all have the same time", false;
  if (known_s > 0) return unit_s_ = known_s, true;
  const double since_1970 = std::abs(first.time), span = last.time - first.time;
  absolute_ = since_1970 > 1e8 && since_1970 > 10 * span;
  if (absolute_ && !(whole_numbers && since_1970 < 1e17)) {
    unit_s_ = since_1970 > 1e17 ? 1e-9 : since_1970 > 1e14 ? 1e-6 : since_1970 > 1e11 ? 1e-3 : 1.0;
    return true;
  }
  absolute_ = absolute_ && since_1970 > 1e17;
  if (whole_numbers)
    unit_s_ = span > 5e5 ? 1e-9 : 1e-6;
  else
    unit_s_ = span > 5e6 ? 1e-9 : span > 5e3 ? 1e-6 : span > 5 ? 1e-3 : 1.0;
  return true;
}

/// The beams of a turn that were fired before the first one with a range.
std::size_t CloudReader::beams_before(double azimuth_rad, double step_rad) {
  constexpr double kMargin_rad = 0.1;  // turns are cut a packet early or late
  constexpr double kTurn = 2 * std::numbers::pi;
  if (std::abs(step_rad) < 1e-5) return 0;
  if (!cut_rad_) cut_rad_ = first_azimuth_rad_ - std::copysign(kMargin_rad, step_rad);
  const double since_cut_rad = step_rad > 0 ? azimuth_rad - *cut_rad_ : *cut_rad_ - azimuth_rad;
  const double turned_rad = std::fmod(since_cut_rad + 2 * kTurn, kTurn);
  return static_cast<std::size_t>(std::min(turned_rad / std::abs(step_rad), double{kMaxBeams_a_line} / 2));
}

/// The points of one line, ascending in time. `origin`: the time of the stamp, as points' times are recorded.
void CloudReader::add_line(std::span<const Point> points, const RawScan& common, double origin, bool ringed,
                           RawLaser& laser) {
  double step = median_step(points), last_time = points.empty() ? 0 : points.front().time;
  if (points.size() < 3 || !(step > 0)) return;
  const double max_steps = std::min(double{kMaxBeams_a_line}, static_cast<double>(kSparsest * points.size()));
  RawScan line = common;
  line.first_range = laser.ranges_m.size();
  std::vector<Eigen::Vector3f> directions;
  std::vector<float> ranges_m, intensities;
  std::vector<std::uint32_t> beams;
  // Counted from point to point: the median step is rounded, and over a turn that adds up.
  double place = 0, before_time = points.front().time;
  for (const Point& point : points) {
    const double steps = std::round((point.time - before_time) / step);
    if (!beams.empty() && steps < 1) continue;  // a second return
    place += steps;
    before_time = point.time;
    if (place >= max_steps) break;
    const auto beam = static_cast<std::uint32_t>(place);
    last_time = point.time;
    ranges_m.resize(beam, std::nanf(""));
    intensities.resize(beam, 0);
    directions.resize(beam, Eigen::Vector3f::Zero());
    const float range_m = point.p_m.norm();
    ranges_m.push_back(range_m);
    intensities.push_back(point.intensity);
    directions.push_back(point.p_m / range_m);
    beams.push_back(beam);
  }
  if (beams.size() < 3) return;
  step = (last_time - points.front().time) / beams.back();
  const double angle_step = ringed ? azimuth_step_rad(directions, beams) : path_step_rad(directions, beams);
  const double azimuth_rad = std::atan2(directions.front().y(), directions.front().x());
  const std::size_t missing = ringed ? beams_before(azimuth_rad, angle_step) : 0;
  ranges_m.insert(ranges_m.begin(), missing, std::nanf(""));
  intensities.insert(intensities.begin(), missing, 0);
  directions.insert(directions.begin(), missing, Eigen::Vector3f::Zero());
  const auto before = static_cast<double>(missing);
  line.beams = static_cast<std::uint32_t>(ranges_m.size());
  line.ring = static_cast<std::uint16_t>(points.front().ring);
  line.time_increment_s = static_cast<float>(step * unit_s_);
  line.first_beam_after_stamp_s = (points.front().time - origin - before * step) * unit_s_;
  line.angle_min_rad = ringed ? static_cast<float>(azimuth_rad - before * angle_step) : 0;
  line.angle_increment_rad = static_cast<float>(angle_step);
  line.angle_max_rad = last_beam_angle_rad(line);
  laser.ranges_m.insert(laser.ranges_m.end(), ranges_m.begin(), ranges_m.end());
  laser.directions.insert(laser.directions.end(), directions.begin(), directions.end());
  if (laser.has_intensities)
    laser.intensities.insert(laser.intensities.end(), intensities.begin(), intensities.end());
  laser.scans.push_back(line);
}

/// A slice is taken for a ring of its own: the same slice of the next cloud lies where it did, or anywhere.
void CloudReader::number_slices(double first_time) {
  constexpr std::uint32_t kMaxSlices_a_ring = 64;  // rings are counted in 16 bits
  const double slice = kSlice_s / unit_s_;
  const std::uint32_t max_slices = has_ring_ ? kMaxSlices_a_ring : kMaxRings;
  for (Point& point : points_) {
    const double number = std::min(std::floor((point.time - first_time) / slice), double(max_slices - 1));
    point.ring = (has_ring_ ? point.ring * max_slices : 0) + static_cast<std::uint32_t>(number);
  }
}

bool CloudReader::counts_since_1970(const CloudMessage& cloud) {
  CloudReader reader;
  return cloud.has_time_base || (reader.read_points(cloud) && reader.absolute_);
}

bool CloudReader::add(const std::optional<CloudMessage>& cloud, std::int64_t receive_ns, RawLaser& laser) {
  problem_.clear();
  if (!cloud) return problem_ = "it is malformed", false;
  if (!read_points(*cloud)) return false;
  if (points_.empty()) return true;
  if (!has_ring_) problem_ = no_line(points_);
  if (!problem_.empty()) return false;
  if (!goes_round_) goes_round_ = has_ring_ && go_round(points_);
  if (laser.scans.empty()) laser.frame = cloud->frame;
  laser.has_intensities = laser.has_intensities && has_intensity_;
  if (!laser.has_intensities) std::vector<float>().swap(laser.intensities);
  const auto [first, last] = std::ranges::minmax(points_, {}, &Point::time);
  RawScan common;
  common.stamps = {cloud->header_ns, receive_ns};
  double origin = 0;
  if (absolute_) {
    // Such a time is the stamp itself: the header's may be any of the cloud's, or a publisher's.
    origin = first.time;
    common.stamps.header_ns = static_cast<std::int64_t>(std::llround(first.time * (unit_s_ * 1e9)));
  }
  common.cloud_end_after_stamp_s = (last.time - origin) * unit_s_;
  first_azimuth_rad_ = double{std::atan2(first.p_m.y(), first.p_m.x())};
  if (!*goes_round_) number_slices(first.time);
  for (auto begin = points_.begin(); begin != points_.end();) {
    const auto end =
        std::find_if(begin, points_.end(), [&](const Point& p) { return p.ring != begin->ring; });
    add_line({begin, end}, common, origin, *goes_round_, laser);
    begin = end;
  }
  return true;
}

}  // namespace sweepscope
