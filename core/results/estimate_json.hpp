#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/offset/estimate.hpp"

namespace sweepscope {

/// Whether an output contains the computing time. Without it the same input gives the same bytes.
enum class Timing { kWritten, kNull };

/// As they are written in JSON and on command lines: "direct", "stationary", "moving".
const char* to_text(Method method);
/// As it is written in JSON: "stationary", "moving".
const char* to_text(RigKind kind);

/// The estimate as a JSON object (schema "sweepscope.estimate/1"), keys in a fixed order, offsets in
/// milliseconds, null where a value is absent, with a line end; "poses" only if a motion from another source
/// was used, "fit" only for the direct method, "over_time" and the course only if that was asked for,
/// "recordings" and how they agree only of several recordings together,
/// "sample" only if a sample of the sweeps was used, "parameters" only if the rig was solved for. Offsets
/// keep 1e-9 ms. An estimate that is not identifiable has offset_ms and sigma_ms null.
std::string estimate_to_json(const Estimate& estimate, Timing timing = Timing::kWritten);

/// Reads what estimate_to_json wrote; unknown keys are skipped. `name` is the name of the file in error
/// messages, which also name the key.
Result<Estimate> parse_estimate_json(std::string_view text, std::string_view name);

/// Writes estimate_to_json; the file appears when it is complete. ExitCode::kWrongUsage if it cannot be
/// written.
Result<void> write_estimate_json(const std::filesystem::path& path, const Estimate& estimate,
                                 Timing timing = Timing::kWritten);
/// Reads such a file.
Result<Estimate> read_estimate_json(const std::filesystem::path& path);

/// The curve as a table: a header line that names columns and units, then one line per offset; absent values
/// are empty.
std::string curve_to_csv(const Estimate& estimate);
/// The windows of an offset over time and the course at their times as a table, one line per window; empty
/// if a window does not determine the offset.
std::string over_time_to_csv(const OffsetOverTime& over_time);
/// Writes curve_to_csv, as write_estimate_json does.
Result<void> write_curve_csv(const std::filesystem::path& path, const Estimate& estimate);

}  // namespace sweepscope
