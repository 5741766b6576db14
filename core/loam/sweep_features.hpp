#pragma once

// The mathematics: docs/algorithms.md, section 2.

#include <memory>
#include <vector>

#include "core/geometry/kinematics.hpp"
#include "core/loam/features.hpp"
#include "core/recording/sweeps.hpp"

namespace sweepscope {

/// A feature of a sweep placed with the motor angle of its own instant at a candidate offset.
struct PlacedFeature {
  Eigen::Vector3d p_in_base_m;  // with the motor angle of its own instant
  double u = 0;                 // where in the sweep: 0 at its begin, 1 at its end
  float range_m = 0;            // as measured
  std::uint32_t line = 0;       // the scan, counted through the recording
  bool sharp = false;           // to be matched; the others only build the map
};

/// A sweep's features at a candidate offset.
struct PlacedSweep {
  std::size_t sweep = 0;  // index into MotorMotion::sweeps
  int direction = 0;      // in which the motor turns, 1 or -1
  /// +1 or -1: in maps its points are matched to those of the other side. Its direction; of a motor that
  /// turns one way every second half turn.
  int side = 0;
  double begin_s = 0, end_s = 0;                         // laser clock
  Eigen::Vector3d turned_rad = Eigen::Vector3d::Zero();  // by the motor, rotation vector in the base frame
  std::size_t scans = 0;                                 // whose features it holds
  std::vector<PlacedFeature> edges, planes;              // on corners, and on flat surfaces
};

/// Keeps one in `stride` of the sharp edges and planes to be matched; the others only build the map.
void thin(PlacedSweep& sweep, std::size_t stride);

/// The input of every candidate: everything that does not depend on the offset.
struct OffsetProblem {
  const Recording* recording = nullptr;        // must outlive it
  std::shared_ptr<const FeatureSet> features;  // of the whole recording
  MotorMotion motor;                           // its sweeps, and the angle at any time
  std::vector<char> scan_used;       // per scan: 1 where the motor track covers it at every offset searched
  double line_spacing_rad = 0;       // by which the motor turns from one scan to the next
  FeatureOptions feature_options{};  // by which the features were picked
};

/// Places the features of one sweep after the other at an offset: t_motor = t_laser + offset. Features within
/// a reversal's unsteady part, and scans that are not used, are left out; sweeps without any scan are
/// skipped.
class SweepPlacer {
 public:
  /// The problem must outlive it.
  SweepPlacer(const OffsetProblem& problem, double offset_s);

  /// The number of sweeps that have scans.
  std::size_t count() const { return scans_.size(); }
  /// Places one of them into `placed`, replacing its content.
  void place(std::size_t i, PlacedSweep& placed);
  /// Places the next one; false if there is none.
  bool next(PlacedSweep& placed);

 private:
  const OffsetProblem& problem_;
  double offset_s_;
  Kinematics kinematics_;
  MotorReader motor_;
  bool one_way_;
  std::vector<std::size_t> sweep_of_;  // per scan
  struct Scans {
    std::size_t first, end;
  };
  std::vector<Scans> scans_;  // of each sweep: all its own are among these
  std::size_t next_ = 0;
};

/// All sweeps at once. For a long recording this takes several times the memory of its beams.
std::vector<PlacedSweep> place_sweeps(const OffsetProblem& problem, double offset_s);

}  // namespace sweepscope
