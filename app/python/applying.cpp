#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "app/python/handles.hpp"
#include "core/apply/apply.hpp"
#include "core/apply/apply_files.hpp"
#include "core/apply/sweep_folder.hpp"
#include "core/io/atomic_file.hpp"

namespace sweepscope::python {
namespace {

/// What to write, from keywords: at least one of the outputs.
struct Outputs {
  Path recording;              // empty: none
  std::optional<Path> sweeps;  // a folder
  std::string extension;       // of the sweeps
};

using NamedText = std::pair<std::string, std::string>;

AppliedOffset offset_of(const std::optional<NamedText>& estimate, const std::optional<double>& offset_ms) {
  if (estimate)
    return value_of(
        parse_applied_offset(estimate->second, estimate->first.empty() ? "the estimate" : estimate->first));
  AppliedOffset offset;
  offset.offset_s = offset_ms.value() * 1e-3;
  return offset;
}

py::tuple apply(const Path& recording, const Outputs& outputs, const ApplyOptions& options,
                const Call& call) {
  std::optional<WrittenSweeps> sweeps;
  std::optional<Applied> applied;
  run(call, [&](const Job& job) {
    if (outputs.sweeps)
      sweeps = value_of(write_applied_sweeps(recording, options, *outputs.sweeps, outputs.extension, job));
    if (!outputs.recording.empty())
      applied = value_of(apply_offset(recording, outputs.recording, options, job));
  });
  std::vector<std::string> warnings;
  if (sweeps) warnings = sweeps->warnings;
  if (applied) warnings.insert(warnings.end(), applied->warnings.begin(), applied->warnings.end());
  py::object record = py::none(), moved = py::none(), written = py::none();
  if (applied) record = py::cast(to_json(applied->provenance));
  if (applied) moved = py::cast(applied->moved);
  if (sweeps) written = py::cast(sweeps->sweeps);
  return py::make_tuple(record, moved, written, warnings);
}

ApplyOptions options_of(const py::dict& given) {
  const auto has = [&](const char* key) { return given.contains(key) && !given[key].is_none(); };
  const auto text = [&](const char* key) { return given[key].cast<std::string>(); };
  ApplyOptions options;
  options.shifted = text("shift") == "laser" ? ShiftedStream::kLaser : ShiftedStream::kMotor;
  options.again = given["again"].cast<bool>();
  options.far = given["far"].cast<bool>();
  if (has("stamps")) options.stamps = stamp_source(text("stamps"));
  if (has("rig")) options.rig = value_of(read_rig(given["rig"].cast<Path>()));
  if (has("clouds")) options.add.clouds_topic = text("clouds");
  options.add.transforms = given["tf"].cast<bool>();
  options.add.base_frame = text("base_frame");
  if (has("poses")) options.add.poses = given["poses"].cast<Path>();
  if (has("assume")) options.add.map.assume = rig_kind(text("assume"));
  return options;
}

/// `estimate`: the name of its file ("" where there is none) and its JSON. `keywords`: those of
/// sweepscope.apply. An opened recording brings its rig and stamps along.
py::tuple apply_to(const Path& recording, const OpenedPtr& opened, const Path& output,
                   const std::optional<NamedText>& estimate, const std::optional<double>& offset_ms,
                   const py::dict& keywords, const Call& call) {
  ApplyOptions options = options_of(keywords);
  if (opened && keywords["rig"].is_none()) options.rig = opened->rig;
  if (opened && !options.stamps) options.stamps = opened->stamps;
  options.offset = offset_of(estimate, offset_ms);
  if (estimate) options.estimate = Path(estimate->first).filename().string();
  Outputs outputs{output, {}, "." + keywords["clouds_format"].cast<std::string>()};
  std::vector<Path> inputs;
  for (const char* key : {"rig", "poses"})
    if (!keywords[key].is_none()) inputs.push_back(keywords[key].cast<Path>());
  if (estimate && !estimate->first.empty()) inputs.emplace_back(estimate->first);
  if (!keywords["clouds_only"].is_none()) outputs.sweeps = keywords["clouds_only"].cast<Path>();
  value_of(check_apply_files(recording, output, outputs.sweeps, std::move(inputs)));
  return apply(recording, outputs, options, call);
}

}  // namespace

void add_applying(py::module_& module) {
  module.def("apply", &apply_to);
}

}  // namespace sweepscope::python
