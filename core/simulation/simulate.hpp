#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/recording.hpp"
#include "core/simulation/motion/motor.hpp"
#include "core/simulation/motion/recorded_path.hpp"
#include "core/simulation/scanner.hpp"

namespace sweepscope {

struct RawRecording;

/// A scene and a walk provided by the user.
struct OwnScene {
  std::filesystem::path mesh;  // .ply or .obj; empty: none
  std::filesystem::path
      trajectory;  // TUM; empty: the rig is stationary at placement.at_m, turned by placement.yaw_deg
  simulation::PathPlacement placement;  // of the trajectory in the mesh
  double from_s = 0;                    // the trajectory's first seconds are left out
};

/// A world and a walk drawn at random; see simulation::world_names() and simulation::walk_names().
struct RandomWorld {
  std::string world, walk = "brisk";            // no world: none
  std::uint64_t world_seed = 1, walk_seed = 1;  // equal seeds give equal worlds and walks
};

/// What tells of the motor's motion: its encoder, a signal once a turn (std_msgs/Float64 on /index), or
/// nothing.
enum class MotorMessages { kJointStates, kIndex, kNone };
/// As --motor-messages spells them.
std::string_view name_of(MotorMessages messages);

/// What to record. t_motor = t_laser + offset: at one true instant the laser's clock shows T and the motor's
/// T + offset_s. Equal options give equal bytes, on every x86-64 machine and for any number of threads.
struct SimulationOptions {
  std::string scene = "room-1";      // see simulation::scene_names()
  double offset_s = 0.024;           // within +-10 s
  std::uint64_t seed = 1;            // of noise, dropouts, jitter, swaying and the motor's phase
  std::optional<double> duration_s;  // the first seconds of the walk; none: all of it, 4.5 s in a
                                     // room, 60 s in a random world, whose walks last as long as asked

  simulation::Scanner scanner = {};    // beams, ranges and noise; a UTM-30LX
  std::optional<double> noise_m = {};  // standard deviation of a range, 0 to 1; none: the scanner's
  double dropout = 0.002;              // fraction of the beams without a return, 0 to 1
  double sweep_s = 0.5;                // one half turn of the motor, 0.05 to 60
  simulation::MotorKind motor = simulation::MotorKind::kTrapezoid;  // how it turns
  simulation::MotorAxis axis = simulation::MotorAxis::kX;           // of the base frame
  double swing_deg = 90;        // by which the motor swings to either side, 1 to 180
  double motor_middle_deg = 0;  // about which the motor swings, within +-180; 0: the scanner is level there
  double motor_rest_s = 0, motor_rest_at_s = 0;  // how long the motor rests, and from when on; 0 to 1e6
  double steps_per_turn = 0;  // the motor moves in steps, of even speed; 0: it does not; up to 10000
  double dwell_s = 0;         // how long it rests before each step, of the time that the step takes
  /// Of a motor that turns one way, instead of sweep_s: each for an equal part of the recording, or with
  /// speed_ramp evenly from one to the next. 1 to 3600 each; empty: one speed, half a turn in sweep_s.
  std::vector<double> speeds_dps = {};
  bool speed_ramp = false;           // see speeds_dps
  double encoder_step_deg = 0.088;   // above 0, up to 10
  double encoder_hz = 100;           // 5 to 2000
  double encoder_jitter_s = 0.0005;  // standard deviation of the sampling instants, up to 0.3 / encoder_hz

  // How drivers write messages; by default as the fields of a LaserScan are meant. What a rig file has to say
  // about it: rig_of.
  std::optional<simulation::BeamTimes> beam_times = {};  // none: the scanner's
  StampAt stamp_at = StampAt::kFirstBeam;  // first or last beam; in the messages alone, not in `recording`
  bool no_time_increment = false;          // time_increment is 0 in the messages
  double scan_time_factor = 1;             // scan_time is that of a turn, times this; 0 to 100
  std::uint32_t parts = 1;                 // messages that a turn of the mirror is cut into, 1 to 100
  bool laser_upside_down = false;          // mounted so; turned by 180 deg about its forward axis
  std::uint32_t motor_repeats =
      1;  // each angle is sent this often before the next, under new stamps, 1 to 100
  MotorMessages motor_messages = MotorMessages::kJointStates;  // what tells the motor's angle
  bool motor_in_degrees = false;                               // its angles, instead of rad

  // Faults of real rigs, none by default.
  double mixed_pixels = 0;     // fraction of the beams at an edge that return a range in between, 0 to 1
  double grazing_bias_m = 0;   // added to a range, times 1 - cos(incidence), within +-0.5
  double stamp_jitter_s = 0;   // standard deviation added to every header stamp, 0 to 0.01
  double backlash_deg = 0;     // play between the encoder and the laser, 0 to 10
  double clock_drift_ppm = 0;  // by how much the motor's clock runs faster than the laser's, within +-1000
  double jump_s = 0;  // the motor's clock jumps forward by this at jump_at_s: the offset grows; within +-10
  double jump_at_s = 0;  // true time, 0 to 1e6
  double nudge_m = 0;  // a stationary rig is pushed sideways by this, one second after the start, within +-1
  double noise_per_m = 0;  // added to the noise for every metre of range, 0 to 0.1
  double grazing_dropout =
      0;  // dropped with this times 1 - 2 albedo cos(incidence), where that is above 0; 0 to 1
  Eigen::Vector3d mount_error_deg =
      Eigen::Vector3d::Zero();                              // Mount::laser_in_motor_rpy_deg, each within +-10
  Eigen::Vector3d mount_error_m = Eigen::Vector3d::Zero();  // Mount::laser_in_motor_xyz_m, each within +-0.5
  double eccentricity_deg = 0;        // the encoder shows angle + this sin(angle + phase), 0 to 10
  double eccentricity_phase_deg = 0;  // within +-360
  double uneven_motor = 0;            // the motor's speed varies at random by at most this fraction, 0 to 0.5
  int people = 0;                     // people who walk through the scene, 0 to 50
  double glass = 0;  // fraction of the upright surfaces, in cells of 1 m, that are glass, 0 to 1

  OwnScene own = {};        // instead of `scene`
  RandomWorld random = {};  // instead of both

  bool imu = false;        // the bag also holds an IMU's gyroscope, in the base frame
  double imu_shift_s = 0;  // added to its stamps it gives the laser's clock, within +-10
};

/// The base frame in the world.
struct TruthPose {
  double time_s = 0;                                     // laser clock, seconds since Recording::epoch_ns
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // of the base frame's origin
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // world_from_base
};

/// When the beams are fired.
inline simulation::BeamTimes fired_times(const SimulationOptions& options) {
  return options.beam_times.value_or(options.scanner.beam_times);
}

/// How long a step of the motor takes, with its rest; 0 without steps.
double step_s(const SimulationOptions& options);

/// How the laser is mounted on the motor: roll, pitch and yaw, with the mount's error. On a motor that turns
/// about z it is rolled by 90 deg, so that its plane contains the motor's axis.
Eigen::Vector3d laser_in_motor_rpy_deg(const SimulationOptions& options);

/// What a rig file has to say for the messages to be read as they were made: the axis, the mount without its
/// error, and how the driver writes. Rig() for default options.
Rig rig_of(const SimulationOptions& options);

/// A recording and its ground truth.
struct Simulation {
  Recording recording;  // equal to the recording read from the bag of write_bag with the rig of rig_of
  std::shared_ptr<const RawRecording>
      messages;                  // of a 3D scanner, from which the recording was read; else null
  std::vector<TruthPose> truth;  // every 10 ms from the first beam to the last; every 5 ms in an own scene
  TurnRates imu;                 // if requested: 200 Hz, with a bias and noise, on its own clock
  SimulationOptions options;     // with the duration filled in
  bool moving = false;           // the scene has a walk
  double length_m = 0;           // of the path, from the truth, including sway; the maxima too
  double top_speed_mps = 0;      // along the path
  double top_angular_rate_radps = 0;       // of the base frame
  std::size_t triangles = 0;               // of the scene
  std::string mesh_hash, trajectory_hash;  // content_hash of the files of an own scene
  simulation::SplineDeviation deviation;   // of the spline from an own trajectory's poses
};

/// Records a scene with a scanner (by default a UTM-30LX: 40 scans/s, 721 beams over 180 deg, 0.1 to 30 m)
/// that a motor turns about an axis of the base frame (by default x: it rolls). Every beam is cast at its own
/// time, with the pose and the motor angle of that time. Ranges are rounded to 1 mm and angles to the
/// encoder's step. Invalid options are ExitCode::kWrongUsage, and so is a user's walk that comes nearer than
/// 0.15 m to a surface.
Result<Simulation> simulate(const SimulationOptions& options, const Job& job);

}  // namespace sweepscope
