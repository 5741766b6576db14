#include "core/rig_solve/rig_least_squares.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/loam/path/least_squares.hpp"
#include "core/numbers.hpp"
#include "core/parallel.hpp"
#include "core/rig_solve/rig_cloud.hpp"
#include "core/uncertainty.hpp"

namespace sweepscope {
namespace {

using PlaneRow = Eigen::Vector3d;  // derivative of a distance by the two tilts and the shift of its plane

// Weighted sums over points: products of the Jacobian rows of the unknowns (x), of the plane (p), and of the
// residuals (r).
struct Sums {
  RigMatrix xx = RigMatrix::Zero();
  Eigen::Matrix<double, kRigUnknowns, 3> xp = Eigen::Matrix<double, kRigUnknowns, 3>::Zero();
  Eigen::Matrix3d pp = Eigen::Matrix3d::Zero();
  RigVector xr = RigVector::Zero();
  PlaneRow pr = PlaneRow::Zero();

  Sums& operator+=(const Sums& other) {
    xx += other.xx;
    xp += other.xp;
    pp += other.pp;
    xr += other.xr;
    pr += other.pr;
    return *this;
  }
};

// Normal equations h x = -g of the step x, over the variance of the residuals.
struct Equations {
  RigMatrix h = RigMatrix::Zero();
  RigVector g = RigVector::Zero();

  Equations& operator+=(const Equations& other) {
    h += other.h;
    g += other.g;
    return *this;
  }
};

Sums of_cell(const RigCloud& cloud, const PlaneCell& cell, const Surface& surface, double loss_width_m) {
  const Eigen::Matrix<double, 3, 2> along = across_axis(surface.normal);
  Sums sums;
  for (const std::uint32_t i : cell.points) {
    const RigGeometry::Placed& at = cloud.placed[i];
    const Eigen::Vector3d d = at.p_in_base_m - surface.centre_m;
    const double residual_m = surface.normal.dot(d);
    const RigVector row = at.jacobian.transpose() * surface.normal;
    const double weight = cauchy_weight(residual_m, loss_width_m);
    PlaneRow plane;
    plane << along.transpose() * d, 1;
    sums.xx.noalias() += weight * row * row.transpose();
    sums.xp.noalias() += weight * row * plane.transpose();
    sums.pp.noalias() += weight * plane * plane.transpose();
    sums.xr.noalias() += weight * residual_m * row;
    sums.pr.noalias() += weight * residual_m * plane;
  }
  return sums;
}

// Prior deviation of a cell's distance from its surface, and of its tilt times its extent: walls are not
// flat, and some cells of a surface do not belong to it.
struct Unevenness {
  double deviation_m = 0, noise_m = 0;
};

// Marginalises the cell's own plane, which may deviate from that of the surface.
Sums with_own_plane(const Sums& sums, const PlaneCell& cell, const Surface& surface,
                    const Unevenness& unevenness) {
  const Eigen::Vector2d away_m = across_axis(surface.normal).transpose() * (cell.centre_m - surface.centre_m);
  Eigen::Matrix3d own_from_surface = Eigen::Matrix3d::Identity();
  own_from_surface.topRightCorner<2, 1>() = -away_m;
  const double mean_m = sums.pr[2] / sums.pp(2, 2);
  const double ratio = mean_m / (3 * unevenness.deviation_m);
  const double moves_m2 = unevenness.deviation_m * unevenness.deviation_m * (1 + ratio * ratio);
  const double tilts2 = moves_m2 / cell.along_m.squaredNorm();
  const Eigen::Matrix3d op = own_from_surface * sums.pp;
  Eigen::Matrix3d oo = op * own_from_surface.transpose();
  oo.diagonal() += unevenness.noise_m * unevenness.noise_m * PlaneRow(1 / tilts2, 1 / tilts2, 1 / moves_m2);
  const Eigen::LDLT<Eigen::Matrix3d> solver(oo);
  const Eigen::Matrix<double, kRigUnknowns, 3> xo = sums.xp * own_from_surface.transpose();
  const Eigen::Matrix<double, 3, kRigUnknowns> x_follows = solver.solve(xo.transpose());
  const Eigen::Matrix3d p_follows = solver.solve(op);
  const PlaneRow own = own_from_surface * sums.pr;
  Sums rest = sums;
  rest.xx.noalias() -= xo * x_follows;
  rest.xp.noalias() -= xo * p_follows;
  rest.pp.noalias() -= op.transpose() * p_follows;
  rest.xr.noalias() -= x_follows.transpose() * own;
  rest.pr.noalias() -= p_follows.transpose() * own;
  return rest;
}

// The flat surfaces of a placed cloud.
struct Scene {
  std::size_t points = 0;  // of the cloud
  std::vector<PlaneCell> cells;
  std::vector<Surface> surfaces;
  std::vector<Sums> sums;  // per cell
  Unevenness unevenness;
};

double robust_deviation_m(const RigCloud& cloud, const Scene& scene) {
  std::vector<float> sizes_m;
  for (const PlaneCell& cell : scene.cells)
    for (const std::uint32_t i : cell.points)
      sizes_m.push_back(float(std::abs(cell.normal.dot(cloud.p_m[i] - cell.centre_m))));
  return kSigmaPerMedianDeviation * double(median(std::move(sizes_m)));
}

// Deviation of the cells from their surfaces beyond the noise of their points.
double cells_deviation_m(const Scene& scene, double noise_m, double points_per_independent) {
  constexpr double kFlattest_m = 0.0001;  // no wall is flatter over metres
  std::vector<double> squares_m2, of_noise_m2;
  for (const Surface& surface : scene.surfaces) {
    if (surface.cells.size() <= 2) continue;
    for (const std::uint32_t cell : surface.cells) {
      const double mean_m = scene.sums[cell].pr[2] / scene.sums[cell].pp(2, 2);
      squares_m2.push_back(mean_m * mean_m);
      of_noise_m2.push_back(noise_m * noise_m * points_per_independent / scene.sums[cell].pp(2, 2));
    }
  }
  const double seen_m2 = kSigmaPerMedianDeviation * kSigmaPerMedianDeviation * median(std::move(squares_m2));
  return std::sqrt(std::max(kFlattest_m * kFlattest_m, seen_m2 - median(std::move(of_noise_m2))));
}

Scene scene_of(const RigCloud& cloud, const PlaneCellOptions& options, double reach_m, double loss_width_m,
               double points_per_independent) {
  Scene scene;
  scene.points = cloud.p_m.size();
  scene.cells = plane_cells(cloud.p_m, options);
  scene.surfaces = surfaces_of(scene.cells, reach_m);
  std::vector<const Surface*> surface_of(scene.cells.size());
  for (const Surface& surface : scene.surfaces)
    for (const std::uint32_t cell : surface.cells) surface_of[cell] = &surface;
  scene.sums.resize(scene.cells.size());
  for_each_index(scene.cells.size(), [&](std::size_t i) {
    scene.sums[i] = of_cell(cloud, scene.cells[i], *surface_of[i], loss_width_m);
  });
  const double noise_m = robust_deviation_m(cloud, scene);
  scene.unevenness = {cells_deviation_m(scene, noise_m, points_per_independent), noise_m};
  for_each_index(scene.cells.size(), [&](std::size_t i) {
    scene.sums[i] = with_own_plane(scene.sums[i], scene.cells[i], *surface_of[i], scene.unevenness);
  });
  return scene;
}

// The normal equations with the plane of each surface marginalised, without the cells in [first, last).
Equations equations_of(const Scene& scene, std::size_t first = 0, std::size_t last = 0) {
  Equations equations;
  for (const Surface& surface : scene.surfaces) {
    Sums sums;
    for (const std::uint32_t cell : surface.cells)
      if (cell < first || cell >= last) sums += scene.sums[cell];
    if (!(sums.pp(2, 2) > 0)) continue;
    const Eigen::LDLT<Eigen::Matrix3d> solver(sums.pp);
    const Eigen::Matrix<double, 3, kRigUnknowns> follows = solver.solve(sums.xp.transpose());
    equations.h.noalias() += sums.xx - sums.xp * follows;
    equations.g.noalias() += sums.xr - follows.transpose() * sums.pr;
  }
  if (scene.surfaces.empty()) return equations;
  const double noise_m = scene.unevenness.noise_m;
  equations.h /= noise_m * noise_m;
  equations.g /= noise_m * noise_m;
  return equations;
}

// How an offset of its own follows the other unknowns: its step is first - follows * (step of the others).
struct OwnOffset {
  double first_s = 0;
  RigVector follows = RigVector::Zero();

  double step_s(const RigVector& others) const { return first_s - follows.dot(others); }
};

OwnOffset own_offset_of(const Equations& equations) {
  OwnOffset own;
  const double h = equations.h(kOffset, kOffset);
  if (!(h > 0)) return own;
  own.first_s = -equations.g[kOffset] / h;
  own.follows = equations.h.col(kOffset) / h;
  own.follows[kOffset] = 0;
  return own;
}

// Marginalises the offset.
Equations without_offset(const Equations& equations) {
  const RigVector follows = own_offset_of(equations).follows;
  Equations rest = equations;
  rest.h.noalias() -= follows * equations.h.row(kOffset);
  rest.g.noalias() -= follows * equations.g[kOffset];
  rest.h.row(kOffset).setZero();
  rest.h.col(kOffset).setZero();
  rest.g[kOffset] = 0;
  return rest;
}

// Minimises x' h x / 2 + g' x over the unknowns solved for.
class Solver {
 public:
  explicit Solver(const RigPriors& priors) : priors_(priors) {
    for (int i = 0; i < kRigUnknowns; ++i)
      if (priors[i] > 0) free_.push_back(i);
  }

  RigVector step(const Equations& sum, const RigVector& at) const {
    RigVector full = RigVector::Zero();
    const Eigen::VectorXd pull = sum.g(free_) + prior_pull(at);
    const Eigen::VectorXd solved = -factor(sum.h).solve(pull);
    for (std::size_t i = 0; i < free_.size(); ++i) full[free_[i]] = solved[Eigen::Index(i)];
    return full;
  }

  RigMatrix covariance(const Equations& sum) const {
    RigMatrix full = RigMatrix::Zero();
    const auto n = Eigen::Index(free_.size());
    const Eigen::MatrixXd solved = factor(sum.h).solve(Eigen::MatrixXd::Identity(n, n));
    full(free_, free_) = solved;
    return full;
  }

 private:
  Eigen::LDLT<Eigen::MatrixXd> factor(const RigMatrix& h) const {
    Eigen::MatrixXd a = h(free_, free_);
    for (std::size_t i = 0; i < free_.size(); ++i)
      a(Eigen::Index(i), Eigen::Index(i)) += 1 / (priors_[free_[i]] * priors_[free_[i]]);
    return Eigen::LDLT<Eigen::MatrixXd>(a);
  }
  Eigen::VectorXd prior_pull(const RigVector& at) const {
    Eigen::VectorXd pull(Eigen::Index(free_.size()));
    for (std::size_t i = 0; i < free_.size(); ++i) {
      // There is no prior on the offset.
      const bool held = free_[i] != kOffset;
      pull[Eigen::Index(i)] = held ? at[free_[i]] / (priors_[free_[i]] * priors_[free_[i]]) : 0;
    }
    return pull;
  }

  RigPriors priors_;
  std::vector<int> free_;
};

// The surfaces that each of the recordings shows, and what they say of the unknowns in common.
struct Scenes {
  std::vector<Scene> each;
  bool own_offsets = false;

  // Of one of them, without the cells in [first, last).
  Equations equations(std::size_t i, std::size_t first = 0, std::size_t last = 0) const {
    const Equations of_it = equations_of(each[i], first, last);
    return own_offsets ? without_offset(of_it) : of_it;
  }
  std::vector<Equations> equations() const {
    std::vector<Equations> of_each;
    for (std::size_t i = 0; i < each.size(); ++i) of_each.push_back(equations(i));
    return of_each;
  }
};

Equations sum_of(const std::vector<Equations>& each, std::size_t without = SIZE_MAX) {
  Equations sum;
  for (std::size_t i = 0; i < each.size(); ++i)
    if (i != without) sum += each[i];
  return sum;
}

// Jackknife over parts of each scene, since errors of neighbouring surfaces (uneven walls, range bias) are
// correlated.
RigMatrix scatter(const Scenes& scenes, const std::vector<Equations>& each, const Solver& solver,
                  const RigVector& at) {
  constexpr std::size_t kParts = 12;  // a room has that many large surfaces
  RigMatrix sum = RigMatrix::Zero();
  const RigVector from = solver.step(sum_of(each), at);
  for (std::size_t i = 0; i < scenes.each.size(); ++i) {
    const Equations others = sum_of(each, i);
    const std::size_t cells = scenes.each[i].cells.size();
    for (std::size_t part = 0; part < kParts; ++part) {
      Equations rest = scenes.equations(i, part * cells / kParts, (part + 1) * cells / kParts);
      const RigVector apart = solver.step(rest += others, at) - from;
      sum += apart * apart.transpose();
    }
  }
  const double factor = student_factor(double(kParts - 1));
  return sum * (double(kParts - 1) / double(kParts)) * factor * factor;
}

bool small(const RigVector& step) {
  // Well below every sigma of rig_table, and 0.01 mm at 5 m.
  constexpr double kOffset_s = 1e-6, kAngle_rad = 2e-6, kShift_m = 1e-5;
  RigVector unit;
  unit << kOffset_s, kAngle_rad, kAngle_rad, kShift_m, kShift_m, kAngle_rad, kAngle_rad, kAngle_rad;
  return (step.cwiseAbs().array() < unit.array()).all();
}

// The priors of what the recordings have in common.
RigPriors common_priors(RigPriors priors, const RigUnknowns& first) {
  if (!first.apart_s.empty()) priors[kOffset] = 0;
  return priors;
}

Scenes scenes_of(std::span<const OffsetProblem> recordings, const RigUnknowns& rig, bool near_reversals,
                 const RigLeastSquaresOptions& options, double loss_width_m) {
  PlaneCellOptions cells;
  cells.levels = options.max_levels;
  cells.flatness_m = options.flatness * loss_width_m;
  Scenes scenes;
  scenes.own_offsets = !rig.apart_s.empty();
  for (std::size_t i = 0; i < recordings.size(); ++i)
    scenes.each.push_back(scene_of(
        place_with_rig(recordings[i], rig.of_recording(i), {near_reversals, options.max_points}), cells,
        options.reach * loss_width_m, loss_width_m, points_per_independent(recordings[i].feature_options)));
  return scenes;
}

void count_points(const Scenes& scenes, RigFit& fit) {
  fit.points = fit.on_planes = fit.planes = 0;
  fit.residual_m = fit.unevenness_m = 0;
  for (const Scene& scene : scenes.each) {
    fit.points += scene.points;
    fit.planes += scene.surfaces.size();
    for (const PlaneCell& cell : scene.cells) fit.on_planes += cell.points.size();
    fit.residual_m = std::max(fit.residual_m, scene.unevenness.noise_m);
    fit.unevenness_m = std::max(fit.unevenness_m, scene.unevenness.deviation_m);
  }
}

// Makes a step of the unknowns in common, which offsets of their own follow.
void make_step(RigFit& fit, const Scenes& scenes, const RigVector& step) {
  std::vector<double> apart_s = std::move(fit.rig.apart_s);
  fit.rig = RigUnknowns::from(fit.rig.vector() + step);
  fit.offsets_follow.clear();
  for (std::size_t i = 0; i < apart_s.size(); ++i) {
    const OwnOffset own = own_offset_of(equations_of(scenes.each[i]));
    apart_s[i] += own.step_s(step);
    fit.offsets_follow.push_back(own.follows);
  }
  fit.rig.apart_s = std::move(apart_s);
}

bool within_prior(const Eigen::Vector2d& encoder_rad, const RigPriors& priors) {
  constexpr double kMost = 4;  // standard deviations
  return priors[kEncoderSine] == 0 || encoder_rad.norm() <= kMost * priors[kEncoderSine];
}

}  // namespace

double points_per_independent(const FeatureOptions& options) {
  return std::max(1.0, (2.0 * options.half_window + 1) / options.map_spacing);
}

double RigFit::squared_distance(RigUnknown first, int count) const {
  const Eigen::VectorXd x = rig.vector().segment(first, count);
  const Eigen::MatrixXd of_these = covariance.block(first, first, count, count);
  return x.dot(of_these.ldlt().solve(x));
}

RigFit solve_rig_planes(std::span<const OffsetProblem> recordings, const RigUnknowns& first,
                        const RigPriors& priors, const RigLeastSquaresOptions& options, const Job& job) {
  RigFit fit;
  fit.rig = first;
  double loss_width_m = options.first_loss_width_m;
  bool narrowed = false;
  // Few surfaces determine play and encoder, so these join once the rest has nearly converged.
  RigPriors begun_with = common_priors(priors, first);
  begun_with.tail<3>().setZero();
  for (; fit.iterations < options.max_iterations && !job.cancelled(); ++fit.iterations) {
    const Scenes scenes = scenes_of(recordings, fit.rig, priors[kPlay] > 0, options, loss_width_m);
    count_points(scenes, fit);
    if (fit.planes == 0) return fit;
    const std::vector<Equations> each = scenes.equations();
    const Equations sum = sum_of(each);
    const Solver solver(narrowed ? common_priors(priors, first) : begun_with);
    const RigVector x = fit.rig.vector(), step = solver.step(sum, x);
    fit.converged = narrowed && small(step);
    fit.last_step = step;
    make_step(fit, scenes, step);
    if (fit.converged || fit.iterations + 1 == options.max_iterations) {
      fit.information = sum.h;
      fit.covariance = solver.covariance(sum) + scatter(scenes, each, solver, x);
      fit.encoder_within_prior = within_prior(fit.rig.encoder_rad, priors);
      break;
    }
    const double width_m = options.loss_width_m(fit.residual_m);
    narrowed = width_m > 0.9 * loss_width_m;
    loss_width_m = std::min(loss_width_m, std::max(0.6 * loss_width_m, width_m));
  }
  return fit;
}

}  // namespace sweepscope
