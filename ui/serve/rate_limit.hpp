#pragma once

#include <algorithm>
#include <chrono>

namespace sweepscope::ui {

/// Allows `per_second` on average, and `burst` at once. The time is given, so that equal calls give equal
/// answers.
class RateLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;
  RateLimit(double per_second, double burst, Time now)
      : per_second_(per_second), burst_(burst), left_(burst), at_(now) {}

  /// Whether so much is still allowed; it is counted only then.
  bool take(double amount, Time now) {
    fill(now);
    if (left_ < amount) return false;
    left_ -= amount;
    return true;
  }
  /// Counts so much, which may leave a debt.
  void spend(double amount, Time now) {
    fill(now);
    left_ -= amount;
  }
  /// When no debt is left.
  Time free_at(Time now) {
    fill(now);
    if (left_ >= 0) return now;
    return now +
           std::chrono::duration_cast<Time::duration>(std::chrono::duration<double>(-left_ / per_second_));
  }

 private:
  void fill(Time now) {
    const double seconds = std::chrono::duration<double>(std::max(now, at_) - at_).count();
    left_ = std::min(burst_, left_ + per_second_ * seconds);
    at_ = std::max(now, at_);
  }

  double per_second_, burst_, left_;
  Time at_;
};

}  // namespace sweepscope::ui
