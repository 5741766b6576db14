#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>

#include "app/python/arrays.hpp"
#include "app/python/handles.hpp"
#include "core/offset/readings/fitting_recording.hpp"
#include "core/offset/summary.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "core/recording/time_window.hpp"
#include "core/results/info_json.hpp"

namespace sweepscope::python {
namespace {

/// What to read, from keywords.
struct Reading {
  Path path;
  std::optional<Path> rig;
  std::optional<std::string> stamps;
  std::optional<TimeWindow> window;
  std::optional<std::string> laser, motor, joint;
};

Result<Opened> read(const Reading& reading, const std::optional<StampSource>& stamps, const Job& job) {
  Opened opened;
  opened.path = reading.path;
  opened.stamps = stamps;
  opened.files = recording_files(reading.path);
  if (reading.rig) {
    auto rig = read_rig(*reading.rig);
    if (!rig) return tl::unexpected(rig.error());
    opened.rig = std::move(*rig);
    opened.files.push_back(*reading.rig);
  }
  if (reading.laser) opened.rig.laser.topic = reading.laser;
  if (reading.motor) opened.rig.motor.topic = reading.motor;
  if (reading.joint) opened.rig.motor.joint = reading.joint;
  return read_fitting(reading.path, {opened.rig, stamps}, job, reading.window).map([&](Recording&& read) {
    opened.recording = std::move(read);
    return std::move(opened);
  });
}

std::optional<TimeWindow> time_window(const std::optional<std::pair<double, double>>& window_s) {
  if (!window_s) return std::nullopt;
  const auto [from_s, to_s] = *window_s;
  if (!std::isfinite(from_s) || !std::isfinite(to_s) || from_s >= to_s)
    throw py::value_error(
        fmt::format("window_s needs (A, B) in seconds with A less than B, not ({:g}, {:g})", from_s, to_s));
  return TimeWindow{from_s, to_s};
}

OpenedPtr open(const Reading& reading, const Call& call) {
  const auto stamps = stamp_source(reading.stamps);
  return std::make_shared<Opened>(
      result_of(call, [&](const Job& job) { return read(reading, stamps, job); }));
}

std::string info(const OpenedPtr& opened, const Call& call) {
  return info_to_json(result_of(call, [&](const Job& job) { return summarise(opened->recording, job); }));
}

}  // namespace

void add_recordings(py::module_& module) {
  py::class_<Opened, OpenedPtr>(module, "Recording")
      .def_property_readonly("path", [](const Opened& opened) { return opened.path.string(); })
      .def_property_readonly("name", [](const Opened& opened) { return opened.recording.name; })
      .def_property_readonly("epoch_ns", [](const Opened& opened) { return opened.recording.epoch_ns; })
      .def_property_readonly("scans", [](const Opened& opened) { return opened.recording.scans.size(); })
      .def_property_readonly("warnings",
                             [](const Opened& opened) { return opened.recording.report.warnings; })
      .def_property_readonly(
          "motor_time_s",
          [](const OpenedPtr& opened) { return whole(opened->recording.motor.time_s, opened); })
      .def_property_readonly(
          "motor_angle_rad",
          [](const OpenedPtr& opened) { return whole(opened->recording.motor.angle_rad, opened); })
      .def_property_readonly("scan_time_s",
                             [](const OpenedPtr& opened) {
                               return column<double>(
                                   opened->recording.scans,
                                   [](const LaserScan& scan) { return &scan.first_beam_s; }, opened);
                             })
      .def_property_readonly(
          "ranges_m", [](const OpenedPtr& opened) { return whole(opened->recording.ranges_m, opened); });
  module.def(
      "open",
      [](const Path& path, const std::optional<Path>& rig, const std::optional<std::string>& stamps,
         const std::optional<std::pair<double, double>>& window_s, const std::optional<std::string>& laser,
         const std::optional<std::string>& motor, const std::optional<std::string>& joint, const Call& call) {
        return open({path, rig, stamps, time_window(window_s), laser, motor, joint}, call);
      });
  module.def("info", &info);
}

}  // namespace sweepscope::python
