#include "core/loam/relocalisation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "core/loam/path/least_squares.hpp"
#include "core/loam/sweep_matcher.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;

constexpr double kCell_m = 0.3;      // of the search; a registration from there finds what lies within two
constexpr double kWalk_mps = 1.5;    // how fast a person walks
constexpr double kMaxWay_m = 8;      // farther away the rig mostly sees what it has not seen before
constexpr double kMaxClimb_m = 0.6;  // crouching, and a step or two
constexpr double kView_m = 12;      // points farther from the rig are not searched with: turns move them most
constexpr int kTurns = 36;          // by 10 deg
constexpr double kTilt_rad = 0.2;   // to either side; the registration finds half of it
constexpr std::size_t kSweeps = 8;  // that a stretch is found by: cheap enough to try in several places
constexpr std::size_t kPoints = 150;    // that a place is judged by
constexpr std::size_t kLikely = 16;     // places that are registered beside where the rig was
constexpr std::size_t kMatched = 1200;  // features of a registration
// Where it was looked at closely (gaps of tests/benchmark/gaps, and the hall of the tests), the right place
// had 0.57 to 0.89 of the matches and a wrong one 0.49. On a bare floor, or where the sweeps after the gap
// are bent, others have about as many: of those the nearest to where the rig was is taken.
constexpr double kMinMatchedPart = 0.5, kAsGood = 0.9;

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

double distance_m(const Pose& a, const Pose& b) {
  return (a.translation_m - b.translation_m).norm();
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

// The first sweeps of a stretch, about the base as it begins (base_from_stretch).
struct Glimpse {
  std::vector<PlacedSweep> sweeps;
  std::vector<SweepMotion> motions;

  // Of sharp points on planes, a few of all sweeps.
  std::vector<Vector3d> sample() const {
    std::vector<Vector3d> points_m, chosen_m;
    for (std::size_t k = 0; k < sweeps.size(); ++k)
      for (const PlacedFeature& feature : sweeps[k].planes)
        if (feature.sharp && feature.range_m < kView_m)
          points_m.push_back(motions[k](feature.p_in_base_m, feature.u));
    const std::size_t stride = std::max<std::size_t>(1, points_m.size() / kPoints);
    for (std::size_t i = 0; i < points_m.size(); i += stride) chosen_m.push_back(points_m[i]);
    return chosen_m;
  }
  // Matches fewer features from now on.
  void thin_out() {
    std::size_t sharp = 0;
    for (const PlacedSweep& sweep : sweeps)
      for (const std::vector<PlacedFeature>* features : {&sweep.edges, &sweep.planes})
        sharp += std::size_t(std::ranges::count_if(*features, &PlacedFeature::sharp));
    for (PlacedSweep& sweep : sweeps) thin(sweep, std::max<std::size_t>(1, sharp / kMatched));
  }
};

// The map of what the rig saw before it was lost.
class OldMap {
 public:
  explicit OldMap(const MappingOptions& options) : options_(options) {}

  bool empty() const { return points_m_.empty(); }
  void insert(const PlacedSweep& sweep, const SweepPose& pose) {
    maps_.insert(sweep, pose);
    const SweepMotion motion = pose.motion();
    for (const PlacedFeature& feature : sweep.planes)
      points_m_.push_back(motion(feature.p_in_base_m, feature.u).cast<float>());
  }
  std::optional<Pose> find(Glimpse glimpse, const Pose& last, double gap_s) const;

 private:
  struct Found {
    Pose pose;  // map_from_base as the stretch begins
    double matched_part = 0;
  };
  std::vector<Pose> likely_poses(std::span<const Vector3d> points_m, const Pose& last, double gap_s) const;
  MatchCount linearise(const Glimpse& glimpse, const Pose& pose, bool wide, RigidEquations& equations) const;
  Found registered(const Glimpse& glimpse, const Pose& pose) const;

  const MappingOptions& options_;
  SweepMaps maps_;
  std::vector<Eigen::Vector3f> points_m_;  // of the planes in the map
};

// The places that the points fill best, behind the last one known, turned to all sides.
std::vector<Pose> OldMap::likely_poses(std::span<const Vector3d> points_m, const Pose& last,
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
  std::vector<Pose> likely;
  for (int k = 0; k < kTurns; ++k) likely.push_back({rotations[std::size_t(k)], last.translation_m});
  for (const Place& place : places) {
    if (likely.size() == kTurns + kLikely) break;
    const bool is_new = std::ranges::all_of(likely, [&](const Pose& other) {
      return distance_m(place.pose, other) > 2 * kCell_m ||
             turn_between(place.pose.rotation, other.rotation).norm() > kTilt_rad;
    });
    if (is_new) likely.push_back(place.pose);
  }
  return likely;
}

MatchCount OldMap::linearise(const Glimpse& glimpse, const Pose& pose, bool wide,
                             RigidEquations& equations) const {
  const double width_m = (wide ? 4 : 1) * options_.loss_width_m;
  PatchSearch search{maps_.edges, maps_.planes, search_rule(options_, !wide, SweepFilter::kAny)};
  MatchCount count;
  const auto use = [&](MatchedKind kind, const PlacedFeature& feature, const Vector3d& p_m,
                       const std::optional<MatchResidual>& residual) {
    count.add(residual, feature.range_m, gate_m(kind, options_), options_.cost_cap_m);
    if (residual && residual->has_normal)
      equations.add(p_m, residual->normal, residual->distance_m,
                    cauchy_weight(residual->distance_m, width_m));
  };
  for (std::size_t k = 0; k < glimpse.sweeps.size(); ++k)
    match_features(
        glimpse.sweeps[k],
        [&](const PlacedFeature& feature) {
          return pose * glimpse.motions[k](feature.p_in_base_m, feature.u);
        },
        search, use);
  return count;
}

// With a loss that narrows.
OldMap::Found OldMap::registered(const Glimpse& glimpse, const Pose& pose) const {
  Found found{pose};
  const int iterations = 3 * options_.max_iterations;
  for (int i = 0; i <= iterations; ++i) {
    const bool wide = 2 * i < iterations;
    RigidEquations equations;
    found.matched_part = linearise(glimpse, found.pose, wide, equations).matched_part();
    int free_directions = 0;
    const Vector6d step = solve_determined(equations.matrix, equations.gradient, 1, free_directions);
    const bool settled = !wide && step.cwiseAbs().maxCoeff() < options_.step_tolerance;
    if (settled || i == iterations) break;
    found.pose = stepped(found.pose, step, Vector3d::Zero());
  }
  return found;
}

// Where the rig is as the stretch begins (map_from_base).
std::optional<Pose> OldMap::find(Glimpse glimpse, const Pose& last, double gap_s) const {
  const std::vector<Pose> likely = likely_poses(glimpse.sample(), last, gap_s);
  glimpse.thin_out();
  std::vector<Found> found(likely.size());
  for_each_index(likely.size(), [&](std::size_t i) { found[i] = registered(glimpse, likely[i]); });
  double best_part = 0;
  for (const Found& one : found) best_part = std::max(best_part, one.matched_part);
  if (best_part < kMinMatchedPart) return std::nullopt;
  std::optional<Pose> nearest;
  for (const Found& one : found) {
    if (one.matched_part < kAsGood * best_part) continue;
    if (!nearest || distance_m(one.pose, last) < distance_m(*nearest, last)) nearest = one.pose;
  }
  return nearest;
}

using Sweeps = std::span<SweepPose>;
using PlaceSweep = std::function<PlacedSweep(std::size_t)>;

// The sweeps from `first` on that are of one stretch, or that were not tracked.
Sweeps run_from(std::size_t first, Sweeps sweeps) {
  sweeps = sweeps.subspan(first);
  const auto other = std::ranges::find_if(
      sweeps, [&](const SweepPose& sweep) { return sweep.stretch != sweeps.front().stretch; });
  return sweeps.first(std::size_t(other - sweeps.begin()));
}

void move(Sweeps sweeps, const Pose& by) {
  for (SweepPose& sweep : sweeps)
    for (Pose& knot : sweep.knots) knot = by * knot;
}

// Evenly from where the rig was to where it is.
void bridge(Sweeps gap, const SweepPose& last, const SweepPose& next) {
  const auto at = [&](double time_s) {
    return interpolate(last.end(), next.begin(), (time_s - last.end_s) / (next.begin_s - last.end_s));
  };
  for (SweepPose& sweep : gap) sweep.knots = {at(sweep.begin_s), at(sweep.end_s)};
}

// What moves a stretch, from `first` on, to where it fits the map.
std::optional<Pose> move_onto(const OldMap& map, std::size_t first, Sweeps stretch, const SweepPose& last,
                              const PlaceSweep& place) {
  const auto begin = std::ranges::find(stretch, false, &SweepPose::lost);
  if (begin == stretch.end()) return std::nullopt;
  const Pose base_from_stretch = begin->begin().inverse();
  Glimpse glimpse;
  for (std::size_t i = 0; i < stretch.size() && glimpse.sweeps.size() < kSweeps; ++i) {
    if (stretch[i].lost) continue;
    SweepPose about_base = stretch[i];
    move({&about_base, 1}, base_from_stretch);
    glimpse.sweeps.push_back(place(first + i));
    glimpse.motions.push_back(about_base.motion());
  }
  const auto found = map.find(std::move(glimpse), last.end(), begin->begin_s - last.end_s);
  return found ? std::optional(*found * base_from_stretch) : std::nullopt;
}

}  // namespace

std::vector<SweepPose> relocalised(std::vector<SweepPose> sweeps, const PlaceSweep& place,
                                   const MappingOptions& options, const Job& job) {
  if (std::ranges::none_of(sweeps, [](const SweepPose& sweep) { return sweep.stretch > 1; })) return sweeps;
  OldMap map(options);
  std::optional<Pose> by;  // what moved the latest stretch: one that is not found stays behind it
  const SweepPose* last = nullptr;
  Sweeps gap, run;
  std::size_t of_map = 0;  // the first stretch
  for (std::size_t first = 0; first < sweeps.size() && !job.cancelled(); first += run.size()) {
    run = run_from(first, sweeps);
    const bool tracked = run.front().stretch > 0;
    const auto found = tracked && last != nullptr ? move_onto(map, first, run, *last, place) : std::nullopt;
    if (found) by = found;
    if (by) move(run, *by);
    if (!tracked) {
      gap = run;
      continue;
    }
    if (found) bridge(gap, *last, run.front());
    gap = {};
    if (map.empty()) of_map = run.front().stretch;
    const bool fits = found || map.empty();
    for (std::size_t i = 0; i < run.size(); ++i) {
      if (fits) run[i].stretch = of_map;
      if (run[i].lost) continue;
      if (fits) map.insert(place(first + i), run[i]);
      last = &run[i];
    }
  }
  return sweeps;
}

}  // namespace sweepscope
