#include "ui/serve/mailbox.hpp"

#include <algorithm>
#include <utility>

namespace sweepscope::ui {
namespace {

constexpr std::size_t kMaxWaiting = 4096;

bool is_move(const InputEvent& event) {
  return event.what == InputEvent::What::kMove;
}

}  // namespace

void Mailbox::post(std::unique_lock<std::mutex> lock) {
  any_ = true;
  lock.unlock();
  came_.notify_one();
}

bool Mailbox::add(const InputMessage& input) {
  std::unique_lock lock(mutex_);
  std::vector<InputEvent>& events = waiting_.events;
  for (const InputEvent& event : input.events) {
    if (!events.empty() && is_move(event) && is_move(events.back())) events.pop_back();
    if (events.size() >= kMaxWaiting) return false;
    events.push_back(event);
  }
  waiting_.input_number = input.number;
  last_input_ = Clock::now();
  post(std::move(lock));
  return true;
}

void Mailbox::paste(std::string text) {
  std::unique_lock lock(mutex_);
  waiting_.pasted = std::move(text);
  if (waiting_.events.size() < kMaxWaiting) {
    waiting_.events.push_back(InputEvent::stroke('V', true, kCtrl));
    waiting_.events.push_back(InputEvent::stroke('V', false, kCtrl));
    waiting_.events.push_back(InputEvent::stroke('V', false, 0));  // Ctrl is up again
  }
  post(std::move(lock));
}

void Mailbox::resize(const SizeMessage& size) {
  std::unique_lock lock(mutex_);
  waiting_.size = size;
  post(std::move(lock));
}

void Mailbox::repaint() {
  std::unique_lock lock(mutex_);
  waiting_.repaint = true;
  post(std::move(lock));
}

void Mailbox::wake() {
  post(std::unique_lock(mutex_));
}

void Mailbox::set_sendable(std::optional<Clock::time_point> at) {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(sendable_, at) == at) return;
  }
  came_.notify_one();
}

Mailbox::Arrived Mailbox::wait(double max_s, Clock::duration drawing) {
  std::unique_lock lock(mutex_);
  came_.wait_for(lock, std::chrono::duration<double>(max_s), [&] { return any_; });
  const auto latest = Clock::now() + max_held_;
  for (auto now = Clock::now();; now = Clock::now()) {
    const auto begin = sendable_ ? std::min(*sendable_ - drawing, latest) : latest;
    if (now >= begin) break;
    came_.wait_until(lock, begin);
  }
  any_ = false;
  const std::uint32_t number = waiting_.input_number;
  if (!waiting_.events.empty())
    waiting_.wait_us = static_cast<std::uint32_t>(
        std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - last_input_).count());
  Arrived arrived = std::exchange(waiting_, {});
  waiting_.input_number = number;
  return arrived;
}

}  // namespace sweepscope::ui
