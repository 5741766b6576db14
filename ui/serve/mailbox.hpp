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

  /// Moves in a row count as one. False if the explorer is so far behind that no more is kept.
  bool add(const InputMessage& input);
  void paste(std::string text);
  void resize(const SizeMessage& size);
  void repaint();
  /// Ends a wait early.
  void wake();

  /// Waits until something comes, at most this long.
  Arrived wait(double max_s);

 private:
  using Clock = std::chrono::steady_clock;
  void post(std::unique_lock<std::mutex> lock);

  std::mutex mutex_;
  std::condition_variable came_;
  Arrived waiting_;
  Clock::time_point last_input_;
  bool any_ = false;
};

}  // namespace sweepscope::ui
