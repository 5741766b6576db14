#include "core/campaign/run_campaign.hpp"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>

namespace sweepscope {
namespace {

class Runner {
 public:
  Runner(std::span<const CampaignInput> inputs, const EstimateRow& estimate_row, const CampaignRun& run,
         const Job& job)
      : inputs_(inputs), estimate_row_(estimate_row), run_(run), job_(job), rows_(inputs.size()) {}

  CampaignEnd run(const std::optional<ExpectedOffset>& expected) {
    campaign_.expected = expected;
    for (const CampaignInput& input : inputs_) campaign_.pending.push_back(input.recording);
    const auto next = [this](tbb::flow_control& flow) { return next_index(flow); };
    // Isolated, so that a thread that waits for a part of one recording does not begin another.
    const auto work = [this](std::size_t index) {
      tbb::this_task_arena::isolate([&] { rows_[index] = row(index); });
      return index;
    };
    const auto tell = [this](std::size_t index) { add(index); };
    tbb::parallel_pipeline(std::max<std::size_t>(run_.at_once, 1),
                           tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, next) &
                               tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel, work) &
                               tbb::make_filter<std::size_t, void>(tbb::filter_mode::serial_in_order, tell));
    if (unfinished_) gather_finished();
    return {std::move(campaign_), std::move(done_)};
  }

 private:
  std::size_t next_index(tbb::flow_control& flow) {
    if (begun_ < inputs_.size() && !job_.cancelled() && !stopped_) return begun_++;
    if (begun_ < inputs_.size()) unfinished_ = true;
    flow.stop();
    return 0;
  }

  std::optional<CampaignRow> row(std::size_t index) {
    const std::string& key = inputs_[index].key;
    const bool kept = run_.kept != nullptr && !key.empty();
    if (kept)
      if (auto there = run_.kept->find(key)) return there;
    auto row = estimate_row_(index, job_);
    if (row && kept && row->outcome != RowOutcome::kUnreadable) run_.kept->keep({key, *row});
    return row;
  }

  void add(std::size_t index) {
    if (!rows_[index]) unfinished_ = true;
    if (unfinished_ || stopped_) return;
    campaign_.rows.push_back(*rows_[index]);
    campaign_.pending.erase(campaign_.pending.begin());
    job_.report("estimating", static_cast<double>(index + 1) / static_cast<double>(inputs_.size()));
    if (run_.kept != nullptr)
      if (const auto failed = run_.kept->failed()) done_ = tl::unexpected(*failed);
    if (done_ && run_.on_row) done_ = run_.on_row(campaign_);
    if (!done_) stopped_ = true;
  }

  /// All that is finished, also behind a recording that is not.
  void gather_finished() {
    campaign_.rows.clear();
    campaign_.pending.clear();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (rows_[i])
        campaign_.rows.push_back(*rows_[i]);
      else
        campaign_.pending.push_back(inputs_[i].recording);
    }
  }

  std::span<const CampaignInput> inputs_;
  const EstimateRow& estimate_row_;
  const CampaignRun& run_;
  const Job& job_;
  std::vector<std::optional<CampaignRow>> rows_;
  std::size_t begun_ = 0;
  std::atomic<bool> stopped_{false}, unfinished_{false};
  Campaign campaign_;
  Result<void> done_;
};

}  // namespace

CampaignEnd run_campaign(std::span<const CampaignInput> inputs, const EstimateRow& estimate_row,
                         const std::optional<ExpectedOffset>& expected, const CampaignRun& run,
                         const Job& job) {
  return Runner(inputs, estimate_row, run, job).run(expected);
}

std::size_t campaign_width(std::vector<std::uint64_t> recording_bytes, std::size_t threads,
                           std::optional<std::uint64_t> available_bytes) {
  if (!available_bytes) return std::max<std::size_t>(threads, 1);
  // An upper bound: a bag of a walk of 15 MB took 100 MB with the program itself, one of 0.7 MB 55 MB.
  constexpr std::uint64_t kMemoryPerByte = 6, kMemoryOfAny_bytes = std::uint64_t{100} << 20;
  std::sort(recording_bytes.begin(), recording_bytes.end(), std::greater<>());
  std::size_t width = 0;
  for (std::uint64_t left = *available_bytes / 2; width < std::min(threads, recording_bytes.size());
       ++width) {
    const std::uint64_t needed = kMemoryPerByte * recording_bytes[width] + kMemoryOfAny_bytes;
    if (needed > left) break;
    left -= needed;
  }
  return std::max<std::size_t>(width, 1);
}

}  // namespace sweepscope
