#include "core/recording/stream_stamps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

constexpr double kSecondsPerNanosecond = 1e-9;
constexpr double kShortestSpan_s = 1.0;  // over less, the two kinds of stamps are not compared
constexpr double kSpeedTolerance = 1.25;
// A link that stalls delays by the time until TCP sends again, some 40 to 200 ms; what is usual is within
// some deviations.
constexpr double kLate_s = 0.01, kLateDeviations = 8;
// Faster than any clock drifts: the header stamps are in another unit.
constexpr double kMaxDrift = 1e-3;

double span_s(std::span<const MessageStamps> stamps, StampSource source) {
  std::int64_t first = INT64_MAX, last = INT64_MIN;
  for (const MessageStamps& stamp : stamps) {
    if (stamp.header_ns == 0 || stamp.receive_ns == 0) continue;
    first = std::min(first, stamp_ns(stamp, source));
    last = std::max(last, stamp_ns(stamp, source));
  }
  return last < first ? 0 : static_cast<double>(last - first) * kSecondsPerNanosecond;
}

void warn_of_wrong_unit(std::span<const MessageStamps> stamps, const std::string& topic,
                        std::vector<std::string>& warnings) {
  const double header_s = span_s(stamps, StampSource::kHeader),
               receive_s = span_s(stamps, StampSource::kReceive);
  if (header_s == 0 || receive_s < kShortestSpan_s) return;
  const double speed = header_s / receive_s;
  if (speed < kSpeedTolerance && speed > 1 / kSpeedTolerance) return;
  const double decades = std::log10(speed);
  const double thousands = 3 * std::round(decades / 3);
  const bool unit = thousands != 0 && std::abs(decades - thousands) < 0.1;
  warnings.push_back(fmt::format(
      "the header stamps of {} run {:.4g} times as fast as its receive times{}; consider --stamps receive",
      topic, speed, unit ? ", as if they were in another unit" : ""));
}

void measure_delay(std::span<const MessageStamps> stamps, StreamStamps& stream) {
  std::vector<double> delays_s;
  for (const MessageStamps& stamp : stamps) {
    if (stamp.header_ns == 0 || stamp.receive_ns == 0) continue;
    delays_s.push_back(static_cast<double>(stamp.receive_ns - stamp.header_ns) * kSecondsPerNanosecond);
  }
  if (delays_s.empty()) return;
  const double middle_s = median(delays_s);
  for (double& delay_s : delays_s) delay_s = std::abs(delay_s - middle_s);
  stream.receive_minus_header_s = middle_s;
  stream.receive_jitter_s = kSigmaPerMedianDeviation * median(std::move(delays_s));
}

// By how much the delay changed from the first quarter of the messages to the last.
double clocks_apart(const std::vector<double>& delays_s) {
  const auto quarter = std::ssize(delays_s) / 4;
  return std::abs(median(std::vector<double>(delays_s.end() - quarter, delays_s.end())) -
                  median(std::vector<double>(delays_s.begin(), delays_s.begin() + quarter)));
}

// The two clocks may drift apart, so the usual delay is that of the messages around.
double median_around(const std::vector<double>& delays_s, std::size_t i) {
  constexpr std::size_t kAround = 25;
  const std::size_t from = i - std::min(i, kAround), to = std::min(i + kAround + 1, delays_s.size());
  return median(
      std::vector<double>(delays_s.begin() + std::ptrdiff_t(from), delays_s.begin() + std::ptrdiff_t(to)));
}

}  // namespace

std::int64_t stamp_ns(const MessageStamps& stamps, StampSource source) {
  return source == StampSource::kHeader ? stamps.header_ns : stamps.receive_ns;
}

StreamStamps choose_stamps(std::span<const MessageStamps> stamps, StampSource wanted,
                           const std::string& topic, std::vector<std::string>& warnings) {
  StreamStamps stream;
  stream.used = wanted;
  const auto has = [&](StampSource source) {
    return std::ranges::any_of(stamps,
                               [&](const MessageStamps& stamp) { return stamp_ns(stamp, source) != 0; });
  };
  if (wanted == StampSource::kHeader && !has(StampSource::kHeader)) {
    stream.used = StampSource::kReceive;
    warnings.push_back(fmt::format("no message on {} has a header stamp; its receive times are used", topic));
  } else if (wanted == StampSource::kReceive && !has(StampSource::kReceive)) {
    stream.used = StampSource::kHeader;
    warnings.push_back(fmt::format("no message on {} has a receive time; its header stamps are used", topic));
  }
  warn_of_wrong_unit(stamps, topic, warnings);
  measure_delay(stamps, stream);
  return stream;
}

LateMessages correct_late(std::span<MessageStamps> stamps) {
  std::vector<std::size_t> both;
  std::vector<double> delays_s;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (stamps[i].header_ns == 0 || stamps[i].receive_ns == 0) continue;
    both.push_back(i);
    delays_s.push_back(static_cast<double>(stamps[i].receive_ns - stamps[i].header_ns) *
                       kSecondsPerNanosecond);
  }
  if (clocks_apart(delays_s) > kMaxDrift * span_s(stamps, StampSource::kHeader)) return {};
  std::vector<double> excess_s, deviations_s;
  for (std::size_t i = 0; i < delays_s.size(); ++i) {
    excess_s.push_back(delays_s[i] - median_around(delays_s, i));
    deviations_s.push_back(std::abs(excess_s.back()));
  }
  const double limit_s =
      std::max(kLate_s, kLateDeviations * kSigmaPerMedianDeviation * median(std::move(deviations_s)));
  LateMessages late;
  for (std::size_t i = 0; i < both.size(); ++i) {
    if (excess_s[i] <= limit_s) continue;
    ++late.count;
    late.latest_s = std::max(late.latest_s, excess_s[i]);
    stamps[both[i]].receive_ns -= std::llround(excess_s[i] / kSecondsPerNanosecond);
  }
  return late;
}

TimeOrder order_by_time(std::span<const double> times_s) {
  TimeOrder order;
  std::vector<std::size_t> all(times_s.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  double latest_s = -HUGE_VAL;
  for (const double t_s : times_s) {
    if (t_s < latest_s) ++order.out_of_order;
    latest_s = std::max(latest_s, t_s);
  }
  if (order.out_of_order > 0) {
    std::ranges::stable_sort(all, {}, [&](std::size_t i) { return times_s[i]; });
  }
  for (const std::size_t i : all) {
    if (!order.kept.empty() && times_s[order.kept.back()] == times_s[i]) {
      ++order.duplicates;
    } else {
      order.kept.push_back(i);
    }
  }
  return order;
}

namespace {

struct Messages {
  std::size_t first = 0, last = 0;
};

// Where the messages are about twice as dense as usual, for at least as long as ten of them take otherwise.
std::vector<Messages> dense_parts(std::span<const double> times_s, double spacing_s) {
  constexpr std::size_t kWindow = 10;
  constexpr double kMin = 1.6, kMax = 2.4;  // as dense
  std::vector<Messages> parts;
  for (std::size_t i = 0; i + kWindow < times_s.size(); ++i) {
    if (times_s[i + kWindow] - times_s[i] > kWindow * spacing_s / kMin) continue;
    if (!parts.empty() && parts.back().last >= i)
      parts.back().last = i + kWindow;
    else
      parts.push_back({i, i + kWindow});
  }
  std::erase_if(parts, [&](const Messages& part) {
    const double usual = (times_s[part.last] - times_s[part.first]) / spacing_s;
    return usual < kWindow || double(part.last - part.first) > kMax * usual;
  });
  return parts;
}

// By how much the values change a second, up and down alike.
double changes_per_s(std::span<const double> times_s, std::span<const double> values) {
  double sum = 0;
  for (std::size_t i = 1; i < values.size(); ++i) sum += std::abs(values[i] - values[i - 1]);
  return sum / std::max(times_s.back() - times_s.front(), kSecondsPerNanosecond);
}

}  // namespace

std::optional<ClockPart> part_of_one_clock(std::span<const double> times_s, std::span<const double> values) {
  constexpr std::size_t kMinSide = 10;
  constexpr double kToAndFro = 2;  // times as many changes as elsewhere
  std::vector<std::size_t> order(times_s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return times_s[i]; });
  std::vector<double> sorted_s, in_order;
  for (const std::size_t i : order) {
    const bool sent_twice = !sorted_s.empty() && times_s[i] == sorted_s.back() &&
                            (values.empty() || values[i] == in_order.back());
    if (sent_twice) continue;
    sorted_s.push_back(times_s[i]);
    if (!values.empty()) in_order.push_back(values[i]);
  }
  const std::vector<Messages> dense = dense_parts(sorted_s, median(spacings(sorted_s)));
  if (dense.size() != 1) return std::nullopt;
  const auto [first, last] = dense.front();
  if (first < kMinSide || sorted_s.size() - last < kMinSide) return std::nullopt;
  const auto changes = [&](std::size_t from, std::size_t to) {
    return changes_per_s(std::span(sorted_s).subspan(from, to - from),
                         std::span(in_order).subspan(from, to - from));
  };
  if (!in_order.empty() &&
      changes(first, last) < kToAndFro * std::max(changes(0, first), changes(last, sorted_s.size())))
    return std::nullopt;
  const bool before = first > sorted_s.size() - last;
  return ClockPart{before ? sorted_s.front() : sorted_s[last], before ? sorted_s[first] : sorted_s.back(),
                   sorted_s[last] - sorted_s[first]};
}

std::string set_back_warning(const ClockPart& part, double start_s, const std::string& topic) {
  return fmt::format(
      "the stamps on {} overlap for {:.2f} s, so a clock was set back by about as much: only the messages from "
      "{:.2f} to {:.2f} s are used, and those of the other side may have another offset",
      topic, part.set_back_s, part.from_s - start_s, part.to_s - start_s);
}

double unevenness_s(std::span<const double> times_s) {
  std::vector<double> left_s = spacings(times_s);
  const double period_s = median(left_s);
  if (left_s.size() < 2 || !(period_s > 0)) return 0;
  for (double& spacing_s : left_s) spacing_s = std::abs(std::remainder(spacing_s, period_s));
  std::ranges::sort(left_s);
  return left_s[left_s.size() * 9 / 10];
}

Spacing spacing(std::span<const double> times_s, double factor) {
  Spacing result;
  const std::vector<double> spacings_s = spacings(times_s);
  result.median_s = median(spacings_s);
  for (const double spacing_s : spacings_s) {
    if (spacing_s <= factor * result.median_s) continue;
    ++result.gaps;
    result.longest_gap_s = std::max(result.longest_gap_s, spacing_s);
  }
  return result;
}

}  // namespace sweepscope
