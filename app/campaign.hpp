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

  /// REC... The options write to this object.
  void declare_recordings(CLI::App& command);
  /// --expect, --table and --trend.
  void declare(CLI::App& command);
  /// Several recordings, or an output for several.
  bool is_campaign() const { return recordings.size() > 1 || !table.empty() || !trend.empty(); }
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
