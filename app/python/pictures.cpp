#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <mutex>

#include "app/python/handles.hpp"
#include "core/io/cloud_file.hpp"
#include "core/io/output_check.hpp"
#include "core/map/criteria_about.hpp"
#include "render/charts/curve_charts.hpp"
#include "render/comparison/comparison.hpp"
#include "render/comparison/comparison_json.hpp"
#include "render/comparison/look_options.hpp"
#include "render/figures/figures.hpp"
#include "render/images/image.hpp"
#include "render/pictures/canvas.hpp"
#include "render/vector/vector_file.hpp"

namespace sweepscope::python {
namespace {

/// OpenGL's entry points belong to the whole process: one picture is drawn at a time.
std::mutex& drawing() {
  static std::mutex mutex;
  return mutex;
}

ComparisonOptions look_of(const Texts& given) {
  ComparisonOptions options;
  for (const auto& [name, text] : given) {
    const LookOption* option = find_look_option(name);
    if (option == nullptr) throw py::type_error("there is no option " + name);
    value_of(set_look(options, *option, text));
  }
  value_of(check_size(options));
  return options;
}

/// The picture as PNG, and the facts of `compare --json`.
struct Drawn {
  std::string png, json;
};

Result<Drawn> draw(std::vector<ComparedMap>& maps, const Estimate* curve, const ComparisonOptions& look,
                   const std::optional<Path>& output, const Job& job) {
  for (ComparedMap& map : maps) {
    measure_thickness(map, job);
    if (job.cancelled()) return failure(ExitCode::kInterrupted, "interrupted");
  }
  auto picture = comparison_picture(maps, curve, look);
  if (!picture) return tl::unexpected(picture.error());
  const auto places = differing_places(maps, curve, look);
  if (!places) return tl::unexpected(places.error());
  const auto texts = comparison_texts(maps, look);
  const std::lock_guard lock(drawing());
  const auto canvas = make_canvas(Backend::kOffscreen);
  if (!canvas) return tl::unexpected(canvas.error());
  return (*canvas)->draw(*picture).and_then([&](const Image& image) -> Result<Drawn> {
    if (output)
      if (const auto written = write_picture(*output, *picture, texts, **canvas); !written)
        return tl::unexpected(written.error());
    return Drawn{encode_png(image, texts), comparison_json(maps, *places)};
  });
}

void check_output(const std::optional<Path>& output, const std::vector<Path>& inputs) {
  if (!output) return;
  value_of(check_picture_path(*output));
  value_of(check_run_files({inputs, {*output}, {}}));
}

py::tuple for_python(const Drawn& drawn) {
  return py::make_tuple(py::bytes(drawn.png), drawn.json);
}

/// What is drawn below the maps of a recording: a given estimate, the criteria about the offsets, or nothing.
struct Below {
  FoundPtr given;
  bool computed = false;
};

Result<Drawn> draw_recording(const Opened& opened, const std::vector<double>& offsets_ms,
                             const MapOptions& options, const Below& below, const ComparisonOptions& look,
                             const std::optional<Path>& output, const Job& job) {
  std::vector<double> offsets_s;
  for (const double offset_ms : offsets_ms) offsets_s.push_back(offset_ms * 1e-3);
  const auto prepared = prepare(opened.recording, options.features, job);
  if (!prepared) return tl::unexpected(prepared.error());
  const auto built = build_maps(*prepared, offsets_s, options, job);
  if (!built) return tl::unexpected(built.error());
  Result<Estimate> curve;
  if (below.computed) curve = criteria_about(*prepared, *built, {}, job);
  if (!curve) return tl::unexpected(curve.error());
  std::vector<ComparedMap> maps;
  const bool by_features = look.colour_by == ColourBy::kFeatures;
  for (const OffsetMap& map : *built)
    maps.push_back(compared_map(opened.recording, map, by_features ? prepared->features.get() : nullptr));
  const Estimate* const drawn = below.given ? &below.given->estimate : below.computed ? &*curve : nullptr;
  return draw(maps, drawn, look, output, job);
}

py::tuple compare_recording(const OpenedPtr& opened, const std::vector<double>& offsets_ms, const Texts& look,
                            const FoundPtr& curve, bool with_curve, const std::optional<std::string>& assume,
                            const std::optional<Path>& poses, const std::optional<Path>& output,
                            const Call& call) {
  const ComparisonOptions how = look_of(look);
  const auto kind = rig_kind(assume);
  value_of(check_offset_count(offsets_ms.size()));
  for (const double offset_ms : offsets_ms)
    if (!std::isfinite(offset_ms)) throw py::value_error("offsets_ms: not a finite number");
  std::vector<Path> inputs = opened->files;
  if (poses) inputs.push_back(*poses);
  check_output(output, inputs);
  const Below below{curve, with_curve && curve == nullptr};
  return for_python(result_of(call, [&](const Job& job) {
    return draw_recording(*opened, offsets_ms, map_options(opened->recording, kind, poses), below, how,
                          output, job);
  }));
}

/// A map for a comparison: one that was built, or a file.
struct MapInput {
  BuiltPtr built;
  Path file;
};

Result<ComparedMap> compared(const MapInput& input) {
  ComparedMap map;
  if (input.built) {
    map.offset_s = input.built->map.offset_s;
    map.cloud = input.built->map.cloud;
    map.path = input.built->map.trajectory;
    return map;
  }
  auto cloud = read_cloud(input.file);
  if (!cloud) return tl::unexpected(cloud.error());
  map.label = input.file.filename().string();
  map.cloud = *cloud;
  return map;
}

std::vector<MapInput> map_inputs(const py::list& given) {
  std::vector<MapInput> inputs;
  for (const py::handle& one : given) {
    if (py::isinstance<Built>(one))
      inputs.push_back({one.cast<BuiltPtr>(), {}});
    else
      inputs.push_back({nullptr, one.cast<Path>()});
  }
  if (inputs.size() < 2 || inputs.size() > 4)
    throw py::value_error("compare needs two to four maps, not " + std::to_string(inputs.size()));
  return inputs;
}

py::tuple compare_maps(const py::list& given, const Texts& look, const FoundPtr& curve,
                       const std::optional<Path>& output, const Call& call) {
  const ComparisonOptions how = look_of(look);
  const std::vector<MapInput> inputs = map_inputs(given);
  std::vector<Path> files;
  for (const MapInput& input : inputs)
    if (!input.built) files.push_back(input.file);
  check_output(output, files);
  return for_python(result_of(call, [&](const Job& job) -> Result<Drawn> {
    std::vector<ComparedMap> maps;
    for (const MapInput& input : inputs) {
      auto map = compared(input);
      if (!map) return tl::unexpected(map.error());
      maps.push_back(std::move(*map));
    }
    return draw(maps, curve ? &curve->estimate : nullptr, how, output, job);
  }));
}

std::vector<std::string> figures(const Recipe& recipe, const Path& folder, const Call& call) {
  const auto files = result_of(call, [&](const Job& job) -> Result<std::vector<Path>> {
    const std::lock_guard lock(drawing());
    const auto canvas = make_canvas(Backend::kOffscreen);
    if (!canvas) return tl::unexpected(canvas.error());
    return make_figures(recipe, folder, **canvas, job, [](const std::string&) {});
  });
  std::vector<std::string> names;
  for (const Path& file : files) names.push_back(file.string());
  return names;
}

}  // namespace

void add_pictures(py::module_& module) {
  module.def("compare_recording", &compare_recording);
  module.def("compare_maps", &compare_maps);
  module.def("figures", [](const Path& recipe, const Path& folder, const Call& call) {
    return figures(value_of(read_recipe(recipe)), folder, call);
  });
  module.def("figures_of_text", [](const std::string& recipe, const Path& folder, const Call& call) {
    return figures(value_of(parse_recipe(recipe, "recipe")), folder, call);
  });
  module.def("look_options", [] {
    py::list options;
    for (const LookOption& option : look_options()) {
      py::dict one;
      one["name"] = option.name;
      one["type"] = option.type;
      one["help"] = option.help;
      one["repeats"] = option.repeats;
      options.append(one);
    }
    return options;
  });
}

}  // namespace sweepscope::python
