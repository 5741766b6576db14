#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/estimate_options.hpp"
#include "core/campaign/expected_offset.hpp"

namespace sweepscope::app {

/// What `estimate` does with many recordings.
struct CampaignOptions {
  std::vector<std::filesystem::path> recordings;
  std::optional<ExpectedOffset> expected;
  std::string table, trend;  // empty: none
  bool together = false;     // all are of one rig, and one answer is asked for
  bool own_offsets = false;  // which then has an offset for each

  /// REC... The options write to this object.
  void declare_recordings(CLI::App& command);
  /// --together and --offsets, --expect, --table and --trend.
  void declare(CLI::App& command);
  /// Several recordings with an answer each, or an output for these.
  bool is_campaign() const {
    return !together && (recordings.size() > 1 || !table.empty() || !trend.empty());
  }
};

/// The rows of a table are kept in this file beside it.
std::string rows_file(const std::string& table);

/// Estimates the recordings: a line on stdout for each, then the table and the picture. `deciding`: the
/// options that results depend on.
ExitCode run_campaign(const CampaignOptions& options, const EstimateInput& input,
                      const std::vector<std::string>& deciding);

/// Says whether a single answer is as expected; kNotAsExpected if it is not.
ExitCode conclude_expectation(const ExpectedOffset& expected, const Estimate& estimate, bool on_stdout);

}  // namespace sweepscope::app
