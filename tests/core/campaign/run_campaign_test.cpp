#include "core/campaign/run_campaign.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <set>
#include <thread>

#include "core/parallel.hpp"
#include "tests/core/campaign/rows.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

using test::answered;

std::vector<CampaignInput> inputs(std::size_t count) {
  std::vector<CampaignInput> inputs;
  for (std::size_t i = 0; i < count; ++i)
    inputs.push_back({"rec-" + std::to_string(i), "key-" + std::to_string(i)});
  return inputs;
}

std::optional<CampaignRow> row_of(std::size_t index, const Job&) {
  return answered("rec-" + std::to_string(index), 24 + 0.01 * static_cast<double>(index));
}

class RunCampaign : public test::FolderTest {
 protected:
  std::unique_ptr<RowFile> open() const {
    auto file = RowFile::open(folder_ / "t.csv.rows");
    EXPECT_TRUE(file) << file.error().message;
    return std::move(*file);
  }
};

TEST_F(RunCampaign, TellsTheRowsInTheirOrderWhateverIsFinishedFirst) {
  constexpr std::size_t kCount = 4;
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, kCount);
  std::atomic<std::size_t> begun{0};
  std::vector<std::string> told;
  CampaignRun run;
  run.at_once = kCount;
  run.on_row = [&](const Campaign& campaign) {
    told.push_back(campaign.rows.back().recording);
    EXPECT_EQ(campaign.rows.size() + campaign.pending.size(), kCount);
    return Result<void>();
  };
  const auto end = run_campaign(
      inputs(kCount),
      [&](std::size_t index, const Job& job) {
        ++begun;
        // The first recording is finished last, where other threads take the others.
        for (int i = 0; index == 0 && begun < kCount && i < 100'000; ++i) std::this_thread::yield();
        return row_of(index, job);
      },
      {}, run, Job());
  EXPECT_EQ(begun, kCount);
  EXPECT_EQ(told, (std::vector<std::string>{"rec-0", "rec-1", "rec-2", "rec-3"}));
  EXPECT_TRUE(end.done);
  EXPECT_TRUE(end.campaign.pending.empty());
}

TEST_F(RunCampaign, WorksOnNoMoreAtOnceThanItMay) {
  for (const std::size_t at_once : {1, 2}) {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 4);
    std::atomic<std::size_t> now{0}, most{0};
    CampaignRun run;
    run.at_once = at_once;
    const auto end = run_campaign(
        inputs(50),
        [&](std::size_t index, const Job& job) {
          const std::size_t here = ++now;
          for (std::size_t before = most; before < here && !most.compare_exchange_weak(before, here);) {
          }
          // A thread that waits for these parts must not begin another recording meanwhile.
          std::atomic<int> parts{0};
          for_each_task(64, [&](std::size_t) { ++parts; });
          --now;
          return row_of(index, job);
        },
        {}, run, Job());
    EXPECT_LE(most, at_once);
    EXPECT_EQ(end.campaign.rows.size(), 50U);
  }
}

TEST_F(RunCampaign, EstimatesOnlyWhatIsNotKept) {
  {
    const auto file = open();
    file->keep({"key-1", answered("rec-1", 77)});
  }
  const auto file = open();
  std::set<std::size_t> estimated;
  CampaignRun run;
  run.kept = file.get();
  const auto end = run_campaign(
      inputs(3),
      [&](std::size_t index, const Job& job) {
        estimated.insert(index);
        return row_of(index, job);
      },
      {}, run, Job());
  EXPECT_EQ(estimated, (std::set<std::size_t>{0, 2}));
  EXPECT_EQ(end.campaign.rows.at(1).offset_ms, 77);
  EXPECT_TRUE(file->find("key-2"));
}

TEST_F(RunCampaign, WhatCouldNotBeReadIsTriedAgain) {
  const auto file = open();
  CampaignRun run;
  run.kept = file.get();
  int tries = 0;
  const auto unreadable = [&](std::size_t, const Job&) {
    ++tries;
    return std::optional(test::without_offset("rec-0", RowOutcome::kUnreadable));
  };
  run_campaign(inputs(1), unreadable, {}, run, Job());
  run_campaign(inputs(1), unreadable, {}, run, Job());
  EXPECT_EQ(tries, 2);
}

TEST_F(RunCampaign, ACancelledOneHoldsWhatIsFinishedAndNamesTheRest) {
  Job job;
  CampaignRun run;
  const auto end = run_campaign(
      inputs(5),
      [&](std::size_t index, const Job& whole) -> std::optional<CampaignRow> {
        if (index == 2) job.cancel();
        if (whole.cancelled()) return std::nullopt;
        return row_of(index, whole);
      },
      {}, run, job);
  EXPECT_TRUE(end.done);
  EXPECT_EQ(end.campaign.rows.size(), 2U);
  EXPECT_EQ(end.campaign.pending, (std::vector<std::string>{"rec-2", "rec-3", "rec-4"}));
}

TEST_F(RunCampaign, EndsAtTheFirstRowThatCannotBeWritten) {
  CampaignRun run;
  run.on_row = [](const Campaign& campaign) -> Result<void> {
    if (campaign.rows.size() < 3) return {};
    return failure(ExitCode::kWrongUsage, "full");
  };
  std::size_t estimated = 0;
  const auto end = run_campaign(
      inputs(100),
      [&](std::size_t index, const Job& job) {
        ++estimated;
        return row_of(index, job);
      },
      {}, run, Job());
  ASSERT_FALSE(end.done);
  EXPECT_EQ(end.done.error().message, "full");
  EXPECT_LT(estimated, 10U);
}

TEST_F(RunCampaign, RowsAreKeptToTheLastDigitAndBelongToOneRun) {
  CampaignRow row = answered("rec-0", 24.000000001);
  row.recorded_ns = 1'700'000'000'123'456'789;
  {
    const auto file = open();
    file->keep({"key-0", row});
    const auto second = RowFile::open(folder_ / "t.csv.rows");
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("another run is writing it"), std::string::npos);
  }
  const auto found = open()->find("key-0");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->offset_ms, row.offset_ms);
  EXPECT_EQ(found->recorded_ns, row.recorded_ns);
}

TEST_F(RunCampaign, ADamagedOrUnfinishedRowIsEstimatedAgain) {
  {
    const auto file = open();
    for (const char* key : {"a", "b", "c"}) file->keep({key, answered(key, 24)});
  }
  std::string text = test::contents_of(folder_ / "t.csv.rows");
  text[text.find("\"key\":\"b\"") + 30] ^= 1;
  std::ofstream(folder_ / "t.csv.rows") << text.substr(0, text.size() - 9);
  const auto file = open();
  EXPECT_TRUE(file->find("a"));
  EXPECT_FALSE(file->find("b"));
  EXPECT_FALSE(file->find("c"));
  file->keep({"d", answered("d", 24)});
  EXPECT_TRUE(file->find("d"));
}

TEST_F(RunCampaign, AFileOfSomethingElseIsNotTakenForRows) {
  std::ofstream(folder_ / "t.csv.rows") << "my notes\n";
  const auto file = RowFile::open(folder_ / "t.csv.rows");
  ASSERT_FALSE(file);
  EXPECT_EQ(test::contents_of(folder_ / "t.csv.rows"), "my notes\n");
}

TEST(CampaignWidth, IsBoundByThreadsAndMemory) {
  constexpr std::uint64_t kGiB = std::uint64_t{1} << 30;
  EXPECT_EQ(campaign_width({1, 1, 1, 1}, 2, 64 * kGiB), 2U);
  EXPECT_EQ(campaign_width({1, 1, 1, 1}, 8, {}), 8U);
  EXPECT_EQ(campaign_width({kGiB, kGiB, kGiB, 1, 1}, 5, 8 * kGiB), 1U) << "the largest ones decide";
  EXPECT_EQ(campaign_width({100 * kGiB}, 4, kGiB), 1U) << "one at least";
}

}  // namespace
}  // namespace sweepscope
