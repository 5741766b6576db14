#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/estimate_options.hpp"
#include "app/look_texts.hpp"
#include "app/memory.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "core/io/cloud_file.hpp"
#include "core/io/trajectory_file.hpp"
#include "core/map/criteria_about.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "core/results/estimate_json.hpp"
#include "render/charts/curve_charts.hpp"
#include "render/comparison/comparison.hpp"
#include "render/comparison/comparison_json.hpp"
#include "render/vector/vector_file.hpp"

namespace sweepscope::app {
namespace {

struct CompareOptions {
  RecordingOptions recording;
  std::vector<std::string> inputs;  // a recording, or two to four maps
  std::string output, curve, json;
  std::vector<double> offsets_ms;
  double path_height_m = 0;
  std::string poses;
  bool no_curve = false;
  std::string draw_in = "offscreen";
  LookTexts look;
  std::vector<std::string> given;  // the options, as they were given
};

/// Beside the picture finished candidates are kept for a while.
std::string kept_candidates(const CompareOptions& options) {
  return options.output + ".candidates";
}

tl::unexpected<Error> wrong_usage(std::string message) {
  return failure(ExitCode::kWrongUsage, std::move(message));
}

bool is_map_file(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".pcd" || extension == ".ply";
}

Result<std::vector<ComparedMap>> maps_from_files(const CompareOptions& options) {
  const std::size_t count = options.inputs.size();
  if (count < 2 || count > 4)
    return wrong_usage(fmt::format("compare needs two to four maps, not {}", count));
  if (!options.offsets_ms.empty() && options.offsets_ms.size() != count) {
    return wrong_usage(
        fmt::format("--offsets-ms names {} offsets for {} maps", options.offsets_ms.size(), count));
  }
  std::vector<ComparedMap> maps;
  for (const std::string& path : options.inputs) {
    auto cloud = read_cloud(path);
    if (!cloud) return tl::unexpected(cloud.error());
    ComparedMap map;
    map.label = std::filesystem::path(path).filename().string();
    if (!options.offsets_ms.empty()) {
      map.offset_s = options.offsets_ms[maps.size()] / 1e3;
      map.label += fmt::format("  offset {} ms", offset_label_ms(*map.offset_s));
    }
    map.cloud = *cloud;
    map.path_height_m = options.path_height_m;
    maps.push_back(std::move(map));
  }
  return maps;
}

/// What a picture is drawn from.
struct Compared {
  std::vector<ComparedMap> maps;
  std::optional<Estimate> estimate;
  std::unique_ptr<CandidateFile> kept;  // the estimate's candidates, until the picture is there
};

Result<MapOptions> map_options(const CompareOptions& options, const Recording& recording) {
  MapOptions map_options;
  map_options.assume = options.recording.assumed_kind();
  if (options.poses.empty()) return map_options;
  auto poses = read_tum(options.poses, recording.epoch_ns);
  if (!poses) return tl::unexpected(poses.error());
  map_options.poses = std::move(*poses);
  return map_options;
}

Result<Compared> from_recording(const CompareOptions& options, bool by_features) {
  if (const auto counted = check_offset_count(options.offsets_ms.size()); !counted)
    return tl::unexpected(counted.error());
  const Progress progress;
  RecordingOptions reading = options.recording;
  reading.recording = options.inputs.front();
  const auto recording = reading.read(progress.job());
  if (!recording) return tl::unexpected(recording.error());
  std::vector<double> offsets_s;
  for (const double offset_ms : options.offsets_ms) offsets_s.push_back(offset_ms * 1e-3);
  const auto how = map_options(options, *recording);
  if (!how) return tl::unexpected(how.error());
  warn_of_memory(*recording, offsets_s.size(), progress);
  const auto prepared = prepare(*recording, how->features, progress.job());
  if (!prepared) return tl::unexpected(prepared.error());
  const auto maps = build_maps(*prepared, offsets_s, *how, progress.job());
  if (!maps) return tl::unexpected(maps.error());
  if (!maps->front().warning.empty()) progress.say("warning: " + maps->front().warning);
  Compared compared;
  if (options.curve.empty() && !options.no_curve) {
    auto kept = keep_while_working(kept_candidates(options), reading, options.given);
    if (!kept) return tl::unexpected(kept.error());
    compared.kept = std::move(*kept);
    auto curve = criteria_about(*prepared, *maps, {compared.kept.get(), {}}, progress.job());
    if (!curve) return tl::unexpected(ended(curve.error(), *compared.kept));
    compared.estimate = std::move(*curve);
  }
  for (const OffsetMap& map : *maps)
    compared.maps.push_back(compared_map(*recording, map, by_features ? prepared->features.get() : nullptr));
  return compared;
}

/// The maps that are compared, whatever they are made from.
Result<Compared> compared_maps(const CompareOptions& options, bool by_features) {
  std::size_t map_files = 0;
  for (const std::string& input : options.inputs) map_files += is_map_file(input) ? 1 : 0;
  if (map_files == options.inputs.size())
    return maps_from_files(options).map([](std::vector<ComparedMap> maps) {
      return Compared{std::move(maps), {}, {}};
    });
  if (map_files > 0 || options.inputs.size() > 1)
    return wrong_usage("compare takes one recording, or two to four maps (.pcd or .ply)");
  return from_recording(options, by_features);
}

Result<void> check_files(const CompareOptions& options) {
  std::vector<std::filesystem::path> inputs;
  for (const std::string& input : options.inputs)
    for (const auto& file : recording_files(input)) inputs.push_back(file);
  if (options.recording.rig) inputs.push_back(*options.recording.rig);
  for (const std::string& file : {options.curve, options.poses})
    if (!file.empty()) inputs.emplace_back(file);
  return check_outputs({options.output, kept_candidates(options), options.json}, std::move(inputs));
}

Result<void> measure(std::vector<ComparedMap>& maps) {
  const Progress progress;
  for (ComparedMap& map : maps) {
    measure_thickness(map, progress.job());
    if (progress.job().cancelled()) return failure(ExitCode::kInterrupted, "interrupted");
  }
  return {};
}

void say_thickness(const ComparedMap& map) {
  const std::string name =
      map.label.empty() ? fmt::format("offset {} ms", offset_label_ms(*map.offset_s)) : map.label;
  print("{}: {}\n", name, in_words(map));
}

/// With the JSON on stdout, it alone is there.
Result<void> write_facts(const Compared& compared, const CompareOptions& options,
                         const ComparisonOptions& picture) {
  if (options.json != "-")
    for (const ComparedMap& map : compared.maps) say_thickness(map);
  if (options.json != "-" && compared.maps.front().consistency)
    print("{}\n", in_words(*compared.maps.front().consistency));
  if (options.json.empty()) return {};
  const Estimate* curve = compared.estimate ? &*compared.estimate : nullptr;
  return differing_places(compared.maps, curve, picture)
      .and_then([&](const std::vector<DifferingPlace>& places) {
        return write_text(options.json, comparison_json(compared.maps, places));
      });
}

Result<void> compare(const CompareOptions& options) {
  // Wrong words cost nothing; they are found before files of hundreds of megabytes are read.
  const auto picture = options.look.parse();
  if (!picture) return tl::unexpected(picture.error());
  const auto writable =
      check_size(*picture).and_then([&] { return check_picture_path(options.output); }).and_then([&] {
        return check_files(options);
      });
  if (!writable) return tl::unexpected(writable.error());
  const auto canvas = backend(options.draw_in).and_then(make_canvas);
  if (!canvas) return tl::unexpected(canvas.error());
  std::optional<Estimate> given;
  if (!options.curve.empty()) {
    auto read = read_estimate_json(options.curve);
    if (!read) return tl::unexpected(read.error());
    given = std::move(*read);
  }
  auto compared = compared_maps(options, picture->colour_by == ColourBy::kFeatures);
  if (!compared) return tl::unexpected(compared.error());
  if (given) compared->estimate = std::move(given);
  if (const auto measured = measure(compared->maps); !measured) return tl::unexpected(measured.error());
  const Estimate* curve = compared->estimate ? &*compared->estimate : nullptr;
  return comparison_picture(compared->maps, curve, *picture)
      .and_then([&](const Picture& drawn) {
        return write_picture(options.output, drawn, comparison_texts(compared->maps, *picture), **canvas);
      })
      .and_then([&] {
        if (compared->kept) compared->kept->remove();
        return write_facts(*compared, options, *picture);
      });
}

void declare(CLI::App& command, CompareOptions& options) {
  options.recording.declare_reading(command);
  options.recording.declare_computing(command);
  command.add_option("INPUT", options.inputs, "A recording, or two to four maps (.pcd, .ply)")
      ->required()
      ->expected(-1);
  command.add_option("-o,--output", options.output, "The picture to write: .png, .svg or .pdf")->required();
  command
      .add_option("--json", options.json,
                  "Write the maps' thickness, and the places where they differ most, as JSON; - for stdout")
      ->type_name("F");
  command
      .add_option("--offsets-ms", options.offsets_ms,
                  "Offsets in milliseconds to map a recording at, such as 19,24; with maps: the offsets that "
                  "they were made at")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(finite_number());
  command.add_option("--curve", options.curve,
                     "An estimate (JSON) whose criteria are drawn below the maps (default with a recording: "
                     "computed in steps of 1 ms from 5 ms below the offsets to 5 ms above)");
  command.add_flag("--no-curve", options.no_curve, "Do not draw the criteria");
  command
      .add_option("--poses", options.poses,
                  "Trajectory of the rig (TUM), used instead of solving for it; the map is in its frame")
      ->type_name("F");
  command
      .add_option("--path-height-m", options.path_height_m,
                  "With maps: the sensor's height in the map frame, to which slabs refer")
      ->check(finite_number())
      ->capture_default_str();
  command.add_option("--draw-in", options.draw_in, "offscreen, or window to watch the picture being drawn")
      ->capture_default_str()
      ->check(CLI::IsMember({"offscreen", "window"}));
  options.look.declare(command);
}

}  // namespace

void add_compare(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command =
      app.add_subcommand("compare", "Draw maps side by side with the same camera, and the criteria below");
  auto options = std::make_shared<CompareOptions>();
  declare(*command, *options);
  command->callback([options, command, &exit_code] {
    options->given = deciding_options(*command);
    reuse_memory();
    const auto threads = options->recording.limit_threads();
    if (const auto done = compare(*options); !done) exit_code = fail(done.error());
  });
}

}  // namespace sweepscope::app
