#include "app/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "app/interrupt.hpp"
#include "app/say.hpp"

namespace sweepscope::app {

using Clock = std::chrono::steady_clock;

std::string progress_line(std::string_view phase, double fraction, std::chrono::duration<double> elapsed,
                          int width) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  std::string left;
  if (fraction > 0.02 && elapsed.count() > 1) {
    const auto left_s = static_cast<long>(std::ceil(elapsed.count() * (1 - fraction) / fraction));
    left = fmt::format("   {}:{:02} left", left_s / 60, left_s % 60);
  }
  constexpr int kBar = 30;
  const int done = static_cast<int>(std::lround(kBar * fraction));
  std::string line =
      fmt::format("{:<12} [{:<{}}] {:3.0f} %{}", phase, std::string(static_cast<std::size_t>(done), '#'),
                  kBar, std::floor(100 * fraction), left);
  if (line.size() > static_cast<std::size_t>(width)) line.resize(static_cast<std::size_t>(width));
  return line;
}

struct Progress::Bar {
  std::mutex mutex;
  bool terminal = isatty(STDERR_FILENO) == 1;
  bool drawn = false;
  std::string phase;
  Clock::time_point phase_began;
  Clock::time_point last_drawn;

  void draw(std::string_view new_phase, double fraction) {
    const std::lock_guard lock(mutex);
    const auto now = Clock::now();
    if (phase != new_phase) {
      phase = new_phase;
      phase_began = now;
      last_drawn = {};
    }
    constexpr auto kBetweenDrawings = std::chrono::milliseconds(100);
    if (now - last_drawn < kBetweenDrawings) return;
    last_drawn = now;
    drawn = true;
    winsize size{};
    const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
    app::say("\r{}\x1b[K", progress_line(phase, fraction, now - phase_began, known ? size.ws_col - 1 : 79));
  }
  void wipe() {
    const std::lock_guard lock(mutex);
    if (drawn) app::say("\r\x1b[K");
    drawn = false;
  }
  void say(const std::string& line) {
    wipe();
    app::say("{}\n", line);
  }
};

Progress::Progress()
    : bar_(std::make_unique<Bar>()),
      job_(bar_->terminal ? Job::Sink([bar = bar_.get()](std::string_view phase, double fraction) {
        bar->draw(phase, fraction);
      })
                          : Job::Sink()) {
  job_.obey(interrupt_flag());
}

void Progress::say(const std::string& line) const {
  bar_->say(line);
}

Progress::~Progress() {
  bar_->wipe();
}

}  // namespace sweepscope::app
