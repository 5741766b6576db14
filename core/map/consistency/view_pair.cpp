#include "core/map/consistency/view_pair.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <optional>

#include "core/loam/path/least_squares.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// Tuned, as all limits of this folder, on 55 of the walks that tests/benchmark/random_walks draws with
// seed 5, and on the worlds of tests/benchmark/worlds 24 1.
constexpr double kOnSurface_m = 0.1;    // nearer, a feature lies on its surface
constexpr double kMatchSigma_m = 0.02;  // of a match: its neighbours err together
constexpr double kWideLoss_m = 0.3, kNarrowLoss_m = 0.05;
constexpr double kMaxTranslationSigma_m = 0.03, kMaxRotationSigma_rad = 0.6 * kRadPerDeg;
constexpr double kMinCoinciding = 0.2;   // part of the features
constexpr double kMaxMovedMisfit = 0.3;  // after the move
constexpr double kMinPlaced = 0.3;  // of the features as placed: else the views saw different places, alike
// Features that a move brings onto their surfaces, against those that it takes away from them.
constexpr double kMinGained = 10, kGainedPerGivenUp = 2;

// The surface about a feature where it was searched last.
struct Surface {
  std::optional<PlanePatch> plane;
  std::optional<LinePatch> line;
  Vector3d searched_at_m = Vector3d::Constant(1e30);
};

class ViewRegistration {
 public:
  ViewRegistration(const SweepMaps& other, const Vector3d& other_at_m, const WalkView& view,
                   const MappingOptions& options)
      : search_{other.edges, other.planes, search_rule(options, false, SweepFilter::kAny)},
        other_at_m_(other_at_m),
        view_(view),
        reuse_within_m_(options.reuse_within_m),
        surfaces_(view.seen.size()) {}

  // Calls use(feature, p_m, residual) for every feature with a surface about it.
  template <typename Use>
  void match(const Pose& move, const Use& use) {
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
      const SeenFeature& feature = view_.seen[i];
      const Vector3d p_m = move * feature.p_m;
      search(surfaces_[i], feature, p_m);
      if (const auto residual = residual_of_side(surfaces_[i], p_m, move * feature.from_m))
        use(feature, p_m, *residual);
    }
  }

 private:
  void search(Surface& surface, const SeenFeature& feature, const Vector3d& p_m) {
    if ((p_m - surface.searched_at_m).norm() < reuse_within_m_) return;
    surface = {{}, {}, p_m};
    if (feature.kind == MatchedKind::kPlane)
      surface.plane = search_.plane(p_m, feature.range_m);
    else
      surface.line = search_.line(p_m, feature.range_m);
  }
  // The two sides of a wall are two surfaces.
  std::optional<MatchResidual> residual_of_side(const Surface& surface, const Vector3d& p_m,
                                                const Vector3d& from_m) const {
    if (!surface.plane) return residual_of(surface.line, p_m);
    const Vector3d& normal = surface.plane->normal;
    const bool same_side = normal.dot(from_m - p_m) * normal.dot(other_at_m_ - surface.plane->centre_m) >= 0;
    return same_side ? std::optional(residual_of(*surface.plane, p_m)) : std::nullopt;
  }

  PatchSearch search_;
  Vector3d other_at_m_;
  const WalkView& view_;
  double reuse_within_m_;
  std::vector<Surface> surfaces_;
};

bool on_surface(const MatchResidual& residual) {
  return std::abs(residual.distance_m) < kOnSurface_m;
}

void add(SurfaceFit& fit, const MatchResidual& residual) {
  ++fit.matched;
  if (on_surface(residual)) ++fit.near;
}

// Of three of a step's unknowns, from `first` on, in their least determined direction.
double max_sigma(const RigidEquations& equations, int first) {
  constexpr double kPrior = 1e-2;  // of 10 m and 10 rad: the matrix is then regular
  const Matrix6d covariance = (equations.matrix + kPrior * Matrix6d::Identity()).inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance.block<3, 3>(first, first));
  return std::sqrt(solver.eigenvalues()[2]);
}

// With a loss that narrows. Gives the equations of the last step.
RigidEquations register_view(ViewRegistration& registration, const Vector3d& at_m, double tolerance,
                             Pose& move) {
  constexpr int kIterations = 5;  // with either loss
  RigidEquations equations;
  for (const double loss_m : {kWideLoss_m, kNarrowLoss_m})
    for (int i = 0; i < kIterations; ++i) {
      const Vector3d pivot_m = move * at_m;
      equations = {};
      registration.match(move, [&](const SeenFeature&, const Vector3d& p_m, const MatchResidual& residual) {
        const double weight = cauchy_weight(residual.distance_m, loss_m) / (kMatchSigma_m * kMatchSigma_m);
        if (residual.has_normal) equations.add(p_m - pivot_m, residual.normal, residual.distance_m, weight);
      });
      constexpr double kMinInformation = 100;  // 10 cm and 0.1 rad
      int free_directions = 0;
      const Vector6d step =
          solve_determined(equations.matrix, equations.gradient, kMinInformation, free_directions);
      move = stepped(move, step, pivot_m);
      if (step.cwiseAbs().maxCoeff() < tolerance) break;
    }
  return equations;
}

}  // namespace

bool ViewPair::determined() const {
  return translation_sigma_m < kMaxTranslationSigma_m && rotation_sigma_rad < kMaxRotationSigma_rad;
}

bool ViewPair::coincides() const {
  const double all = double(features);
  const bool better =
      placed.misfit() > moved.misfit() && double(gained) >= kMinGained + kGainedPerGivenUp * double(given_up);
  return (apart_m < kOnSurface_m || better) && determined() && double(moved.near) > kMinCoinciding * all &&
         kMaxMovedMisfit > moved.misfit() && double(placed.matched) > kMinPlaced * all;
}

ViewPair match_views(const SweepMaps& other, const Vector3d& other_at_m, const WalkView& view,
                     const MappingOptions& options) {
  ViewRegistration registration(other, other_at_m, view, options);
  ViewPair pair;
  std::vector<char> lay_on_surface(view.seen.size(), 0);
  const auto lay = [&](const SeenFeature& feature) -> char& {
    return lay_on_surface[std::size_t(&feature - view.seen.data())];
  };
  pair.features = view.seen.size();
  pair.placed_sweeps.resize(view.end - view.first);
  FacedSurfaces faced;
  registration.match(pair.move,
                     [&](const SeenFeature& feature, const Vector3d& p_m, const MatchResidual& residual) {
                       faced.add(p_m - view.at.translation_m, residual.normal, residual.distance_m);
                       add(pair.placed, residual);
                       lay(feature) = on_surface(residual);
                       add(pair.placed_sweeps[feature.sweep], residual);
                     });
  pair.weakest = faced.weakest();
  std::size_t kept = 0;
  const RigidEquations equations =
      register_view(registration, view.at.translation_m, 2 * options.step_tolerance, pair.move);
  registration.match(pair.move,
                     [&](const SeenFeature& feature, const Vector3d& p_m, const MatchResidual& residual) {
                       add(pair.moved, residual);
                       if (!on_surface(residual)) return;
                       if (lay(feature) == 0) ++pair.gained;
                       kept += lay(feature);
                       pair.apart_m += (p_m - feature.p_m).norm();
                       pair.place_m += feature.p_m;
                     });
  pair.given_up = pair.placed.near - kept;
  if (pair.moved.near > 0) {
    pair.apart_m /= double(pair.moved.near);
    pair.place_m /= double(pair.moved.near);
  }
  pair.rotation_sigma_rad = max_sigma(equations, 0);
  pair.translation_sigma_m = max_sigma(equations, 3);
  return pair;
}

}  // namespace sweepscope
