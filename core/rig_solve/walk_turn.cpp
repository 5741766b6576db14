#include "core/rig_solve/walk_turn.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "core/loam/path/least_squares.hpp"
#include "core/numbers.hpp"
#include "core/rig_solve/rig_unknowns.hpp"

namespace sweepscope {
namespace {

using Across = Eigen::Matrix<double, 3, 2>;

// The knots of a solved walk: nothing is known of faster changes.
constexpr double kStep_s = 0.06;

// How the rotation of the base changes from one step to the next, and how a turn of the mount by 1 rad would
// change it.
struct Change {
  Eigen::Vector3d seen_rad;
  Across by_turn;
  int part;  // of the walk
};

// The base at a step, and how a turn of the mount by 1 rad would turn it.
struct Step {
  double time_s;
  Pose base;
  Across by_turn;
};

std::vector<Step> steps_along(const Recording& recording, std::span<const SweepPose> run, double offset_s) {
  const Eigen::Vector3d axis = recording.rig.mount.axis.normalized();
  const Across across = across_axis(axis);
  MotorReader motor(recording.motor);
  std::vector<Step> steps;
  auto sweep = run.begin();
  for (double t_s = run.front().begin_s; t_s < run.back().end_s; t_s += kStep_s) {
    while (sweep + 1 < run.end() && sweep->end_s < t_s) ++sweep;
    const double u = (t_s - sweep->begin_s) / (sweep->end_s - sweep->begin_s);
    steps.push_back({t_s, sweep->at(std::clamp(u, 0.0, 1.0)),
                     Eigen::AngleAxisd(motor.angle_at(t_s + offset_s), axis).toRotationMatrix() * across});
  }
  return steps;
}

// Whether the base moves within one turn of the motor, in which a wrong mount sways it back to where it was.
// A rig that stands sees each direction at one angle of the motor: its map is bent as its poses are, and
// neither shows a turn of the mount.
bool moves(const std::vector<Step>& steps, std::size_t at, std::size_t turn) {
  constexpr double kStands_m = 0.05, kStands_rad = kRadPerDeg;
  const std::size_t begin = at >= turn ? at - turn : at, end = std::min(begin + turn, steps.size() - 1);
  const Pose by = steps[begin].base.inverse() * steps[end].base;
  return by.translation_m.norm() > kStands_m || vector_from_rotation(by.rotation).norm() > kStands_rad;
}

// The changes along sweeps that follow each other.
void add_changes(const Recording& recording, std::span<const SweepPose> run, double offset_s,
                 std::vector<Change>& changes) {
  constexpr double kPart_s = 2;  // two or more turns of the motor: over less the sway of a body is correlated
  const std::vector<Step> steps = steps_along(recording, run, offset_s);
  const double turn_s = 2 * (run.back().end_s - run.front().begin_s) / double(run.size());
  const auto turn = std::size_t(std::lround(turn_s / kStep_s));
  for (std::size_t i = 1; i + 1 < steps.size(); ++i) {
    if (!moves(steps, i, turn)) continue;
    const Step &before = steps[i - 1], &at = steps[i], &after = steps[i + 1];
    changes.push_back({turn_between(at.base.rotation, after.base.rotation) -
                           turn_between(before.base.rotation, at.base.rotation),
                       after.by_turn - 2 * at.by_turn + before.by_turn, int(after.time_s / kPart_s)});
  }
}

std::vector<Change> changes_along(const Recording& recording, const std::vector<SweepPose>& sweeps,
                                  double offset_s) {
  std::vector<Change> changes;
  const auto follows = [](const SweepPose& before, const SweepPose& sweep) {
    return !before.lost && !sweep.lost && before.stretch == sweep.stretch && before.sweep + 1 == sweep.sweep;
  };
  for (std::size_t first = 0, next = 1; first < sweeps.size(); first = next, ++next) {
    while (next < sweeps.size() && follows(sweeps[next - 1], sweeps[next])) ++next;
    if (!sweeps[first].lost)
      add_changes(recording, std::span(sweeps).subspan(first, next - first), offset_s, changes);
  }
  return changes;
}

// The directions in which it is positive.
Eigen::Matrix2d positive_part(const Eigen::Matrix2d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(symmetric);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

// Least squares with a Cauchy loss about twice the median change: a stumble counts little.
class TurnFit {
 public:
  explicit TurnFit(const std::vector<Change>& changes) : changes_(changes) {
    constexpr int kIterations = 10;
    for (int i = 0; i < kIterations; ++i) {
      set_width();
      Eigen::Vector2d pull = Eigen::Vector2d::Zero();
      normal_.setZero();
      for (const Change& change : changes_) {
        const double weight = weight_of(change);
        normal_ += weight * change.by_turn.transpose() * change.by_turn;
        pull += weight * change.by_turn.transpose() * change.seen_rad;
      }
      turn_rad_ = normal_.ldlt().solve(pull);
    }
  }

  const Eigen::Vector2d& turn_rad() const { return turn_rad_; }

  // From the pulls of the parts of the walk (White 1980, with clusters). If the error of the track lasts
  // longer than such a part, longer parts scatter more than the short ones predict. A few longer parts are a
  // poor sample of this: the short ones count as kPrior more.
  Eigen::Matrix2d covariance() const {
    constexpr int kLong = 5;
    constexpr double kPrior = 4;
    const Eigen::Matrix2d scatter = scatter_of_parts(1).of_pulls;
    const auto [long_scatter, count] = scatter_of_parts(kLong);
    const Eigen::Matrix2d more =
        (double(count) * long_scatter - double(count - 1) * scatter) / (kPrior + double(count - 1));
    const Eigen::Matrix2d inverse = normal_.inverse();
    return inverse * (scatter + positive_part(more)) * inverse;
  }

 private:
  struct Scatter {
    Eigen::Matrix2d of_pulls = Eigen::Matrix2d::Zero();
    std::size_t parts = 0;
  };
  // Of so many parts together.
  Scatter scatter_of_parts(int together) const {
    std::map<int, Eigen::Vector2d> pulls;
    for (const Change& change : changes_)
      pulls.try_emplace(change.part / together, Eigen::Vector2d::Zero()).first->second +=
          weight_of(change) * change.by_turn.transpose() * left_rad(change);
    Scatter scatter{Eigen::Matrix2d::Zero(), pulls.size()};
    for (const auto& [part, pull] : pulls) scatter.of_pulls += pull * pull.transpose();
    return scatter;
  }
  Eigen::Vector3d left_rad(const Change& change) const {
    return change.seen_rad - change.by_turn * turn_rad_;
  }
  double weight_of(const Change& change) const { return cauchy_weight(left_rad(change).norm(), width_rad_); }
  void set_width() {
    std::vector<double> left;
    for (const Change& change : changes_) left.push_back(left_rad(change).norm());
    width_rad_ = 2 * median(std::move(left));
  }

  const std::vector<Change>& changes_;
  Eigen::Vector2d turn_rad_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d normal_;
  double width_rad_ = 0;
};

}  // namespace

std::optional<WalkTurn> turn_of_walk(const Recording& recording, const std::vector<SweepPose>& sweeps,
                                     double offset_s) {
  constexpr double kMin_s = 10;
  // What a sway in step with the motor adds on the walks of tests/benchmark/walks. Bodies sway more at the
  // pace of a slow motor.
  constexpr double kSway_rad = 0.12 * kRadPerDeg, kAtSweep_s = 0.5;
  const std::vector<Change> changes = changes_along(recording, sweeps, offset_s);
  if (double(changes.size()) * kStep_s < kMin_s) return std::nullopt;
  const TurnFit fit(changes);
  std::vector<double> durations_s;
  for (const SweepPose& sweep : sweeps) durations_s.push_back(sweep.end_s - sweep.begin_s);
  const double sway_rad = kSway_rad * std::pow(median(std::move(durations_s)) / kAtSweep_s, 2);
  return WalkTurn{fit.turn_rad(), fit.covariance() + sway_rad * sway_rad * Eigen::Matrix2d::Identity()};
}

double unconverged_rad(std::span<const double> steps_rad) {
  double beyond_rad = 0;
  for (std::size_t i = 1; i < steps_rad.size(); ++i)
    beyond_rad = std::max(beyond_rad, steps_rad[i] - steps_rad[i - 1] / 2);
  return steps_rad.empty() ? 0 : std::hypot(steps_rad.back(), beyond_rad);
}

}  // namespace sweepscope
