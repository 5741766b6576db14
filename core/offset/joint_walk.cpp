#include "core/offset/joint_walk.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/loam/patch_search.hpp"
#include "core/loam/smooth_path.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// A ring of a 3D scanner takes a whole turn: its points share a motion only over a part of that.
constexpr double kLongestSlice_s = 0.025;

std::uint32_t slices_per_scan(const Recording& recording) {
  if (recording.directions.empty()) return 1;
  double longest_s = 0;
  for (const LaserScan& scan : recording.scans)
    longest_s = std::max(longest_s, scan.last_beam_s() - scan.first_beam_s);
  constexpr double kMost = 64;
  return static_cast<std::uint32_t>(std::clamp(std::ceil(longest_s / kLongestSlice_s), 1.0, kMost));
}

// What the points of a scan, or of a slice of one, share: where the motor's axis was, how fast it turned, and
// between which knots.
struct ScanMotion {
  SmoothPath::Place place;
  Vector3d base_in_map_m, turning_rad_s;
};

// How a distance changes with the steps of the knots that it depends on. Its own point's two, and those of
// the neighbours that its surface was fitted to.
class KnotRow {
 public:
  void clear() { count_ = 0; }

  void add(std::size_t knot, const Vector6d& row) {
    for (std::size_t i = 0; i < count_; ++i) {
      if (knots_[i] != knot) continue;
      rows_[i] += row;
      return;
    }
    knots_[count_] = knot;
    rows_[count_] = row;
    ++count_;
  }
  std::size_t size() const { return count_; }
  std::size_t knot(std::size_t i) const { return knots_[i]; }
  const Vector6d& row(std::size_t i) const { return rows_[i]; }

 private:
  std::size_t count_ = 0;
  std::array<std::size_t, 2 + 2 * Neighbours::kMax> knots_;
  std::array<Vector6d, 2 + 2 * Neighbours::kMax> rows_;
};

// Normal equations of a part: six unknowns for every knot, and the offset last. Only the lower triangle.
class PartEquations {
 public:
  explicit PartEquations(std::size_t knots)
      : matrix_(Eigen::MatrixXd::Zero(Eigen::Index(6 * knots + 1), Eigen::Index(6 * knots + 1))),
        gradient_(Eigen::VectorXd::Zero(matrix_.rows())) {}

  void add(const KnotRow& row, double offset_slope, double residual, double weight) {
    const Eigen::Index last = matrix_.rows() - 1;
    for (std::size_t a = 0; a < row.size(); ++a) {
      const Vector6d weighted = weight * row.row(a);
      const auto ka = Eigen::Index(6 * row.knot(a));
      for (std::size_t b = 0; b < row.size(); ++b)
        if (row.knot(b) <= row.knot(a))
          matrix_.block<6, 6>(ka, Eigen::Index(6 * row.knot(b))).noalias() +=
              weighted * row.row(b).transpose();
      matrix_.block<1, 6>(last, ka) += offset_slope * weighted.transpose();
      gradient_.segment<6>(ka) += residual * weighted;
    }
    matrix_(last, last) += weight * offset_slope * offset_slope;
    gradient_[last] += weight * offset_slope * residual;
  }

  // The walk accelerates little: second differences of the knots are near zero.
  void add_accelerations(const SmoothPath& path, double sigma) {
    const double weight = 1 / (sigma * sigma), stencil[3] = {1, -2, 1};
    for (std::size_t k = 1; k + 1 < path.knots(); ++k) {
      const Vector6d residual = step_between(path, k) - step_between(path, k - 1);
      for (std::size_t a = 0; a < 3; ++a) {
        const auto row = Eigen::Index(6 * (k - 1 + a));
        gradient_.segment<6>(row) += weight * stencil[a] * residual;
        for (std::size_t b = 0; b <= a; ++b)
          for (Eigen::Index i = 0; i < 6; ++i)
            matrix_(row + i, Eigen::Index(6 * (k - 1 + b)) + i) += weight * stencil[a] * stencil[b];
      }
    }
  }

  // A map can be moved as a whole, and a knot that sees little stays where it is.
  void hold(double first_sigma, double knot_sigma, double offset_sigma_s) {
    const Eigen::Index last = matrix_.rows() - 1;
    matrix_.diagonal().head(last).array() += 1 / (knot_sigma * knot_sigma);
    matrix_.diagonal().head<6>().array() += 1 / (first_sigma * first_sigma);
    matrix_(last, last) += 1 / (offset_sigma_s * offset_sigma_s);
  }

  struct Solution {
    std::vector<Vector6d> knot_steps;
    double offset_step_s, offset_sigma_s;
  };
  std::optional<Solution> solve() {
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> cholesky(matrix_);
    if (cholesky.info() != Eigen::Success) return std::nullopt;
    const Eigen::Index last = matrix_.rows() - 1;
    const Eigen::VectorXd x = cholesky.solve(-gradient_);
    Solution solution{{}, x[last], 1 / matrix_(last, last)};  // now the factor's
    for (Eigen::Index k = 0; k < last / 6; ++k) solution.knot_steps.push_back(x.segment<6>(6 * k));
    return solution;
  }

 private:
  static Vector6d step_between(const SmoothPath& path, std::size_t k) {
    const Pose from = path.knot(k), to = path.knot(k + 1);
    Vector6d step;
    step << vector_from_rotation(to.rotation * from.rotation.conjugate()),
        to.translation_m - from.translation_m;
    return step;
  }

  Eigen::MatrixXd matrix_;
  Eigen::VectorXd gradient_;
};

// One part of the walk on its way to its own offset.
class Part {
 public:
  Part(const OffsetProblem& problem, const std::vector<SweepPose>& sweeps, double offset_s,
       const JointWalkOptions& options)
      : problem_(cut(problem, sweeps, offset_s)),
        options_(options),
        slices_(slices_per_scan(*problem.recording)),
        path_(sweeps, options.knot_s) {
    result_.middle_s = (sweeps.front().begin_s + sweeps.back().end_s) / 2;
    result_.offset_s = offset_s;
  }

  void solve(const Job& job) {
    for (int i = 0; i < options_.most_iterations && !result_.converged && !job.cancelled(); ++i) {
      PartEquations equations(path_.knots());
      linearise(equations);
      if (result_.matches < options_.least_matches) return;
      equations.add_accelerations(path_, options_.acceleration_sigma * options_.knot_s * options_.knot_s);
      constexpr double kFirstSigma = 1e-4, kKnotSigma = 0.5;
      equations.hold(kFirstSigma, kKnotSigma, options_.offset_sigma_s);
      const auto solution = equations.solve();
      if (!solution) return;
      path_.move(solution->knot_steps);
      result_.offset_s += solution->offset_step_s;
      result_.step_s = solution->offset_step_s;
      result_.sigma_s = solution->offset_sigma_s;
      result_.converged = std::abs(solution->offset_step_s) < options_.step_tolerance * result_.sigma_s;
    }
  }
  const JointWalkPart& result() const { return result_; }
  const SmoothPath& path() const { return path_; }

 private:
  // The problem with these sweeps alone.
  static OffsetProblem cut(const OffsetProblem& problem, const std::vector<SweepPose>& sweeps,
                           double offset_s) {
    OffsetProblem part = problem;
    const auto sweep_of = assign_sweeps(problem.recording->scans, problem.motor.sweeps, offset_s);
    for (std::size_t i = 0; i < sweep_of.size(); ++i)
      if (sweep_of[i] == kNoSweep || sweep_of[i] < sweeps.front().sweep || sweep_of[i] > sweeps.back().sweep)
        part.scan_used[i] = 0;
    return part;
  }

  static double time_s(const PlacedSweep& sweep, const PlacedFeature& feature) {
    return sweep.begin_s + feature.u * (sweep.end_s - sweep.begin_s);
  }
  Vector3d in_map_m(const PlacedSweep& sweep, const PlacedFeature& feature) const {
    return path_.at(time_s(sweep, feature)) * feature.p_in_base_m;
  }

  void linearise(PartEquations& equations) {
    const std::vector<PlacedSweep> sweeps = place_sweeps(problem_, result_.offset_s);
    FeatureMap edges, planes;
    scans_.resize(problem_.recording->scans.size() * slices_);
    last_line_ = kNoLine;
    for (const PlacedSweep& sweep : sweeps) {
      for (const PlacedFeature& feature : sweep.edges) insert(sweep, feature, edges);
      for (const PlacedFeature& feature : sweep.planes) insert(sweep, feature, planes);
    }
    result_.features = result_.matches = 0;
    result_.lever_m2 = result_.reach_m2 = 0;
    for (const PlacedSweep& sweep : sweeps) {
      const MappingOptions& mapping = options_.mapping;
      const SearchRule rule{mapping.patch, mapping.search_radius_m, mapping.search_radius_slope,
                            sweep.direction > 0 ? SweepFilter::kBackward : SweepFilter::kForward};
      for (const PlacedFeature& feature : sweep.planes) {
        if (!feature.sharp) continue;
        ++result_.features;
        const Vector3d p_m = in_map_m(sweep, feature);
        const auto plane = find_plane(planes, p_m, feature.range_m, rule, near_);
        if (plane)
          add(line_of(sweep, feature), p_m, plane->normal, (p_m - plane->centre_m).dot(plane->normal),
              equations);
      }
      for (const PlacedFeature& feature : sweep.edges) {
        if (!feature.sharp) continue;
        ++result_.features;
        const Vector3d p_m = in_map_m(sweep, feature);
        const auto line = find_line(edges, p_m, feature.range_m, rule, near_);
        const Vector3d away_m = line ? from_line(*line, p_m) : Vector3d::Zero();
        const double distance_m = away_m.norm();
        if (distance_m > 1e-9) add(line_of(sweep, feature), p_m, away_m / distance_m, distance_m, equations);
      }
    }
  }

  void insert(const PlacedSweep& sweep, const PlacedFeature& feature, FeatureMap& map) {
    const std::uint32_t line = line_of(sweep, feature);
    map.insert(in_map_m(sweep, feature).cast<float>(), line, sweep.direction);
    if (line == last_line_) return;
    last_line_ = line;
    const LaserScan& scan = problem_.recording->scans[feature.line];
    const double slice = line % slices_, beams = (scan.beams - 1.0) / slices_;
    const double middle_s = scan.beam_s((slice + 0.5) * beams);
    const Pose pose = path_.at(middle_s);
    scans_[line] = {path_.place(middle_s), pose.translation_m,
                    turning_rad_s(problem_.motor.sweeps[sweep.sweep], middle_s + result_.offset_s) *
                        (pose.rotation * problem_.recording->rig.mount.axis.normalized())};
  }

  // How fast the motor turned: over a tenth of the sweep, so that the encoder's steps count little and what
  // tells a sine from a walk that sways, the speed's change within a sweep, stays.
  double turning_rad_s(const Sweep& sweep, double motor_s) const {
    const double span_s = (sweep.end_s - sweep.begin_s) / 20;
    const double from_s = std::max(motor_s - span_s, sweep.steady_begin_s);
    const double to_s = std::min(motor_s + span_s, sweep.steady_end_s);
    if (to_s - from_s < span_s / 2) return sweep.direction * sweep.speed_rad_s;
    const MotorTrack& track = problem_.recording->motor;
    return (track.angle_at(to_s) - track.angle_at(from_s)) / (to_s - from_s);
  }

  // The number of a feature's scan line, or of the slice of it.
  std::uint32_t line_of(const PlacedSweep& sweep, const PlacedFeature& feature) const {
    if (slices_ == 1) return feature.line;
    const LaserScan& scan = problem_.recording->scans[feature.line];
    const double u = (time_s(sweep, feature) - scan.first_beam_s) / (scan.last_beam_s() - scan.first_beam_s);
    const double slice = std::clamp(std::floor(u * slices_), 0.0, slices_ - 1.0);
    return feature.line * slices_ + static_cast<std::uint32_t>(slice);
  }

  // One match: a point of one direction, its surface from points of the other.
  void add(std::uint32_t line, const Vector3d& p_m, const Vector3d& normal, double distance_m,
           PartEquations& equations) {
    row_.clear();
    double slope = add_point(line, p_m, normal, 1);
    result_.lever_m2 += square(normal.dot(arm_m(line, p_m)));
    result_.reach_m2 += arm_m(line, p_m).squaredNorm();
    for (int i = 0; i < near_.count; ++i) {
      const auto at = std::size_t(i);
      slope += add_point(near_.line[at], near_.p_m[at].cast<double>(), normal, -1.0 / near_.count);
    }
    const double weight = cauchy_weight(distance_m, options_.loss_width_m) / square(options_.match_sigma_m);
    equations.add(row_, slope, distance_m, weight);
    ++result_.matches;
  }

  // How a share of a point's distance changes with the knots; gives how it changes with the offset.
  double add_point(std::uint32_t line, const Vector3d& p_m, const Vector3d& normal, double share) {
    const ScanMotion& scan = scans_[line];
    const Vector6d row = share * distance_jacobian(p_m, normal, scan.base_in_map_m);
    row_.add(scan.place.knot, (1 - scan.place.u) * row);
    row_.add(scan.place.knot + 1, scan.place.u * row);
    return share * normal.dot(scan.turning_rad_s.cross(p_m - scan.base_in_map_m));
  }

  Vector3d arm_m(std::uint32_t line, const Vector3d& p_m) const {
    const ScanMotion& scan = scans_[line];
    return scan.turning_rad_s.normalized().cross(p_m - scan.base_in_map_m);
  }
  static double square(double x) { return x * x; }

  OffsetProblem problem_;
  const JointWalkOptions& options_;
  std::uint32_t slices_;  // of every scan
  SmoothPath path_;
  JointWalkPart result_;
  std::vector<ScanMotion> scans_;
  static constexpr std::uint32_t kNoLine = 0xffffffffu;
  std::uint32_t last_line_ = kNoLine;  // whose motion was worked out last
  Neighbours near_;
  KnotRow row_;
};

// Runs of neighbouring sweeps, about equally long.
std::vector<std::vector<SweepPose>> parts_of(const std::vector<SweepPose>& sweeps, double part_s) {
  const double duration_s = sweeps.back().end_s - sweeps.front().begin_s;
  const std::size_t least_sweeps = 8;
  const std::size_t count = std::clamp<std::size_t>(std::size_t(duration_s / part_s + 0.5), 1,
                                                    std::max<std::size_t>(1, sweeps.size() / least_sweeps));
  std::vector<std::vector<SweepPose>> parts(count);
  for (std::size_t k = 0; k < sweeps.size(); ++k) parts[k * count / sweeps.size()].push_back(sweeps[k]);
  return parts;
}

void summarise(JointWalk& walk) {
  double weights = 0, sum = 0, lever_m2 = 0, reach_m2 = 0;
  walk.converged = true;
  for (const JointWalkPart& part : walk.parts) {
    const double weight = 1 / (part.sigma_s * part.sigma_s);
    weights += weight;
    sum += weight * part.offset_s;
    if (!part.converged) walk.step_s += weight * std::abs(part.step_s);
    lever_m2 += part.lever_m2;
    reach_m2 += part.reach_m2;
    walk.features += part.features;
    walk.matches += part.matches;
    walk.converged = walk.converged && part.converged;
  }
  walk.offset_s = sum / weights;
  walk.step_s /= weights;
  walk.lever_m = std::sqrt(lever_m2 / double(walk.matches));
  walk.reach_m = std::sqrt(reach_m2 / double(walk.matches));
  walk.sigma_s = std::sqrt(1 / weights);
  // What the parts' own sigma leaves out (surfaces that are not flat, matches that are wrong) shows in how
  // they scatter. A few parts tell that badly: what was seen on other walks counts as kPriorParts more.
  constexpr double kPriorParts = 4, kPriorScatter2 = 1.1;
  double scatter2 = kPriorParts * kPriorScatter2;
  for (const JointWalkPart& part : walk.parts)
    scatter2 +=
        (part.offset_s - walk.offset_s) * (part.offset_s - walk.offset_s) / part.sigma_s / part.sigma_s;
  walk.sigma_s *= std::sqrt(std::max(1.0, scatter2 / (double(walk.parts.size() - 1) + kPriorParts)));
}

}  // namespace

std::optional<JointWalk> solve_joint_walk(const OffsetProblem& problem, const std::vector<SweepPose>& tracked,
                                          double offset_s, const JointWalkOptions& options, const Job& job) {
  if (tracked.empty()) return std::nullopt;
  const std::vector<std::vector<SweepPose>> cuts = parts_of(tracked, options.part_s);
  std::vector<JointWalkPart> parts(cuts.size());
  std::vector<std::vector<SweepPose>> sweeps = cuts;
  for_each_index(cuts.size(), [&](std::size_t i) {
    Part part(problem, cuts[i], offset_s, options);
    part.solve(job);
    parts[i] = part.result();
    if (parts[i].matches >= options.least_matches)
      for (SweepPose& sweep : sweeps[i]) sweep = part.path().as_sweep(sweep);
  });
  if (job.cancelled()) return std::nullopt;
  JointWalk walk;
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    if (parts[i].matches >= options.least_matches && parts[i].sigma_s > 0) walk.parts.push_back(parts[i]);
    walk.sweeps.insert(walk.sweeps.end(), sweeps[i].begin(), sweeps[i].end());
  }
  if (walk.parts.empty()) return std::nullopt;
  summarise(walk);
  return walk;
}

std::optional<Trend> drift_of(const JointWalk& walk) {
  std::vector<double> middles_s, offsets_s, sigmas_s;
  for (const JointWalkPart& part : walk.parts) {
    middles_s.push_back(part.middle_s);
    offsets_s.push_back(part.offset_s);
    sigmas_s.push_back(part.sigma_s);
  }
  return trend_of(middles_s, offsets_s, sigmas_s);
}

}  // namespace sweepscope
