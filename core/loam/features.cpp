#include "core/loam/features.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <span>

#include "core/numbers.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

struct ScanFeatures {
  std::vector<Feature> edges, planes;
};

// What is known of every beam of one scan line before features are picked.
struct Line {
  std::vector<char> measured;   // the beam returned something
  std::vector<float> range_m;   // also of beams lost between others on one surface; NaN where there is none
  std::vector<float> x_m, y_m;  // in the scanner's plane
  std::vector<float>
      curvature_m;             // distance from the neighbours' mean, along the beam; NaN where there is none
  std::vector<char> occluded;  // beside a nearer surface: the edge is the nearer surface's, not its own
  std::vector<char> silhouette;  // the last point of a surface before something far behind it, or nothing
};

template <typename Visit>
void for_some_scans(const Recording& recording, const Visit& visit) {
  constexpr std::size_t kScans = 200;  // over 100,000 beams: noise and losses are known to 1 %
  const std::size_t stride = std::max<std::size_t>(1, recording.scans.size() / kScans);
  for (std::size_t s = 0; s < recording.scans.size(); s += stride)
    visit(recording.ranges(recording.scans[s]));
}

// Of the beams beside one that returned something, the part that did not: lost by chance, to a dark or wet
// surface. Where there is nothing to see many beams in a row return nothing, and few of them are counted.
double lost_part(const Recording& recording) {
  std::size_t measured = 0, lost = 0;
  for_some_scans(recording, [&](std::span<const float> ranges) {
    for (std::size_t i = 1; i < ranges.size(); ++i) {
      if (!std::isfinite(ranges[i - 1])) continue;
      ++measured;
      if (!std::isfinite(ranges[i])) ++lost;
    }
  });
  return measured == 0 ? 0 : static_cast<double>(lost) / static_cast<double>(measured);
}

// How far the scanner sees: of all ranges only one in a thousand is longer.
double reach_m(const Recording& recording) {
  std::vector<float> ranges_m;
  for_some_scans(recording, [&](std::span<const float> ranges) {
    std::ranges::copy_if(ranges, std::back_inserter(ranges_m),
                         [](float range_m) { return std::isfinite(range_m); });
  });
  return ranges_m.empty() ? 0 : quantile(ranges_m, 0.999);
}

// So many beams in a row are lost by chance with this probability, where one is with `lost`.
double lost_in_a_row(double lost, double probability) {
  constexpr double kMax = 0.9;  // the logarithm of 1 is 0
  return std::log(probability) / std::log(std::min(lost, kMax));
}

class LineFeatures {
 public:
  LineFeatures(const Recording& recording, const Kinematics& kinematics, const FeatureOptions& options,
               double noise_m, double lost, double reach_m)
      : recording_(recording),
        kinematics_(kinematics),
        options_(options),
        noise_m_(noise_m),
        surely_ends_within_m_(kSureOfReach * reach_m),
        longest_bridge_(std::min(options.half_window, static_cast<int>(lost_in_a_row(lost, kWindowsLost)))),
        behind_(std::max(kBehind, static_cast<int>(std::ceil(lost_in_a_row(lost, kFalseEnds))))) {}

  ScanFeatures extract(std::uint32_t scan_index) {
    const LaserScan& scan = recording_.scans[scan_index];
    measure(scan);
    ScanFeatures found;
    pick_edges(scan, scan_index, found.edges);
    pick_planes(scan, scan_index, found.planes);
    return found;
  }

  const std::vector<float>& curvatures_m(std::size_t scan_index) {
    const LaserScan& scan = recording_.scans[scan_index];
    measure(scan);
    return line_.curvature_m;
  }

 private:
  void measure(const LaserScan& scan) {
    const int beams = static_cast<int>(scan.beams), half = options_.half_window;
    line_.curvature_m.assign(beams, std::nanf(""));
    line_.occluded.assign(beams, 0);
    line_.silhouette.assign(beams, 0);
    place(scan);
    mark_occlusions();
    for (int i = half; i + half < beams; ++i) line_.curvature_m[i] = curvature(i);
    for (int i = half; i + half < beams; ++i) line_.silhouette[i] = ends_surface(i, 1) || ends_surface(i, -1);
  }

  void place(const LaserScan& scan) {
    const int beams = static_cast<int>(scan.beams);
    const auto ranges = recording_.ranges(scan);
    line_.range_m.assign(ranges.begin(), ranges.end());
    line_.measured.resize(beams);
    line_.x_m.resize(beams);
    line_.y_m.resize(beams);
    int before = -1;  // the last beam that returned something
    for (int i = 0; i < beams; ++i) {
      const double angle_rad = scan.beam_angle_rad(i);
      line_.measured[i] = std::isfinite(ranges[i]);
      line_.x_m[i] = static_cast<float>(ranges[i] * std::cos(angle_rad));
      line_.y_m[i] = static_cast<float>(ranges[i] * std::sin(angle_rad));
      if (!line_.measured[i]) continue;
      if (before >= 0 && before + 1 < i && i - before - 1 <= longest_bridge_) bridge(before, i);
      before = i;
    }
  }

  // Beams that were lost between two on one surface lie on the straight line between them, so that the
  // windows over them have no holes.
  void bridge(int from, int to) {
    const float near = std::min(line_.range_m[from], line_.range_m[to]);
    if (std::abs(line_.range_m[to] - line_.range_m[from]) > jump_m(near)) return;
    for (int k = from + 1; k < to; ++k) {
      const float part = static_cast<float>(k - from) / static_cast<float>(to - from);
      line_.x_m[k] = std::lerp(line_.x_m[from], line_.x_m[to], part);
      line_.y_m[k] = std::lerp(line_.y_m[from], line_.y_m[to], part);
      line_.range_m[k] = std::hypot(line_.x_m[k], line_.y_m[k]);
    }
  }

  // True where beam i and two before it are on one surface, and those after it see nothing or far behind it:
  // as many as chance alone hardly ever loses in a row. Near the end of what the scanner reaches, a floor or
  // a wall ends where it does because the scanner is there: such ends move along with the rig.
  bool ends_surface(int i, int step) const {
    const auto& range_m = line_.range_m;
    if (!line_.measured[i]) return false;
    for (int k = 1; k <= 2; ++k)
      if (!(std::abs(range_m[i - step * k] - range_m[i]) < k * surface_step_m(range_m[i]))) return false;
    const int last = i + step * behind_;
    if (last < 0 || last >= std::ssize(range_m)) return false;
    bool nothing = true;
    for (int k = 1; k <= behind_; ++k) {
      if (range_m[i + step * k] - range_m[i] < jump_m(range_m[i])) return false;
      nothing = nothing && !std::isfinite(range_m[i + step * k]);
    }
    return !nothing || range_m[i] < surely_ends_within_m_;
  }

  double surface_step_m(double range_m) const { return 0.02 * range_m + 4 * noise_m_; }

  // On a jump between neighbours the farther side's last points are cut by the nearer surface's shadow.
  void mark_occlusions() {
    const auto& ranges = line_.range_m;
    const int beams = static_cast<int>(ranges.size()), half = options_.half_window;
    for (int i = 0; i + 1 < beams; ++i) {
      const float near = std::min(ranges[i], ranges[i + 1]), far = std::max(ranges[i], ranges[i + 1]);
      if (!(far - near > jump_m(near))) continue;
      const bool right_is_far = ranges[i + 1] > ranges[i];
      const int from = right_is_far ? i + 1 : i - half, to = right_is_far ? i + 1 + half : i;
      for (int k = std::max(from, 0); k <= std::min(to, beams - 1); ++k) line_.occluded[k] = 1;
    }
  }

  double jump_m(double range_m) const { return std::max(0.1 * range_m, 8 * noise_m_); }

  float curvature(int i) const {
    const int half = options_.half_window;
    float x = 0, y = 0;
    for (int k = i - half; k <= i + half; ++k) {
      x += line_.x_m[k];
      y += line_.y_m[k];
    }
    const auto count = static_cast<float>(2 * half + 1);
    const float dx = x / count - line_.x_m[i], dy = y / count - line_.y_m[i];
    // Along the beam and across: along a wall the beams' uneven spacing moves the mean as well, so take the
    // part that is normal to the chord between the ends.
    const float cx = line_.x_m[i + half] - line_.x_m[i - half],
                cy = line_.y_m[i + half] - line_.y_m[i - half];
    const float chord = std::hypot(cx, cy);
    if (!(chord > 1e-6f)) return std::nanf("");
    const float value = std::abs(dx * cy - dy * cx) / chord;
    return line_.measured[i] ? value : std::nanf("");
  }

  void pick_edges(const LaserScan& scan, std::uint32_t scan_index, std::vector<Feature>& edges) {
    const int beams = static_cast<int>(scan.beams);
    for (int region = 0; region < options_.regions; ++region) {
      order_.clear();
      const int from = beams * region / options_.regions, to = beams * (region + 1) / options_.regions;
      for (int i = from; i < to; ++i)
        if (is_edge(i)) order_.push_back(i);
      std::sort(order_.begin(), order_.end(), [&](int a, int b) {
        return sharpness_m(a) != sharpness_m(b) ? sharpness_m(a) > sharpness_m(b) : a < b;
      });
      taken_.assign(beams, 0);
      int count = 0;
      for (const int i : order_) {
        if (count >= options_.map_edges_per_region) break;
        if (taken_[i]) continue;
        if (push(scan, scan_index, i, line_.range_m[i], count < options_.edges_per_region, edges)) ++count;
        for (int k = std::max(0, i - options_.half_window);
             k <= std::min(beams - 1, i + options_.half_window); ++k)
          taken_[k] = 1;
      }
    }
    std::sort(edges.begin(), edges.end(), [](const Feature& a, const Feature& b) { return a.beam < b.beam; });
  }

  // A silhouette has no curvature of its own: it ranks behind sharp corners and before blunt ones.
  float sharpness_m(int i) const {
    const float curvature_m = std::isfinite(line_.curvature_m[i]) ? line_.curvature_m[i] : 0.0f;
    return line_.silhouette[i] ? std::max(curvature_m, 0.1f) : curvature_m;
  }

  bool is_edge(int i) const {
    if (line_.silhouette[i]) return true;
    const double threshold_m =
        std::max(options_.edge_curvature * noise_m_, options_.edge_curvature_slope * line_.range_m[i]);
    if (!(line_.curvature_m[i] > threshold_m) || line_.occluded[i]) return false;
    for (int k = i - 1; k <= i + 1; ++k)
      if (!std::isfinite(line_.range_m[k])) return false;
    return true;
  }

  void pick_planes(const LaserScan& scan, std::uint32_t scan_index, std::vector<Feature>& planes) {
    const int beams = static_cast<int>(scan.beams), half = options_.half_window;
    const int per_match = std::max(1, options_.plane_spacing / options_.map_spacing);
    int bin = 0;
    for (int from = half; from + half < beams; from += options_.map_spacing, ++bin) {
      int best = -1;
      for (int i = from; i < std::min(from + options_.map_spacing, beams - half); ++i)
        if (is_plane(i) && (best < 0 || line_.curvature_m[i] < line_.curvature_m[best])) best = i;
      if (best < 0) continue;
      const double range_m = smoothed_range_m(scan, best);
      if (range_m > 0) push(scan, scan_index, best, range_m, bin % per_match == 0, planes);
    }
  }

  bool is_plane(int i) const {
    const auto& ranges = line_.range_m;
    const int half = options_.half_window;
    if (!(line_.curvature_m[i] < options_.plane_curvature * noise_m_)) return false;
    // Nearly parallel to the beam: the range changes from beam to beam by more than the beams' spacing
    // times 5.
    const double rise_m = std::abs(ranges[i + half] - ranges[i - half]);
    const double width_m =
        std::hypot(line_.x_m[i + half] - line_.x_m[i - half], line_.y_m[i + half] - line_.y_m[i - half]);
    return std::isfinite(rise_m) && rise_m < 0.97 * width_m + 4 * noise_m_ &&
           width_m < 0.25 * ranges[i] + 0.3;
  }

  // The range at beam i of the line fitted to its neighbours: less noise, and no offset in it, since the
  // neighbours are within a degree of motor angle. Negative where the neighbours are not on a line.
  double smoothed_range_m(const LaserScan& scan, int i) const {
    const int half = options_.half_window;
    double sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
    const double n = 2 * half + 1;
    for (int k = i - half; k <= i + half; ++k) {
      const double x = line_.x_m[k], y = line_.y_m[k];
      sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
    }
    const double mx = sx / n, my = sy / n;
    const double cxx = sxx / n - mx * mx, cxy = sxy / n - mx * my, cyy = syy / n - my * my;
    // Total least squares: the direction of greatest spread.
    const double theta = 0.5 * std::atan2(2 * cxy, cxx - cyy);
    const double nx = -std::sin(theta), ny = std::cos(theta);
    const double spread = nx * nx * cxx + 2 * nx * ny * cxy + ny * ny * cyy;
    const double limit_m = 1.8 * noise_m_;
    if (!(spread < limit_m * limit_m)) return -1;
    const double angle_rad = scan.beam_angle_rad(i);
    const double across = nx * std::cos(angle_rad) + ny * std::sin(angle_rad);
    if (std::abs(across) < 0.1) return -1;
    const double range_m = (nx * mx + ny * my) / across;
    return std::abs(range_m - line_.range_m[i]) < 4 * noise_m_ ? range_m : -1;
  }

  bool push(const LaserScan& scan, std::uint32_t scan_index, int beam, double range_m, bool sharp,
            std::vector<Feature>& features) const {
    const Eigen::Vector3d p_in_motor_m =
        kinematics_.point_in_motor(range_m, recording_.direction(scan, static_cast<std::uint32_t>(beam)));
    if (kinematics_.distance_to_axis_m(p_in_motor_m) < options_.axis_sine * range_m) return false;
    features.push_back({p_in_motor_m.cast<float>(), static_cast<float>(range_m), scan.beam_s(beam),
                        scan_index, static_cast<std::uint16_t>(beam), sharp});
    return true;
  }

  const Recording& recording_;
  const Kinematics& kinematics_;
  const FeatureOptions& options_;
  static constexpr int kBehind = 3;             // beams, where none is lost
  static constexpr double kFalseEnds = 0.001;   // of all beams, those that seem to end a surface by chance
  static constexpr double kWindowsLost = 0.05;  // of all beams, those beside a hole that is not bridged
  static constexpr double kSureOfReach = 0.8;   // part of the reach: by judgement
  double noise_m_, surely_ends_within_m_;
  int longest_bridge_, behind_;  // beams
  Line line_;
  std::vector<int> order_;
  std::vector<char> taken_;
};

void append(FeatureList& list, const std::vector<Feature>& scan_features) {
  list.scan_begin.push_back(list.features.size());
  list.features.insert(list.features.end(), scan_features.begin(), scan_features.end());
}

// As many as the first scans' number foretells, and a tenth more: a list that grows by doubling is there
// three times meanwhile. Room that is not used takes no memory.
void reserve_for(std::size_t scans, std::size_t first_scans, FeatureSet& set) {
  for (FeatureList* list : {&set.edges, &set.planes}) {
    const double a_scan = double(list->features.size()) / double(first_scans);
    list->features.reserve(std::size_t(1.1 * a_scan * double(scans)));
    list->scan_begin.reserve(scans + 1);
  }
}

}  // namespace

double estimate_range_noise_m(const Recording& recording) {
  std::vector<float> differences;
  for_some_scans(recording, [&](std::span<const float> ranges) {
    for (std::size_t i = 1; i + 1 < ranges.size(); ++i) {
      const float difference = std::abs(ranges[i - 1] - 2 * ranges[i] + ranges[i + 1]);
      if (std::isfinite(difference)) differences.push_back(difference);
    }
  });
  if (differences.empty()) return 0.002;
  return std::max(0.002, median(std::move(differences)) / (0.6745 * std::sqrt(6.0)));
}

Result<FeatureSet> extract_features(const Recording& recording, const FeatureOptions& options,
                                    const Job& job) {
  FeatureSet set;
  set.range_noise_m = estimate_range_noise_m(recording);
  const Kinematics kinematics(recording.rig.mount);
  const double lost = lost_part(recording), reach = reach_m(recording);
  const std::size_t scans = recording.scans.size();
  // A part of the scans at a time: all features twice would be more than the ranges themselves.
  constexpr std::size_t kScansAtOnce = 4096;  // bounds the memory for what is not yet put in order
  std::vector<ScanFeatures> per_scan;
  std::atomic<std::size_t> done{0};
  for (std::size_t first = 0; first < scans; first += kScansAtOnce) {
    const std::size_t count = std::min(kScansAtOnce, scans - first);
    per_scan.assign(count, {});
    for_each_block(count, 64, [&](const auto& block) {
      LineFeatures line(recording, kinematics, options, set.range_noise_m, lost, reach);
      if (job.cancelled()) return;
      for (std::size_t i = block.begin(); i < block.end(); ++i)
        per_scan[i] = line.extract(static_cast<std::uint32_t>(first + i));
      done += block.size();
      job.report("features", double(done) / double(scans));
    });
    if (job.cancelled()) return failure(ExitCode::kInterrupted, "interrupted while extracting features");
    for (const ScanFeatures& scan : per_scan) {
      append(set.edges, scan.edges);
      append(set.planes, scan.planes);
    }
    if (first == 0) reserve_for(scans, count, set);
  }
  set.edges.scan_begin.push_back(set.edges.features.size());
  set.planes.scan_begin.push_back(set.planes.features.size());
  return set;
}

std::vector<float> line_curvatures_m(const Recording& recording, std::size_t scan,
                                     const FeatureOptions& options) {
  const Kinematics kinematics(recording.rig.mount);
  return LineFeatures(recording, kinematics, options, 0, lost_part(recording), 0).curvatures_m(scan);
}

}  // namespace sweepscope
