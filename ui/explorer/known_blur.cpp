#include "ui/explorer/known_blur.hpp"

#include <algorithm>

namespace sweepscope::ui {
namespace {

constexpr const char* kBlur = "blur";
constexpr std::size_t kMaxKnown = 4;

}  // namespace

const SlowValues* KnownBlur::at(const Placement& placement) const {
  const auto found = std::ranges::find(known_, placement, &std::pair<Placement, SlowValues>::first);
  return found != known_.end() ? &found->second : nullptr;
}

void KnownBlur::keep(const Placement& placement, SlowValues values) {
  if (at(placement) != nullptr) return;
  known_.emplace_back(placement, std::move(values));
  if (known_.size() > kMaxKnown) known_.erase(known_.begin());
}

void KnownBlur::measure(const Placement& a, const Placement& b) {
  std::vector<Placement> unknown;
  for (const Placement& placement : {a, b})
    if (at(placement) == nullptr && std::ranges::find(unknown, placement) == unknown.end())
      unknown.push_back(placement);
  if (unknown.empty() || background_.has(kBlur)) return;
  background_.start(kBlur, kBlur, "Measuring the walls",
                    [this, unknown](const Job& job) -> Background::Finish {
                      std::vector<SlowValues> measured;
                      for (const Placement& placement : unknown) {
                        measured.push_back(slow_values(placement, ColourBy::kBlur, nullptr, job));
                        if (job.cancelled()) return {};
                      }
                      return [this, unknown, measured = std::move(measured)] {
                        for (std::size_t i = 0; i < unknown.size(); ++i) keep(unknown[i], measured[i]);
                      };
                    });
}

void KnownBlur::close() {
  background_.cancel(kBlur);
  known_.clear();
}

}  // namespace sweepscope::ui
