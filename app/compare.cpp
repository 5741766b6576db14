#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/offset_texts.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "core/io/cloud_file.hpp"
#include "core/io/estimate_json.hpp"
#include "core/map/offset_map.hpp"
#include "render/comparison.hpp"
#include "render/curve_charts.hpp"

namespace sweepscope::app {
namespace {

struct CompareOptions {
  RecordingOptions recording;
  std::vector<std::string> inputs;  // a recording, or two to four maps
  std::string output, curve, size = "1920x1200", close_up;
  std::vector<double> offsets_ms;
  std::vector<std::string> slabs;
  double path_height_m = 0;
  ComparisonOptions picture;
};

/// The numbers of a text such as "1920x1200", or nothing where it is not exactly that many.
std::optional<std::vector<double>> numbers_between(const std::string& text, char separator,
                                                   std::size_t count) {
  std::vector<double> numbers;
  const char *at = text.data(), *end = text.data() + text.size();
  while (numbers.size() < count) {
    double number = 0;
    const auto [after, error] = std::from_chars(at, end, number);
    const bool last = numbers.size() + 1 == count;
    if (error != std::errc() || (last ? after != end : after == end || *after != separator))
      return std::nullopt;
    numbers.push_back(number);
    at = after + (last ? 0 : 1);
  }
  return numbers;
}

tl::unexpected<Error> wrong_usage(std::string message) {
  return failure(ExitCode::kWrongUsage, std::move(message));
}

Result<ComparisonOptions> picture_options(const CompareOptions& options) {
  ComparisonOptions picture = options.picture;
  const auto size = numbers_between(options.size, 'x', 2);
  if (!size || (*size)[0] < 0 || (*size)[1] < 0 || (*size)[0] > 1e6 || (*size)[1] > 1e6) {
    return wrong_usage(fmt::format("--size {}: not like 1920x1200", options.size));
  }
  picture.width_px = static_cast<int>((*size)[0]);
  picture.height_px = static_cast<int>((*size)[1]);
  for (const std::string& text : options.slabs) {
    const auto range = numbers_between(text, ':', 2);
    if (!range || !((*range)[0] < (*range)[1])) {
      return wrong_usage(fmt::format("--slab {}: not like 0.8:3.2, in metres above the sensor's path", text));
    }
    picture.slabs.push_back({(*range)[0], (*range)[1]});
  }
  if (!options.close_up.empty()) {
    const auto region = numbers_between(options.close_up, ':', 3);
    if (!region || !((*region)[2] > 0)) {
      return wrong_usage(
          fmt::format("--close-up {}: not like 12.5:-3:4, x, y and height in metres", options.close_up));
    }
    picture.close_up = Region{{(*region)[0], (*region)[1]}, (*region)[2]};
  }
  return picture;
}

bool is_map_file(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".pcd" || extension == ".ply";
}

Result<std::vector<ComparedMap>> maps_from_files(const CompareOptions& options) {
  const std::size_t count = options.inputs.size();
  if (count < 2 || count > 4) return wrong_usage(fmt::format("Two to four maps are compared, not {}", count));
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
};

Result<Estimate> curve_about(const Recording& recording, const CompareOptions& options, const Job& job) {
  const auto [least, greatest] = std::minmax_element(options.offsets_ms.begin(), options.offsets_ms.end());
  EstimateOptions wanted;
  wanted.assume = parse_method(options.recording.assume);
  wanted.ranges = {{(*least - 5) * 1e-3, (*greatest + 5) * 1e-3, 1e-3}};
  return estimate(recording, wanted, job);
}

Result<Compared> from_recording(const CompareOptions& options) {
  if (options.offsets_ms.size() < 2 || options.offsets_ms.size() > 4)
    return wrong_usage("compare of a recording wants two to four offsets, such as --offsets-ms 19,24");
  const Progress progress;
  RecordingOptions reading = options.recording;
  reading.recording = options.inputs.front();
  const auto recording = reading.read(progress.job());
  if (!recording) return tl::unexpected(recording.error());
  std::vector<double> offsets_s;
  for (const double offset_ms : options.offsets_ms) offsets_s.push_back(offset_ms * 1e-3);
  MapOptions map_options;
  map_options.assume = parse_method(options.recording.assume);
  auto built = build_maps(*recording, offsets_s, map_options, progress.job());
  if (!built) return tl::unexpected(built.error());
  Compared compared;
  for (OffsetMap& map : *built) {
    ComparedMap& next = compared.maps.emplace_back();
    next.offset_s = map.offset_s;
    next.cloud = map.cloud;
    next.path = std::move(map.trajectory);
  }
  if (!options.curve.empty()) return compared;
  auto curve = curve_about(*recording, options, progress.job());
  if (!curve) return tl::unexpected(curve.error());
  if (curve->interrupted) return failure(ExitCode::kInterrupted, "Interrupted while computing the criteria.");
  compared.estimate = std::move(*curve);
  return compared;
}

/// The maps that are compared, whatever they are made from.
Result<Compared> compared_maps(const CompareOptions& options) {
  std::size_t map_files = 0;
  for (const std::string& input : options.inputs) map_files += is_map_file(input) ? 1 : 0;
  if (map_files == options.inputs.size())
    return maps_from_files(options).map([](std::vector<ComparedMap> maps) {
      return Compared{std::move(maps), {}};
    });
  if (map_files > 0 || options.inputs.size() > 1)
    return wrong_usage("compare takes one recording, or two to four maps (.pcd or .ply)");
  return from_recording(options);
}

Result<void> compare(const CompareOptions& options) {
  // Wrong words cost nothing; they are found before files of hundreds of megabytes are read.
  const auto picture = picture_options(options);
  if (!picture) return tl::unexpected(picture.error());
  std::optional<Estimate> given;
  if (!options.curve.empty()) {
    auto read = read_estimate_json(options.curve);
    if (!read) return tl::unexpected(read.error());
    given = std::move(*read);
  }
  auto compared = compared_maps(options);
  if (!compared) return tl::unexpected(compared.error());
  if (given) compared->estimate = std::move(given);
  const Estimate* curve = compared->estimate ? &*compared->estimate : nullptr;
  return comparison_picture(compared->maps, curve, *picture).and_then(draw).and_then([&](const Image& image) {
    return write_png(image, options.output, comparison_texts(compared->maps, *picture));
  });
}

void declare(CLI::App& command, CompareOptions& options) {
  options.recording.declare_reading(command);
  options.recording.declare_computing(command);
  command.add_option("INPUT", options.inputs, "A recording, or two to four maps (.pcd, .ply)")
      ->required()
      ->expected(-1);
  command.add_option("-o,--output", options.output, "The picture to write (PNG)")->required();
  command
      .add_option("--offsets-ms", options.offsets_ms,
                  "The offsets to map a recording at in milliseconds, such as 19,24; with maps: those that "
                  "they were made at")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_option("--curve", options.curve,
                     "An estimate (JSON) whose criteria are drawn below the maps; default with a recording: "
                     "computed by 1 ms from 5 ms below the offsets to 5 ms above");
  command.add_option("--size", options.size, "Of the picture, in pixels")->capture_default_str();
  command.add_option("--colour-table", options.picture.colour_table, "viridis, cividis, turbo or grey")
      ->capture_default_str();
  command.add_option("--title", options.picture.title, "Above the maps; default: the estimate's recording");
  command.add_option(
      "--slab", options.slabs,
      "FROM:TO in metres above the sensor's path: show these heights; repeatable. Default: 0.8 m and "
      "more below it, and from 0.8 m above it to just under the ceiling");
  command.add_option(
      "--close-up", options.close_up,
      "X:Y:HEIGHT in metres of the map frame: what the close-ups show. Default: where the maps "
      "differ most in sharpness");
  command
      .add_option("--path-height-m", options.path_height_m,
                  "With maps: the sensor's height in the map frame, which slabs refer to")
      ->capture_default_str();
}

}  // namespace

void add_compare(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command = app.add_subcommand("compare", "Maps side by side, seen alike, with the criteria below");
  auto options = std::make_shared<CompareOptions>();
  declare(*command, *options);
  command->callback([options, &exit_code] {
    const auto threads = options->recording.limit_threads();
    if (const auto done = compare(*options); !done) exit_code = fail(done.error());
  });
}

}  // namespace sweepscope::app
