#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/offset/estimate.hpp"
#include "core/recording/rig.hpp"

/// How Python calls the engine. Words of an option and their texts come as pairs, as on the command line.
namespace sweepscope::python {

namespace py = pybind11;
using Path = std::filesystem::path;
using Texts = std::vector<std::pair<std::string, std::string>>;

/// An expected failure on its way to Python, where `register_errors` makes it an exception of its kind.
struct Failed : std::runtime_error {
  explicit Failed(const Error& why) : std::runtime_error(why.message), code(why.code) {}
  ExitCode code;
};

/// Failures become sweepscope.InputError (3), sweepscope.CannotAnswer (4), KeyboardInterrupt (130) or
/// ValueError (2), with the program's sentence.
void register_errors();

/// The value, or the failure thrown.
template <typename T>
T value_of(Result<T>&& result) {
  if (!result) throw Failed(result.error());
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

/// How a function is called: the number of threads (0: all processors), and a callable that receives the
/// progress, progress(phase, fraction); None: no progress.
struct Call {
  std::size_t threads = 0;
  py::object progress = py::none();
};

/// Runs work of the engine on a thread of its own while other Python threads run on. Where a signal's handler
/// raises (Ctrl-C), or `progress` does, the job is cancelled, and once the work has stopped the exception is
/// thrown. What the work throws is thrown here.
void run(const Call& call, const std::function<void(const Job&)>& work);

/// The same for work that has a result.
template <typename Work>
auto result_of(const Call& call, const Work& work) {
  using Value = std::invoke_result_t<Work, const Job&>::value_type;
  std::optional<Value> value;
  run(call, [&](const Job& job) { value = value_of(work(job)); });
  return std::move(*value);
}

/// "stationary", "moving" or none; another word is a ValueError.
std::optional<RigKind> rig_kind(const std::optional<std::string>& name);
/// "header", "receive" or none; another word is a ValueError.
std::optional<StampSource> stamp_source(const std::optional<std::string>& name);

}  // namespace sweepscope::python
