#include "ui/serve/crew.hpp"

#include <algorithm>

namespace sweepscope::ui {

void Crew::join(int viewer) {
  viewers_.push_back(viewer);
  if (driver_ < 0) driver_ = viewer;
}

void Crew::leave(int viewer) {
  std::erase(viewers_, viewer);
  std::erase_if(asking_, [&](const Asking& asking) { return asking.viewer == viewer; });
  if (viewer != driver_) return;
  if (!asking_.empty())
    hand_to(asking_.front().viewer);
  else
    driver_ = viewers_.empty() ? -1 : viewers_.front();
}

void Crew::ask(int viewer, Time now) {
  const bool asks = std::any_of(asking_.begin(), asking_.end(),
                                [&](const Asking& asking) { return asking.viewer == viewer; });
  if (viewer != driver_ && !asks) asking_.push_back({viewer, now});
}

void Crew::give(int by) {
  if (by == driver_ && !asking_.empty()) hand_to(asking_.front().viewer);
}

void Crew::keep(int by) {
  if (by == driver_ && !asking_.empty()) asking_.erase(asking_.begin());
}

bool Crew::expire(Time now) {
  const auto at = expires_at();
  if (!at || now < *at) return false;
  hand_to(asking_.front().viewer);
  return true;
}

std::optional<Crew::Time> Crew::expires_at() const {
  if (asking_.empty()) return std::nullopt;
  return asking_.front().since + kMaxAnswer;
}

void Crew::hand_to(int viewer) {
  driver_ = viewer;
  std::erase_if(asking_, [&](const Asking& asking) { return asking.viewer == viewer; });
}

}  // namespace sweepscope::ui
