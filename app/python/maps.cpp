#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>

#include "app/python/arrays.hpp"
#include "app/python/handles.hpp"
#include "core/io/cloud_file.hpp"
#include "core/io/output_check.hpp"
#include "core/io/trajectory_file.hpp"
#include "core/map/clean_map.hpp"

namespace sweepscope::python {

MapOptions map_options(const Recording& recording, const std::optional<RigKind>& assume,
                       const std::optional<Path>& poses) {
  MapOptions options;
  options.assume = assume;
  if (poses) options.poses = value_of(read_tum(*poses, recording.epoch_ns));
  return options;
}

namespace {

/// What is left out of a map.
struct Cleaning {
  double voxel_m = 0;  // 0: nothing
  bool remove_outliers = false;
};

Result<OffsetMap> build(const Recording& recording, double offset_s, const MapOptions& options,
                        const Cleaning& cleaning, const Job& job) {
  auto maps = build_maps(recording, {&offset_s, 1}, options, job);
  if (!maps) return tl::unexpected(maps.error());
  OffsetMap map = std::move(maps->front());
  if (cleaning.remove_outliers) map.cloud = without_outliers(map.cloud);
  if (cleaning.voxel_m > 0) map.cloud = thinned(map.cloud, cleaning.voxel_m);
  return map;
}

BuiltPtr map(const OpenedPtr& opened, double offset_ms, const std::optional<std::string>& assume,
             const std::optional<Path>& poses, const std::optional<double>& voxel_m, bool remove_outliers,
             const Call& call) {
  const auto kind = rig_kind(assume);
  if (!std::isfinite(offset_ms)) throw py::value_error("offset_ms is not a finite number");
  if (voxel_m && !(std::isfinite(*voxel_m) && *voxel_m > 0))
    throw py::value_error("voxel_m needs a number above 0");
  const Cleaning cleaning{voxel_m.value_or(0), remove_outliers};
  auto built = std::make_shared<Built>();
  built->epoch_ns = opened->recording.epoch_ns;
  built->files = opened->files;
  if (poses) built->files.push_back(*poses);
  built->map = result_of(call, [&](const Job& job) {
    return build(opened->recording, offset_ms * 1e-3, map_options(opened->recording, kind, poses), cleaning,
                 job);
  });
  return built;
}

void save(const BuiltPtr& built, const Path& path) {
  result_of(Call(), [&](const Job&) {
    return check_run_files({built->files, {path}, {}})
        .and_then([&] { return write_cloud(path, *built->map.cloud); })
        .map([] { return true; });
  });
}

void save_trajectory(const BuiltPtr& built, const Path& path) {
  value_of(check_run_files({built->files, {path}, {}}).and_then([&] {
    return write_tum(path, built->map.trajectory, built->epoch_ns);
  }));
}

template <typename Scalar>
using Numbers = py::array_t<Scalar, py::array::c_style | py::array::forcecast>;

/// A map of the arrays that the properties below give; its files are not known any more.
BuiltPtr rebuilt(const Numbers<float>& xyz_m, const Numbers<float>& intensity, const Numbers<double>& time_s,
                 const Numbers<std::uint32_t>& sweep, const py::dict& path) {
  auto built = std::make_shared<Built>();
  built->epoch_ns = path["epoch_ns"].cast<std::int64_t>();
  built->map.moving = path["moving"].cast<bool>();
  built->map.lost = path["lost"].cast<bool>();
  auto cloud = std::make_shared<MapCloud>();
  for (py::ssize_t i = 0; i < xyz_m.shape(0); ++i) {
    MapPoint point;
    point.x = xyz_m.at(i, 0), point.y = xyz_m.at(i, 1), point.z = xyz_m.at(i, 2);
    point.intensity = intensity.at(i);
    point.time_s = time_s.at(i);
    point.sweep = sweep.at(i);
    cloud->push_back(point);
  }
  built->map.cloud = std::move(cloud);
  const auto times = path["pose_time_s"].cast<Numbers<double>>(),
             at = path["position_m"].cast<Numbers<double>>(),
             turned = path["orientation_xyzw"].cast<Numbers<double>>();
  for (py::ssize_t i = 0; i < times.shape(0); ++i)
    built->map.trajectory.push_back(
        {times.at(i),
         {at.at(i, 0), at.at(i, 1), at.at(i, 2)},
         Eigen::Quaterniond(turned.at(i, 3), turned.at(i, 0), turned.at(i, 1), turned.at(i, 2))});
  return built;
}

template <typename Scalar, typename Member>
auto points(const Member& first_of, py::ssize_t count = 1) {
  return [first_of, count](const BuiltPtr& built) {
    return column<Scalar>(built->map.cloud->points, first_of, built, count);
  };
}

template <typename Member>
auto poses(const Member& first_of, py::ssize_t count = 1) {
  return [first_of, count](const BuiltPtr& built) {
    return column<double>(built->map.trajectory, first_of, built, count);
  };
}

}  // namespace

void add_maps(py::module_& module) {
  py::class_<Built, BuiltPtr>(module, "Map")
      .def_property_readonly("moving", [](const Built& built) { return built.map.moving; })
      .def_property_readonly("lost", [](const Built& built) { return built.map.lost; })
      .def_property_readonly("warning", [](const Built& built) { return built.map.warning; })
      .def_property_readonly("epoch_ns", [](const Built& built) { return built.epoch_ns; })
      .def_property_readonly("xyz_m", points<float>([](const MapPoint& point) { return &point.x; }, 3))
      .def_property_readonly("intensity",
                             points<float>([](const MapPoint& point) { return &point.intensity; }))
      .def_property_readonly("time_s", points<double>([](const MapPoint& point) { return &point.time_s; }))
      .def_property_readonly("sweep",
                             points<std::uint32_t>([](const MapPoint& point) { return &point.sweep; }))
      .def_property_readonly("pose_time_s", poses([](const StampedPose& pose) { return &pose.time_s; }))
      .def_property_readonly("position_m",
                             poses([](const StampedPose& pose) { return pose.position_m.data(); }, 3))
      .def_property_readonly(
          "orientation_xyzw",
          poses([](const StampedPose& pose) { return pose.orientation.coeffs().data(); }, 4))
      .def("save", &save)
      .def("save_trajectory", &save_trajectory);
  module.def("map", &map);
  module.def("rebuilt_map", &rebuilt);
}

}  // namespace sweepscope::python
