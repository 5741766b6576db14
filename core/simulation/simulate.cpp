#include "core/simulation/simulate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "core/simulation/portable_math.hpp"
#include "core/simulation/ray_caster.hpp"
#include "core/simulation/scene.hpp"
#include "core/simulation/sensor.hpp"
#include "core/simulation/trajectory.hpp"

namespace sweepscope {
namespace {

using namespace simulation;

constexpr std::int64_t kEpoch_ns = 1'489'900'000'000'000'000;
constexpr double kRoomDuration_s = 4.5;
constexpr double kLongestStand_s = 600;
constexpr double kTruthStep_s = 0.01;

tl::unexpected<Error> wrong(std::string sentence) {
  return failure(ExitCode::kWrongUsage, std::move(sentence));
}

struct Bound {
  const char* name;
  double value, least, most;
  const char* unit;
};

Result<void> check(const SimulationOptions& o) {
  const Bound bounds[] = {
      {"the offset", o.offset_s * 1e3, -10e3, 10e3, " ms"},
      {"the noise", o.noise_m * 1e3, 0, 1000, " mm"},
      {"the dropout", o.dropout, 0, 1, ""},
      {"the sweep", o.sweep_s, 0.05, 60, " s"},
      {"the encoder's step", o.encoder_step_deg, 1e-6, 10, " deg"},
      {"the encoder's rate", o.encoder_hz, 5, 2000, " Hz"},
      {"the encoder's jitter", o.encoder_jitter_s * 1e3, 0, 300 / o.encoder_hz, " ms"},
      {"the part of mixed pixels", o.mixed_pixels, 0, 1, ""},
      {"the grazing bias", o.grazing_bias_m * 1e3, -500, 500, " mm"},
      {"the stamp jitter", o.stamp_jitter_s * 1e3, 0, 10, " ms"},
      {"the backlash", o.backlash_deg, 0, 10, " deg"},
      {"the clock drift", o.clock_drift_ppm, -1000, 1000, " ppm"},
      {"the nudge", o.nudge_m * 1e3, -1000, 1000, " mm"},
  };
  for (const Bound& b : bounds)
    if (!(b.value >= b.least && b.value <= b.most))
      return wrong(fmt::format("{} is {:g}{}, but must lie between {:g} and {:g}{}", b.name, b.value, b.unit,
                               b.least, b.most, b.unit));
  return {};
}

/// The duration asked for, or the scene's own.
Result<double> duration_of(const SimulationOptions& options, const Scene& scene) {
  const WalkSpec* walk = std::get_if<WalkSpec>(&scene.motion);
  const double longest_s = walk != nullptr ? walk->duration_s : kLongestStand_s;
  const double duration_s = options.duration_s.value_or(walk != nullptr ? walk->duration_s : kRoomDuration_s);
  if (!(duration_s >= 0.1 && duration_s <= longest_s))
    return wrong(fmt::format("the duration is {:g} s, but {} can be recorded for 0.1 to {:g} s", duration_s,
                             options.scene, longest_s));
  return duration_s;
}

/// Casts all scans into the recording; false where the job was cancelled.
bool cast_scans(const Sensor& sensor, Recording& recording, const Job& job) {
  const std::size_t scans = recording.scans.size();
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stopped{false};
  for_each_index(scans, [&](std::size_t i) {
    if (stopped || job.cancelled()) {
      stopped = true;
      return;
    }
    const std::size_t first = recording.scans[i].first_range;
    sensor.cast_scan(i, {recording.ranges_m.data() + first, Sensor::kBeams},
                     {recording.intensities.data() + first, Sensor::kBeams});
    const std::size_t finished = ++done;
    if (finished % 64 == 0) job.report("casting", static_cast<double>(finished) / static_cast<double>(scans));
  });
  return !stopped;
}

Recording blank_recording(const SimulationOptions& options, const Sensor& sensor, double duration_s) {
  Recording recording;
  recording.name = options.scene;
  recording.epoch_ns = kEpoch_ns;
  const auto scans = static_cast<std::size_t>(std::floor(duration_s / Sensor::kScanPeriod_s + 1e-9));
  for (std::size_t i = 0; i < scans; ++i) {
    LaserScan scan = sensor.scan(i);
    scan.first_range = i * Sensor::kBeams;
    recording.scans.push_back(scan);
  }
  recording.ranges_m.resize(scans * Sensor::kBeams);
  recording.intensities.resize(scans * Sensor::kBeams);
  recording.motor = sensor.motor_track(duration_s);
  return recording;
}

void fill_truth(Simulation& simulation, const Sensor& sensor) {
  const double end_s = *simulation.options.duration_s;
  const auto steps = static_cast<int>(std::floor(end_s / kTruthStep_s + 1e-9));
  for (int i = 0; i <= steps; ++i) {
    const Pose pose = sensor.pose_at(i * kTruthStep_s);
    simulation.truth.push_back({i * kTruthStep_s, pose.position_m, pose.orientation});
  }
  const WalkMeasure measured = measure([&](double t_s) { return sensor.pose_at(t_s); }, 0, end_s);
  simulation.length_m = measured.length_m;
  simulation.top_speed_mps = measured.top_speed_mps;
  simulation.top_angular_rate_radps = measured.top_angular_rate_radps;
}

}  // namespace

Result<Simulation> simulate(const SimulationOptions& options, const Job& job) {
  if (auto checked = check(options); !checked) return tl::unexpected(checked.error());
  const std::optional<Scene> scene = make_scene(options.scene);
  if (!scene)
    return wrong(fmt::format("there is no scene '{}'; the scenes are {}", options.scene,
                             fmt::join(scene_names(), ", ")));
  const Result<double> duration_s = duration_of(options, *scene);
  if (!duration_s) return tl::unexpected(duration_s.error());

  Simulation simulation;
  simulation.options = options;
  simulation.options.duration_s = *duration_s;
  simulation.moving = std::holds_alternative<WalkSpec>(scene->motion);
  simulation.triangles = scene->mesh.triangles.size();
  const Sensor sensor(simulation.options, *scene);
  simulation.recording = blank_recording(options, sensor, *duration_s);
  if (!cast_scans(sensor, simulation.recording, job)) return failure(ExitCode::kInterrupted, "interrupted");
  fill_truth(simulation, sensor);
  return simulation;
}

}  // namespace sweepscope
