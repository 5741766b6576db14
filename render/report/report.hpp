#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/map/cross_section.hpp"
#include "core/offset/estimate.hpp"
#include "core/recording/inspect.hpp"
#include "render/comparison/compared_map.hpp"

namespace sweepscope {

/// What a report tells. The maps are those 5 ms off and at the answer; where there is no answer there are
/// none.
struct ReportContent {
  std::string command;  // by report_command()
  RecordingSummary recording;
  Estimate estimate;
  std::optional<Estimate>
      criteria;  // the paper's criteria over the offset, as evidence; none without an answer
  std::optional<Estimate> over_time;  // the offset in windows; only of long recordings of a stationary rig
  std::vector<ComparedMap> maps;
  std::optional<CrossSection> section;  // the face that shows the offset best, where there is one
};

/// The command that makes a report, as a shell would take it. It names files without their folders, and
/// always the folder "report": the page is the same wherever files lie. `options` begin with a space.
std::string report_command(const std::string& recording_name, const std::string& options);

/// One self-contained HTML page: what was recorded, the answer with its equation and uncertainty or the
/// reasons why there is none, the criteria, the maps, a profile, warnings, and how it was made. Its pictures
/// are inside; it holds no clock and no host, needs no network, and can be printed.
Result<std::string> report_html(const ReportContent& content);

}  // namespace sweepscope
