#include "ui/model/loaded.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/io/trajectory_file.hpp"
#include "core/map/stamped_poses.hpp"
#include "core/numbers.hpp"
#include "core/offset/kind/rig_motion.hpp"
#include "core/offset/readings/fitting_recording.hpp"
#include "core/simulation/simulate.hpp"
#include "ui/state/value.hpp"

namespace sweepscope::ui {
namespace {

/// The range of nearly all intensities.
void find_intensities(Loaded& loaded) {
  std::vector<float> all = loaded.recording.intensities;
  if (all.empty()) return;
  loaded.min_intensity = static_cast<double>(quantile(all, 0.01));
  loaded.max_intensity = static_cast<double>(quantile(all, 0.99));
}

Result<LoadedPtr> finish(std::shared_ptr<Loaded> loaded, const Job& job) {
  job.report("reading its streams", 0);
  loaded->summary = inspect(loaded->recording);
  loaded->beams = collect_beams(loaded->recording);
  find_intensities(*loaded);
  auto prepared = prepare(loaded->recording, FeatureOptions(), job);
  if (!prepared) return tl::unexpected(prepared.error());
  loaded->prepared = std::move(*prepared);
  const MotionTest motion = test_motion(loaded->prepared);
  if (motion.answered()) {
    loaded->moving = motion.moving();
    loaded->summary.motion = motion.moving() ? "moving" : "stationary";
  }
  return LoadedPtr(std::move(loaded));
}

}  // namespace

Result<LoadedPtr> load_file(const ReadingChoices& choices, const Job& job) {
  const auto options = read_options(choices);
  if (!options) return tl::unexpected(options.error());
  auto recording = read_fitting(choices.file, *options, job, choices.window);
  if (!recording) return tl::unexpected(recording.error());
  auto loaded = std::make_shared<Loaded>();
  loaded->choices = choices;
  loaded->source = "open " + ui::quoted(choices.file);
  if (!choices.poses.empty()) {
    auto known = read_tum(choices.poses, recording->epoch_ns);
    if (!known) return tl::unexpected(known.error());
    auto covered = check_pose_coverage(*recording, *known);
    if (!covered) return tl::unexpected(covered.error());
    if (!covered->empty()) recording->report.warnings.push_back(*covered);
    loaded->poses = std::move(*known);
    loaded->source += fmt::format(" {}", ui::quoted(choices.poses));
  }
  loaded->recording = std::move(*recording);
  return finish(std::move(loaded), job);
}

Result<LoadedPtr> load_sample(const std::string& scene, double seconds, const Job& job) {
  SimulationOptions options;
  options.scene = scene;
  if (seconds > 0) options.duration_s = seconds;
  auto simulation = simulate(options, job);
  if (!simulation) return tl::unexpected(simulation.error());
  auto loaded = std::make_shared<Loaded>();
  loaded->source = "sample " + scene + (seconds > 0 ? fmt::format(" {}", seconds) : "");
  loaded->recording = std::move(simulation->recording);
  loaded->truth_s = options.offset_s;
  return finish(std::move(loaded), job);
}

}  // namespace sweepscope::ui
