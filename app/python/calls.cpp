#include "app/python/calls.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <chrono>
#include <exception>
#include <future>
#include <mutex>
#include <new>

#include "app/threads.hpp"

namespace sweepscope::python {
namespace {

// How soon a signal is seen: well under what a person notices, and nothing beside the work.
constexpr std::chrono::milliseconds kBetweenLooks{20};

/// What the engine reported last.
class LatestReport {
 public:
  void set(std::string_view phase, double fraction) {
    const std::lock_guard lock(mutex_);
    latest_ = {std::string(phase), fraction};
  }
  std::optional<std::pair<std::string, double>> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(latest_, std::nullopt);
  }

 private:
  std::mutex mutex_;
  std::optional<std::pair<std::string, double>> latest_;
};

/// What a signal's handler or `progress` has raised: to be thrown once the work has stopped.
std::optional<py::error_already_set> raised_meanwhile(const Call& call, LatestReport& reports) {
  const auto report = reports.take();
  const py::gil_scoped_acquire acquired;
  if (PyErr_CheckSignals() != 0) return py::error_already_set();
  try {
    if (report) call.progress(report->first, report->second);
  } catch (py::error_already_set& raised) {
    return std::move(raised);
  }
  return std::nullopt;
}

void raise(const char* kind, const char* sentence) {
  const py::object type = py::module_::import("sweepscope._errors").attr(kind);
  PyErr_SetString(type.ptr(), sentence);
}

/// A sentence of wrong usage: options of the command line are named as Python's keywords.
void raise_wrong_usage(const char* sentence) {
  const py::object in_python = py::module_::import("sweepscope._errors").attr("in_python");
  const auto text = in_python(sentence).cast<std::string>();
  PyErr_SetString(PyExc_ValueError, text.c_str());
}

void raise_failure(const Failed& failed) {
  switch (failed.code) {
    case ExitCode::kUnreadableInput:
      return raise("InputError", failed.what());
    case ExitCode::kNotIdentifiable:
      return raise("CannotAnswer", failed.what());
    case ExitCode::kInterrupted:
      return PyErr_SetString(PyExc_KeyboardInterrupt, failed.what());
    default:
      return raise_wrong_usage(failed.what());
  }
}

}  // namespace

void register_errors() {
  // pybind11 requires a function that takes it by value.
  // NOLINTNEXTLINE(performance-unnecessary-value-param)
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Failed& failed) {
      raise_failure(failed);
    } catch (const std::length_error&) {
      PyErr_NoMemory();  // more than any memory could be asked for
    }
  });
}

void run(const Call& call, const std::function<void(const Job&)>& work) {
  LatestReport reports;
  Job job(call.progress.is_none() ? Job::Sink() : Job::Sink([&](std::string_view phase, double fraction) {
    reports.set(phase, fraction);
  }));
  std::optional<py::error_already_set> raised;
  {
    const py::gil_scoped_release released;
    std::future<void> done = std::async(std::launch::async, [&] {
      const auto limit = app::limit_threads(call.threads);
      work(job);
    });
    while (!raised && done.wait_for(kBetweenLooks) == std::future_status::timeout) {
      raised = raised_meanwhile(call, reports);
      if (raised) job.cancel();
    }
    done.wait();
    if (!raised) done.get();
  }
  if (raised) throw std::move(*raised);
}

std::optional<RigKind> rig_kind(const std::optional<std::string>& name) {
  if (!name) return std::nullopt;
  if (*name == "stationary") return RigKind::kStationary;
  if (*name == "moving") return RigKind::kMoving;
  throw py::value_error(fmt::format("assume takes stationary or moving, not {}", *name));
}

std::optional<StampSource> stamp_source(const std::optional<std::string>& name) {
  if (!name) return std::nullopt;
  if (*name == "header") return StampSource::kHeader;
  if (*name == "receive") return StampSource::kReceive;
  throw py::value_error(fmt::format("stamps takes header or receive, not {}", *name));
}

}  // namespace sweepscope::python
