#include "core/live/offset_follower.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

std::string words_of(const FollowedOffset& offset) {
  const double ms = offset.offset_s * 1e3;
  return offset.sigma_s > 0 ? fmt::format("{:.3f} ms +- {:.3f} ms", ms, offset.sigma_s * 1e3)
                            : fmt::format("{:.3f} ms", ms);
}

std::string reason_of(const Result<Estimate>& found) {
  if (!found) return found.error().message;
  return found->refusals.empty() ? std::string("no offset was found") : found->refusals.front().text;
}

}  // namespace

OffsetFollower::OffsetFollower(CalibrationOptions options, std::optional<double> given_s)
    : options_(std::move(options)) {
  if (given_s) offset_ = FollowedOffset{*given_s, 0};
}

std::vector<std::string> OffsetFollower::follow(LiveClouds& clouds) {
  std::vector<std::string> said;
  if (const auto found = running_.take()) said = judge(*found, clouds);
  const auto newest_ns = clouds.newest_scan_ns();
  if (!running_.idle() || !clouds.rig() || !newest_ns) return said;
  const double since_s = std::abs(double(*newest_ns - begun_ns_) * 1e-9);
  if (since_s >= pause_s_ && clouds.kept_s() >= options_.seconds) begin(clouds);
  return said;
}

std::vector<std::string> OffsetFollower::finish(LiveClouds& clouds) {
  if (offset_) return {};
  if (running_.idle()) {
    if (!clouds.rig()) return {};
    begin(clouds);
  }
  return judge(running_.wait(), clouds);
}

void OffsetFollower::begin(LiveClouds& clouds) {
  options_.rig = *clouds.rig();
  begun_ns_ = clouds.newest_scan_ns().value_or(0);
  began_ = std::chrono::steady_clock::now();
  running_.begin(clouds.kept(), options_);
}

std::vector<std::string> OffsetFollower::judge(const Result<Estimate>& found, LiveClouds& clouds) {
  constexpr double kPauses = 10, kMinPause_s = 2;
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began_;
  pause_s_ = std::max(kMinPause_s, kPauses * took.count());
  if (!found || !found->offset_s) {
    if (offset_ || std::exchange(refusal_said_, true)) return {};
    return {fmt::format("No offset yet: {} Estimates go on.", reason_of(found))};
  }
  const FollowedOffset later{*found->offset_s, found->sigma_s.value_or(0)};
  const std::optional<FollowedOffset> before = offset_;
  if (before && std::abs(later.offset_s - before->offset_s) <= std::hypot(later.sigma_s, before->sigma_s))
    return {};
  offset_ = later;
  clouds.set_offset(later.offset_s);
  if (!before) return {fmt::format("The offset is {}.", words_of(later))};
  return {fmt::format("The offset has changed to {} (it was {}).", words_of(later), words_of(*before))};
}

}  // namespace sweepscope
