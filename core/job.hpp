#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string_view>

namespace sweepscope {

/// Cancels a job at its n-th look at cancelled(), and at every later one. A test that interrupts work needs
/// each moment at which the work looks; a clock hits only some of them.
class LookCount {
 public:
  explicit LookCount(std::uint64_t cancel_at) : cancel_at_(cancel_at) {}
  bool cancels() { return ++looks_ >= cancel_at_; }
  std::uint64_t looks() const { return looks_; }

 private:
  std::atomic<std::uint64_t> looks_{0};
  std::uint64_t cancel_at_;
};

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
  /// True once the work is to stop, and from then on always. Cancelled work returns an Error with
  /// ExitCode::kInterrupted or, where it returns a plain value, an unfinished one: look here before you use
  /// it.
  bool cancelled() const {
    return cancelled_ || (stop_ != nullptr && *stop_) || (whole_ != nullptr && whole_->cancelled()) ||
           (looks_ != nullptr && looks_->cancels());
  }
  /// A further flag that cancels this job, for example one that a signal handler sets. Must outlive the job.
  void obey(const std::atomic<bool>& stop) { stop_ = &stop; }
  /// Likewise. The looks of the parts of a job count as its own.
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
