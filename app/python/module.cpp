#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include "app/python/calls.hpp"
#include "app/python/handles.hpp"
#include "core/io/atomic_file.hpp"

namespace sweepscope::python {
namespace {

/// Files that appear whole or not at all, with the program's sentences.
void add_files(py::module_& module) {
  module.def("read_text", [](const Path& path) { return value_of(read_file(path)); });
  module.def("write_text",
             [](const Path& path, const std::string& text) { value_of(write_file(path, text)); });
  module.def("write_bytes", [](const Path& path, const py::bytes& bytes) {
    value_of(write_file(path, std::string_view(bytes)));
  });
}

}  // namespace
}  // namespace sweepscope::python

/// The engine for sweepscope/__init__.py, which describes arguments and results. Private to it.
PYBIND11_MODULE(_engine, module) {
  using namespace sweepscope::python;
  module.attr("__version__") = SWEEPSCOPE_VERSION;
  register_errors();
  pybind11::class_<Call>(module, "Call")
      .def(pybind11::init([](std::size_t threads, const pybind11::object& progress) {
        return Call{threads, progress};
      }));
  add_files(module);
  add_recordings(module);
  add_estimates(module);
  add_maps(module);
  add_pictures(module);
  add_simulation(module);
  add_applying(module);
}
