#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "core/io/cloud_file.hpp"
#include "core/io/trajectory_file.hpp"
#include "core/map/clean_map.hpp"
#include "core/map/consistency/map_consistency.hpp"
#include "core/map/offset_map.hpp"
#include "core/results/consistency_json.hpp"

namespace sweepscope::app {
namespace {

struct MapArguments {
  RecordingOptions recording;
  double offset_ms = 0;
  std::string output, trajectory, poses, json;
  double voxel_m = 0;
  bool remove_outliers = false;
};

struct Built {
  OffsetMap map;
  std::int64_t epoch_ns = 0;
};

Result<Built> build(const MapArguments& options) {
  const Progress progress;
  const auto recording = options.recording.read(progress.job());
  if (!recording) return tl::unexpected(recording.error());
  MapOptions map_options;
  map_options.assume = options.recording.assumed_kind();
  if (!options.poses.empty()) {
    auto poses = read_tum(options.poses, recording->epoch_ns);
    if (!poses) return tl::unexpected(poses.error());
    map_options.poses = std::move(*poses);
  }
  warn_of_memory(*recording, 1, progress);
  const double offset_s = options.offset_ms * 1e-3;
  auto maps = build_maps(*recording, {&offset_s, 1}, map_options, progress.job());
  if (!maps) return tl::unexpected(maps.error());
  return Built{std::move(maps->front()), recording->epoch_ns};
}

std::string facts_json(const OffsetMap& map, const MapArguments& options) {
  return json_text({{"schema", "sweepscope.map/1"},
                    {"map", options.output},
                    {"offset_ms", options.offset_ms},
                    {"points", map.cloud->size()},
                    {"moving", map.moving},
                    {"lost", map.lost},
                    {"map_consistency", consistency_json(map.consistency.get())}});
}

ExitCode run(const MapArguments& options) {
  const auto threads = options.recording.limit_threads();
  std::vector<std::filesystem::path> inputs = options.recording.input_files();
  if (!options.poses.empty()) inputs.emplace_back(options.poses);
  const auto checked = check_outputs({options.output, options.trajectory, options.json}, std::move(inputs));
  if (!checked) return fail(checked.error());
  auto built = build(options);
  if (!built) return fail(built.error());
  OffsetMap* map = &built->map;
  if (options.remove_outliers) map->cloud = without_outliers(map->cloud);
  if (options.voxel_m > 0) map->cloud = thinned(map->cloud, options.voxel_m);
  if (!map->warning.empty()) say("warning: {}\n", map->warning);
  if (map->lost) say("warning: the motion could not be followed at this offset: do not trust the map\n");
  if (const auto written = write_cloud(options.output, *map->cloud); !written) return fail(written.error());
  if (!options.trajectory.empty()) {
    const auto written = write_tum(options.trajectory, map->trajectory, built->epoch_ns);
    if (!written) return fail(written.error());
  }
  if (!options.json.empty()) {
    const auto written = write_text(options.json, facts_json(*map, options));
    if (!written) return fail(written.error());
  }
  if (options.json == "-") return ExitCode::kDone;
  print("{}: {} points of a {} rig at t_motor = t_laser + {:.3f} ms\n", options.output, map->cloud->size(),
        map->moving ? "moving" : "stationary", options.offset_ms);
  if (map->consistency) print("{}\n", in_words(*map->consistency));
  return ExitCode::kDone;
}

}  // namespace

void add_map(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command = app.add_subcommand("map", "Write the map at an offset, as PCD or PLY");
  auto options = std::make_shared<MapArguments>();
  options->recording.declare(*command);
  options->recording.declare_computing(*command);
  command->add_option("--offset-ms", options->offset_ms, "t_motor = t_laser + offset")
      ->required()
      ->check(finite_number());
  command
      ->add_option("-o,--output", options->output,
                   "OUT.pcd or OUT.ply: x y z (m), intensity, time (s), sweep")
      ->required()
      ->check([](const std::string& path) {
        return path.ends_with(".pcd") || path.ends_with(".ply") ? std::string()
                                                                : path + ": a map is written as .pcd or .ply";
      });
  command->add_option("--trajectory", options->trajectory, "Write the trajectory, as TUM")->type_name("F");
  command
      ->add_option("--poses", options->poses,
                   "Trajectory of the rig (TUM), used instead of solving for it; the map is in its frame")
      ->type_name("F");
  command
      ->add_option("--json", options->json, "Write whether the map agrees with itself, as JSON; - is stdout")
      ->type_name("F|-");
  command->add_option("--voxel-m", options->voxel_m, "Keep one point per cube of this size (default: all)")
      ->check(finite_number())
      ->check(CLI::PositiveNumber);
  command->add_flag("--remove-outliers", options->remove_outliers, "Remove outliers");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace sweepscope::app
