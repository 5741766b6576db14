#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "ui/serve/protocol.hpp"

namespace sweepscope::ui {

/// What viewers sent, on its way from the thread of the network to that of the explorer.
class Mailbox {
 public:
  struct Arrived {
    std::vector<InputEvent> events;
    std::optional<SizeMessage> size;
    std::optional<std::string> pasted;
    bool repaint = false;            // somebody came who has no picture yet
    std::uint32_t input_number = 0;  // of the last input
    std::uint32_t wait_us = 0;       // since the last input came
  };

  using Clock = std::chrono::steady_clock;
  /// `max_held`: see wait().
  explicit Mailbox(Clock::duration max_held = std::chrono::milliseconds(100)) : max_held_(max_held) {}

  /// Moves in a row count as one. False if the explorer is so far behind that no more is kept.
  bool add(const InputMessage& input);
  void paste(std::string text);
  void resize(const SizeMessage& size);
  void repaint();
  /// Ends a wait early.
  void wake();

  /// When the driver's next picture can be sent; nothing as long as that depends on the page.
  void set_sendable(std::optional<Clock::time_point> at);

  /// Waits until something comes, at most this long, and then until a picture that takes `drawing` is ready
  /// just when it can be sent, but no longer than `max_held`: what comes meanwhile is in that picture, and
  /// none is drawn for nothing.
  Arrived wait(double max_s, Clock::duration drawing = {});

 private:
  void post(std::unique_lock<std::mutex> lock);

  std::mutex mutex_;
  std::condition_variable came_;
  Arrived waiting_;
  Clock::time_point last_input_;
  bool any_ = false;
  Clock::duration max_held_;
  std::optional<Clock::time_point> sendable_ = Clock::time_point();
};

}  // namespace sweepscope::ui
