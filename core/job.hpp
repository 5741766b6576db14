#pragma once

#include <atomic>
#include <functional>
#include <string_view>

namespace sweepscope {

/// What long work reports to and obeys. Every function that may take longer than a second takes one.
/// `report` may be called from any thread; the sink must be safe for that.
class Job {
 public:
  /// `phase` names the step in a word or two, `fraction` in [0, 1] is how much of that step is done.
  using Sink = std::function<void(std::string_view phase, double fraction)>;

  Job() = default;
  explicit Job(Sink sink) : sink_(std::move(sink)) {}
  /// A part of a job that reports nothing of its own and is cancelled with it. The whole must outlive the
  /// part.
  static Job part_of(const Job& whole) { return Job(&whole); }

  void report(std::string_view phase, double fraction) const {
    if (sink_) sink_(phase, fraction);
  }
  void cancel() { cancelled_ = true; }
  /// True once the work is to stop; the worker then returns an Error with ExitCode::kInterrupted.
  bool cancelled() const {
    return cancelled_ || (stop_ != nullptr && *stop_) || (whole_ != nullptr && whole_->cancelled());
  }
  /// A further flag that cancels this job, for example one that a signal handler sets. Must outlive the job.
  void obey(const std::atomic<bool>& stop) { stop_ = &stop; }

 private:
  explicit Job(const Job* whole) : whole_(whole) {}

  Sink sink_;
  std::atomic<bool> cancelled_{false};
  const std::atomic<bool>* stop_ = nullptr;
  const Job* whole_ = nullptr;
};

}  // namespace sweepscope
