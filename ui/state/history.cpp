#include "ui/state/history.hpp"

namespace sweepscope::ui {
namespace {

constexpr std::size_t kMaxSteps = 200;

Settings move_between(std::vector<Settings>& from, std::vector<Settings>& to, const Settings& now) {
  if (from.empty()) return now;
  to.push_back(now);
  const Settings there = from.back();
  from.pop_back();
  return there;
}

}  // namespace

void History::record(const Settings& before, const std::string& gesture) {
  future_.clear();
  if (!gesture.empty() && gesture == gesture_ && !past_.empty()) return;
  gesture_ = gesture;
  past_.push_back(before);
  if (past_.size() > kMaxSteps) past_.erase(past_.begin());
}

Settings History::undo(const Settings& now) {
  gesture_.clear();
  return move_between(past_, future_, now);
}

Settings History::redo(const Settings& now) {
  gesture_.clear();
  return move_between(future_, past_, now);
}

}  // namespace sweepscope::ui
