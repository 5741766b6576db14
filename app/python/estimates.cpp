#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <limits>

#include "app/python/arrays.hpp"
#include "app/python/handles.hpp"
#include "core/io/trajectory_file.hpp"
#include "core/offset/estimate_options.hpp"
#include "core/offset/estimator.hpp"
#include "core/results/estimate_json.hpp"
#include "core/results/fields.hpp"
#include "core/together/estimate_together.hpp"

namespace sweepscope::python {

Found::Found(Estimate found) : estimate(std::move(found)) {
  constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
  columns.resize(kCurveColumns.size());
  for (const CurvePoint& point : estimate.curve) {
    offset_ms.push_back(written_ms(point.offset_s));
    for (std::size_t i = 0; i < columns.size(); ++i)
      columns[i].push_back((point.*kCurveColumns[i].value).value_or(kAbsent));
  }
}

namespace {

/// What is searched for, from the keywords of the declared options.
EstimateOptions search_of(const Texts& given) {
  EstimateOptions options;
  for (const auto& [name, text] : given) {
    const EstimateOption* option = find_estimate_option(name);
    if (option == nullptr) throw py::type_error("there is no option " + name);
    if (const auto done = option->set(options, text); !done)
      throw Failed(
          Error{ExitCode::kWrongUsage, fmt::format("--{} {}, and got {}", name, done.error().message, text)});
  }
  return options;
}

Result<std::optional<GivenPoses>> read_poses(const std::optional<Path>& poses, bool trusted,
                                             const Recording& recording) {
  if (!poses) return std::nullopt;
  auto trajectory = read_tum(*poses, recording.epoch_ns);
  if (!trajectory) return tl::unexpected(trajectory.error());
  return GivenPoses{poses->string(), std::move(*trajectory), trusted};
}

Result<Estimate> if_finished(Result<Estimate> found) {
  if (found && found->interrupted) return failure(ExitCode::kInterrupted, "interrupted");
  return found;
}

FoundPtr find(const OpenedPtr& opened, const Texts& given, const std::optional<std::string>& assume,
              const std::optional<Path>& poses, bool trust_poses, const Call& call) {
  EstimateOptions options = search_of(given);
  options.assume = rig_kind(assume);
  if (trust_poses && !poses) throw py::value_error("trust_poses needs poses");
  return std::make_shared<Found>(result_of(call, [&](const Job& job) -> Result<Estimate> {
    auto trajectory = read_poses(poses, trust_poses, opened->recording);
    if (!trajectory) return tl::unexpected(trajectory.error());
    options.poses = std::move(*trajectory);
    return if_finished(estimate(opened->recording, options, job));
  }));
}

FoundPtr find_together(const std::vector<OpenedPtr>& opened, bool own_offsets, const Texts& given,
                       const std::optional<std::string>& assume, const Call& call) {
  EstimateOptions options = search_of(given);
  options.assume = rig_kind(assume);
  std::vector<RecordingSource> recordings;
  for (const OpenedPtr& one : opened) recordings.emplace_back(one->recording);
  return std::make_shared<Found>(result_of(call, [&](const Job& job) {
    return if_finished(estimate_together(recordings, options, own_offsets, job));
  }));
}

py::dict curve(const FoundPtr& found) {
  py::dict columns;
  columns["offset_ms"] = whole(found->offset_ms, found);
  for (std::size_t i = 0; i < found->columns.size(); ++i)
    columns[kCurveColumns[i].key] = whole(found->columns[i], found);
  return columns;
}

py::list declared_options() {
  py::list options;
  for (const EstimateOption& option : estimate_options()) {
    py::dict one;
    one["name"] = option.name;
    one["type"] = option.type;
    one["help"] = option.help;
    one["choices"] = option.choices;
    one["repeats"] = option.repeats;
    one["value_optional"] = option.value_optional;
    options.append(one);
  }
  return options;
}

}  // namespace

void add_estimates(py::module_& module) {
  py::class_<Found, FoundPtr>(module, "Estimate")
      .def_property_readonly("identifiable", [](const Found& found) { return found.estimate.identifiable; })
      .def_property_readonly("reasons", [](const Found& found) { return found.estimate.reasons(); })
      .def("json", [](const Found& found) { return estimate_to_json(found.estimate); })
      .def("curve", &curve);
  module.def("read_estimate",
             [](const Path& path) { return std::make_shared<Found>(value_of(read_estimate_json(path))); });
  module.def("parse_estimate", [](const std::string& json, const std::string& name) {
    return std::make_shared<Found>(value_of(parse_estimate_json(json, name)));
  });
  module.def("estimate", &find);
  module.def("together", &find_together);
  module.def("estimate_options", &declared_options);
}

}  // namespace sweepscope::python
