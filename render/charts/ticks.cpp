#include "render/charts/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace sweepscope {

Ticks round_ticks(double from, double to, int at_most) {
  Ticks ticks;
  if (!(to > from) || at_most < 1) return ticks;
  const double rough = (to - from) / at_most;
  double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
    ticks.step = factor * power;
    if (ticks.step >= rough * (1 - 1e-9)) break;
  }
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(ticks.step) + 1e-9)));
  const auto first = std::llround(std::ceil(from / ticks.step - 1e-9));
  const auto last = std::llround(std::floor(to / ticks.step + 1e-9));
  for (auto k = first; k <= last; ++k) {
    const double value = double(k) * ticks.step;
    ticks.values.push_back(value);
    std::string label = fmt::format("{:.{}f}", value, decimals);
    if (label.front() == '-') label.replace(0, 1, "−");
    ticks.labels.push_back(std::move(label));
  }
  return ticks;
}

namespace {

/// Steps of ticks at dates: so many units, which are seconds or months.
struct DateStep {
  std::int64_t seconds = 0;
  int months = 0;  // not 0: instead of the seconds

  double min_s() const { return months == 0 ? static_cast<double>(seconds) : months * 28 * 86'400.0; }
};

constexpr std::int64_t kMinute_s = 60, kHour_s = 3600, kDay_s = 86'400;
constexpr std::array<DateStep, 24> kDateSteps{{{1},
                                               {2},
                                               {5},
                                               {10},
                                               {30},
                                               {kMinute_s},
                                               {2 * kMinute_s},
                                               {5 * kMinute_s},
                                               {10 * kMinute_s},
                                               {30 * kMinute_s},
                                               {kHour_s},
                                               {2 * kHour_s},
                                               {3 * kHour_s},
                                               {6 * kHour_s},
                                               {12 * kHour_s},
                                               {kDay_s},
                                               {2 * kDay_s},
                                               {7 * kDay_s},
                                               {14 * kDay_s},
                                               {0, 1},
                                               {0, 2},
                                               {0, 3},
                                               {0, 6},
                                               {0, 12}}};

DateStep date_step(double length_s, int at_most) {
  for (const DateStep& step : kDateSteps)
    if (step.min_s() * at_most >= length_s) return step;
  const double years = length_s / (at_most * kDateSteps.back().min_s());
  return {0, 12 * static_cast<int>(std::ceil(years))};
}

std::string date_label(std::chrono::sys_seconds time, const DateStep& step) {
  const auto day = std::chrono::floor<std::chrono::days>(time);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss clock{time - day};
  const int year = static_cast<int>(date.year());
  const unsigned month = static_cast<unsigned>(date.month()), of_month = static_cast<unsigned>(date.day());
  if (step.months >= 12) return fmt::format("{}", year);
  if (step.months > 0) return fmt::format("{}-{:02}", year, month);
  if (step.seconds >= kDay_s) return fmt::format("{}-{:02}-{:02}", year, month, of_month);
  if (step.seconds >= kMinute_s)
    return fmt::format("{:02}-{:02} {:02}:{:02}", month, of_month, clock.hours().count(),
                       clock.minutes().count());
  return fmt::format("{:02}:{:02}:{:02}", clock.hours().count(), clock.minutes().count(),
                     clock.seconds().count());
}

/// The first tick at or after a time, and the one after a tick.
std::chrono::sys_seconds first_tick(std::int64_t from_s, const DateStep& step) {
  using namespace std::chrono;
  const sys_seconds from{seconds(from_s)};
  if (step.months == 0) {
    const std::int64_t rest = ((from_s % step.seconds) + step.seconds) % step.seconds;
    return rest == 0 ? from : from + seconds(step.seconds - rest);
  }
  const year_month_day date{floor<days>(from)};
  const int month = (static_cast<int>(static_cast<unsigned>(date.month())) - 1) / step.months * step.months;
  year_month_day tick = date.year() / std::chrono::month(static_cast<unsigned>(month % 12 + 1)) / 1;
  while (sys_days(tick) < from) tick += months(step.months);
  return sys_days(tick);
}

std::chrono::sys_seconds next_tick(std::chrono::sys_seconds tick, const DateStep& step) {
  using namespace std::chrono;
  if (step.months == 0) return tick + seconds(step.seconds);
  return sys_days(year_month_day{floor<days>(tick)} + months(step.months));
}

}  // namespace

Ticks date_ticks(double from, double to, int at_most, std::int64_t origin_s) {
  Ticks ticks;
  if (!(to > from) || at_most < 1) return ticks;
  const DateStep step = date_step(to - from, at_most);
  ticks.step = step.min_s();
  auto tick = first_tick(origin_s + static_cast<std::int64_t>(std::ceil(from)), step);
  for (;; tick = next_tick(tick, step)) {
    const double value = static_cast<double>(tick.time_since_epoch().count() - origin_s);
    if (value > to) return ticks;
    ticks.values.push_back(value);
    ticks.labels.push_back(date_label(tick, step));
  }
}

double round_length(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length) + 1e-9));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= length * (1 + 1e-9)) return factor * power;
  }
  return power;
}

}  // namespace sweepscope
