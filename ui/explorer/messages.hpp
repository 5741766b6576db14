#pragma once

#include <optional>
#include <string>

#include "core/error.hpp"

namespace sweepscope::ui {

struct Message {
  enum class Kind { kNote, kError };
  Kind kind = Kind::kNote;
  std::string text;
  double shown_s = 0;  // for how long already

  /// After this time it goes by itself.
  double lasts_s() const { return kind == Kind::kNote ? 8 : 30; }
};

/// The message in front.
class Messages {
 public:
  const std::optional<Message>& shown() const { return shown_; }
  void note(std::string text) { shown_ = Message{Message::Kind::kNote, std::move(text), 0}; }
  void error(const Error& why) { shown_ = Message{Message::Kind::kError, why.message, 0}; }
  void show_failure(const Result<void>& done) {
    if (!done) error(done.error());
  }
  void dismiss() { shown_.reset(); }
  /// While it is held, because the mouse is on it, it stays.
  void hold(bool held) { held_ = held; }
  /// Once per frame.
  void update(double seconds_since_last) {
    if (!shown_ || held_) return;
    shown_->shown_s += seconds_since_last;
    if (shown_->shown_s > shown_->lasts_s()) shown_.reset();
  }

 private:
  std::optional<Message> shown_;
  bool held_ = false;
};

}  // namespace sweepscope::ui
