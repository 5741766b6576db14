#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

namespace sweepscope::ui {

/// Who sees a session, and who of them drives it: the first who comes. Others may ask; the driver gives or
/// keeps, and one who does not answer within 15 s gives. When the driver leaves, who asked first drives, or
/// else who came first.
class Crew {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kMaxAnswer{15};

  void join(int viewer);
  void leave(int viewer);
  void ask(int viewer, Time now);
  /// The driver's answer to who asked first; nothing if it is not the driver's, or nobody asked.
  void give(int by);
  void keep(int by);
  /// Gives where the driver did not answer. Whether anything changed.
  bool expire(Time now);
  /// When expire has something to do.
  std::optional<Time> expires_at() const;

  /// Below 0: nobody is there.
  int driver() const { return driver_; }
  /// Who asked first; below 0: nobody.
  int asking() const { return asking_.empty() ? -1 : asking_.front().viewer; }
  std::size_t size() const { return viewers_.size(); }

 private:
  struct Asking {
    int viewer;
    Time since;
  };
  void hand_to(int viewer);

  std::vector<int> viewers_;  // as they came
  std::vector<Asking> asking_;
  int driver_ = -1;
};

}  // namespace sweepscope::ui
