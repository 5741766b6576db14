#include "core/loam/relocalisation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/loam/least_squares.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;

constexpr double kCell_m = 0.3;      // of the search; a registration from there finds what lies within two
constexpr double kWalk_mps = 1.5;    // how fast a person walks
constexpr double kMaxWay_m = 8;      // farther away the rig mostly sees what it has not seen before
constexpr double kMaxClimb_m = 0.6;  // crouching, and a step or two
constexpr double kView_m = 12;     // points farther from the rig are not searched with: turns move them most
constexpr int kTurns = 36;         // by 10 deg
constexpr double kTilt_rad = 0.2;  // to either side; the registration finds half of it
constexpr std::size_t kPoints = 150;    // that a place is judged by
constexpr std::size_t kLikely = 16;     // places that are registered beside where the rig was
constexpr std::size_t kMatched = 1200;  // features of a registration
// On the walks of tests/benchmark/gaps the right place has 0.57 or more, wrong
// ones have up to 0.5, as all have on a bare floor.
constexpr double kMinMatchedPart = 0.5, kMaxRivalPart = 0.8;

// Which cells about a place hold a point of the map. Walls count more than floors, which a rig is above
// anywhere.
class Occupancy {
 public:
  Occupancy(std::span<const Eigen::Vector3f> points_m, const Vector3d& middle_m, const Vector3d& half_m)
      : low_m_(middle_m - half_m) {
    for (int i = 0; i < 3; ++i) size_[i] = int(std::ceil(2 * half_m[i] / kCell_m));
    weights_.resize(std::size_t(size_[0]) * std::size_t(size_[1]) * std::size_t(size_[2]));
    for (const Eigen::Vector3f& p_m : points_m)
      if (const auto cell = cell_of(p_m.cast<double>())) weights_[*cell] = kFloor;
    for (std::size_t i = 1; i + 1 < weights_.size(); ++i)
      if (weights_[i] != 0 && weights_[i - 1] != 0 && weights_[i + 1] != 0) weights_[i] = kWall;
  }
  /// 0 where the cell is empty.
  int weight(const Vector3d& p_m) const {
    const auto cell = cell_of(p_m);
    return cell ? weights_[*cell] : 0;
  }

 private:
  static constexpr char kFloor = 1, kWall = 4;

  std::optional<std::size_t> cell_of(const Vector3d& p_m) const {
    std::size_t cell = 0;
    for (int i = 0; i < 3; ++i) {
      const double place = (p_m[i] - low_m_[i]) / kCell_m;
      if (!(place >= 0 && place < size_[i])) return std::nullopt;
      cell = cell * std::size_t(size_[i]) + std::size_t(place);
    }
    return cell;
  }

  Vector3d low_m_;
  std::array<int, 3> size_{};
  std::vector<char> weights_;  // cells above each other are neighbours
};

struct Place {
  Pose pose;
  int filled = 0;
};

bool apart(const Pose& a, const Pose& b, double way_m, double turn_rad) {
  return (a.translation_m - b.translation_m).norm() > way_m ||
         turn_between(a.rotation, b.rotation).norm() > turn_rad;
}

// How the rig may have turned since: about the vertical by any angle, and tilted a little.
std::vector<Eigen::Quaterniond> turned(const Eigen::Quaterniond& last) {
  std::vector<Eigen::Quaterniond> rotations;
  for (const auto& [roll, pitch] : {std::pair{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}})
    for (int k = 0; k < kTurns; ++k)
      rotations.push_back(rotation_from_vector({0, 0, 2 * std::numbers::pi * k / kTurns}) *
                          rotation_from_vector(kTilt_rad * Vector3d(roll, pitch, 0)) * last);
  return rotations;
}

// The best place of one rotation in every cell of the ways that the rig may have gone.
std::vector<Place> places_of(const Eigen::Quaterniond& rotation, std::span<const Vector3d> points_m,
                             const Vector3d& from_m, double way_m, const Occupancy& map) {
  std::vector<Vector3d> turned_m;
  for (const Vector3d& p_m : points_m) turned_m.push_back(from_m + rotation * p_m);
  const auto steps = int(way_m / kCell_m), climbs = int(kMaxClimb_m / kCell_m);
  std::vector<Place> places;
  for (int x = -steps; x <= steps; ++x)
    for (int y = -steps; y <= steps; ++y)
      for (int z = -climbs; z <= climbs; ++z) {
        if (x * x + y * y > steps * steps) continue;
        const Vector3d shift_m = kCell_m * Vector3d(x, y, z);
        int filled = 0;
        for (const Vector3d& p_m : turned_m) filled += map.weight(p_m + shift_m);
        places.push_back({{rotation, from_m + shift_m}, filled});
      }
  // One rotation has few places worth a registration.
  constexpr std::size_t kKept = 4;
  const auto kept = places.begin() + std::ptrdiff_t(std::min(kKept, places.size()));
  std::ranges::partial_sort(places, kept, std::greater(), &Place::filled);
  places.erase(kept, places.end());
  return places;
}

// Of sharp points on planes, a few of all sweeps, in the frame of the base as the stretch begins.
std::vector<Vector3d> sample(const Stretch& stretch) {
  std::vector<Vector3d> points_m;
  const Pose base_from_stretch = stretch.poses.front().begin().inverse();
  for (std::size_t k = 0; k < stretch.sweeps.size(); ++k) {
    const SweepMotion motion = stretch.poses[k].motion();
    for (const PlacedFeature& feature : stretch.sweeps[k].planes)
      if (feature.sharp && feature.range_m < kView_m)
        points_m.push_back(base_from_stretch * motion(feature.p_in_base_m, feature.u));
  }
  const std::size_t stride = std::max<std::size_t>(1, points_m.size() / kPoints);
  std::vector<Vector3d> chosen_m;
  for (std::size_t i = 0; i < points_m.size(); i += stride) chosen_m.push_back(points_m[i]);
  return chosen_m;
}

}  // namespace

void Relocaliser::insert(const PlacedSweep& sweep, const SweepPose& pose) {
  maps_.insert(sweep, pose);
  const SweepMotion motion = pose.motion();
  for (const PlacedFeature& feature : sweep.planes)
    points_m_.push_back(motion(feature.p_in_base_m, feature.u).cast<float>());
}

std::vector<Pose> Relocaliser::likely_poses(std::span<const Vector3d> points_m, const Pose& last,
                                            double gap_s) const {
  const double way_m = std::min(kMaxWay_m, 2 * kCell_m + kWalk_mps * gap_s);
  const Vector3d reach_m(way_m + kView_m, way_m + kView_m, kMaxClimb_m + kView_m);
  const Occupancy map(points_m_, last.translation_m, reach_m);
  const std::vector<Eigen::Quaterniond> rotations = turned(last.rotation);
  std::vector<std::vector<Place>> found(rotations.size());
  for_each_index(rotations.size(), [&](std::size_t i) {
    found[i] = places_of(rotations[i], points_m, last.translation_m, way_m, map);
  });
  std::vector<Place> places;
  for (const std::vector<Place>& of_rotation : found)
    places.insert(places.end(), of_rotation.begin(), of_rotation.end());
  std::ranges::stable_sort(places, std::greater(), &Place::filled);
  std::vector<Pose> likely;  // first where the rig was, turned
  for (int k = 0; k < kTurns; ++k) likely.push_back({rotations[std::size_t(k)], last.translation_m});
  for (const Place& place : places) {
    if (likely.size() == kTurns + kLikely) break;
    const bool is_new = std::ranges::all_of(
        likely, [&](const Pose& other) { return apart(place.pose, other, 2 * kCell_m, kTilt_rad); });
    if (is_new) likely.push_back(place.pose);
  }
  return likely;
}

namespace {

// Every few of the sharp features.
void thin(PlacedSweep& sweep, std::size_t stride) {
  std::size_t i = 0;
  for (std::vector<PlacedFeature>* features : {&sweep.edges, &sweep.planes})
    for (PlacedFeature& feature : *features)
      if (feature.sharp) feature.sharp = i++ % stride == 0;
}

std::size_t sharp_features(const std::vector<PlacedSweep>& sweeps) {
  std::size_t sum = 0;
  for (const PlacedSweep& sweep : sweeps)
    for (const std::vector<PlacedFeature>* features : {&sweep.edges, &sweep.planes})
      sum += std::size_t(std::ranges::count_if(*features, &PlacedFeature::sharp));
  return sum;
}

}  // namespace

// A rigid registration of the stretch with the map, with a loss that narrows.
Relocaliser::Found Relocaliser::refined(const Stretch& stretch, Pose map_from_stretch) const {
  Found found{map_from_stretch};
  const int iterations = 3 * options_.max_iterations;
  for (int i = 0; i <= iterations; ++i) {
    const bool wide = 2 * i < iterations;
    const double width_m = (wide ? 4 : 1) * options_.loss_width_m;
    PatchSearch search{maps_.edges, maps_.planes, search_rule(options_, !wide, SweepFilter::kAny)};
    RigidEquations equations;
    MatchCount count;
    for (std::size_t k = 0; k < stretch.sweeps.size(); ++k) {
      const SweepMotion motion = stretch.poses[k].motion();
      match_features(
          stretch.sweeps[k],
          [&](const PlacedFeature& feature) {
            return found.map_from_stretch * motion(feature.p_in_base_m, feature.u);
          },
          search,
          [&](MatchedKind kind, const PlacedFeature&, const Vector3d& p_m,
              const std::optional<MatchResidual>& residual) {
            const double distance_m = residual ? residual->distance_m : 0.0;
            count.add(residual.has_value(), std::abs(distance_m),
                      kind == MatchedKind::kPlane ? options_.plane_gate_m : options_.edge_gate_m,
                      options_.cost_cap_m);
            if (residual && residual->has_normal)
              equations.add(p_m, residual->normal, distance_m, cauchy_weight(distance_m, width_m));
          });
    }
    found.matched_part = count.matched_part();
    int free_directions = 0;
    const Vector6d step = solve_determined(equations.matrix, equations.gradient, 1, free_directions);
    const bool settled = !wide && step.cwiseAbs().maxCoeff() < options_.step_tolerance;
    if (settled || i == iterations) break;
    found.map_from_stretch = stepped(found.map_from_stretch, step, Vector3d::Zero());
  }
  return found;
}

std::optional<Pose> Relocaliser::find(Stretch stretch, const Pose& last, double gap_s) const {
  const std::vector<Pose> likely = likely_poses(sample(stretch), last, gap_s);
  const std::size_t stride = std::max<std::size_t>(1, sharp_features(stretch.sweeps) / kMatched);
  for (PlacedSweep& sweep : stretch.sweeps) thin(sweep, stride);
  std::vector<Found> found(likely.size());
  const Pose base_from_stretch = stretch.poses.front().begin().inverse();
  for_each_index(likely.size(),
                 [&](std::size_t i) { found[i] = refined(stretch, likely[i] * base_from_stretch); });
  const auto best = std::ranges::max_element(found, {}, &Found::matched_part);
  if (best == found.end() || best->matched_part < kMinMatchedPart) return std::nullopt;
  const Pose& pose = best->map_from_stretch;
  const bool has_rival = std::ranges::any_of(found, [&](const Found& other) {
    return apart(other.map_from_stretch, pose, kCell_m, kTilt_rad / 2) &&
           other.matched_part > kMaxRivalPart * best->matched_part;
  });
  return has_rival ? std::nullopt : std::optional(pose);
}

}  // namespace sweepscope
