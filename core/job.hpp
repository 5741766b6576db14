#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string_view>

namespace sweepscope {

/// Cancels a job at its n-th call of cancelled() and at every later one. Tests that interrupt work need every
/// moment at which the work checks; a clock hits only some of them.
class LookCount {
 public:
  /// Counts from 1: 1 cancels at once.
  explicit LookCount(std::uint64_t cancel_at) : cancel_at_(cancel_at) {}
  /// Counts a call, and tells whether it is cancelled.
  bool cancels() { return ++looks_ >= cancel_at_; }
  /// The calls so far.
  std::uint64_t looks() const { return looks_; }

 private:
  std::atomic<std::uint64_t> looks_{0};
  std::uint64_t cancel_at_;
};

/// Progress and cancellation of long work. Every function that may take longer than a second takes one.
/// `report` may be called from any thread, so the sink must be thread-safe.
class Job {
 public:
  /// `phase` names the step in a word or two; `fraction` in [0, 1] is the part of it that is done.
  using Sink = std::function<void(std::string_view phase, double fraction)>;

  Job() = default;
  /// A job that reports its progress to `sink`.
  explicit Job(Sink sink) : sink_(std::move(sink)) {}
  /// A part of a job: it reports nothing and is cancelled together with the job, which must outlive it.
  static Job part_of(const Job& whole) { return Job(&whole); }

  /// Reports progress, see Sink.
  void report(std::string_view phase, double fraction) const {
    if (sink_) sink_(phase, fraction);
  }
  /// From any thread.
  void cancel() { cancelled_ = true; }
  /// True from the moment at which the work has to stop. Cancelled work returns an Error with
  /// ExitCode::kInterrupted or, where it returns a plain value, an unfinished one: check cancelled() before
  /// you use it.
  bool cancelled() const {
    return cancelled_ || (stop_ != nullptr && *stop_) || (whole_ != nullptr && whole_->cancelled()) ||
           (looks_ != nullptr && looks_->cancels());
  }
  /// A further flag that cancels this job, for example one that a signal handler sets. Must outlive the job.
  void obey(const std::atomic<bool>& stop) { stop_ = &stop; }
  /// Also cancels this job. Checks by the parts of a job count as its own.
  void obey(LookCount& looks) { looks_ = &looks; }

 private:
  explicit Job(const Job* whole) : whole_(whole) {}

  Sink sink_;
  std::atomic<bool> cancelled_{false};
  const std::atomic<bool>* stop_ = nullptr;
  const Job* whole_ = nullptr;
  LookCount* looks_ = nullptr;
};

}  // namespace sweepscope
