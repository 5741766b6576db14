#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/python/calls.hpp"
#include "core/map/offset_map.hpp"
#include "core/offset/estimate.hpp"
#include "core/recording/recording.hpp"

/// What Python holds of the engine, and the parts of the module.
namespace sweepscope::python {

/// A recording as it was opened, with the file that it came from.
struct Opened {
  Recording recording;
  Path path;
  Rig rig;  // as given, for work that reads the file again
  std::optional<StampSource> stamps;
  std::vector<Path> files;  // that were read: not to be overwritten
};

/// An estimate, and its curve as columns: NaN where a value is absent.
struct Found {
  explicit Found(Estimate found);

  Estimate estimate;
  std::vector<double> offset_ms;
  std::vector<std::vector<double>> columns;  // by kCurveColumns
};

struct Built {
  OffsetMap map;
  std::int64_t epoch_ns = 0;
  std::vector<Path> files;
};

/// Objects whose memory arrays view are shared with these.
using OpenedPtr = std::shared_ptr<Opened>;
using FoundPtr = std::shared_ptr<Found>;
using BuiltPtr = std::shared_ptr<Built>;

/// The map options of keywords: an assumed kind, and a file of poses.
MapOptions map_options(const Recording& recording, const std::optional<RigKind>& assume,
                       const std::optional<Path>& poses);

void add_recordings(py::module_& module);
void add_estimates(py::module_& module);
void add_maps(py::module_& module);
void add_pictures(py::module_& module);
void add_simulation(py::module_& module);
void add_applying(py::module_& module);

}  // namespace sweepscope::python
