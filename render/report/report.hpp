#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/map/sections/cross_section.hpp"
#include "core/offset/estimate.hpp"
#include "core/recording/inspect.hpp"
#include "render/comparison/compared_map.hpp"
#include "render/page/live_map.hpp"

namespace sweepscope {

/// The content of a report. The maps are those 5 ms off and at the answer; none without an answer.
struct ReportContent {
  std::string command;  // by report_command()
  RecordingSummary recording;
  Estimate estimate;
  std::optional<Estimate>
      criteria;  // the paper's criteria over the offset, as evidence; none without an answer
  std::optional<Estimate> over_time;  // the offset in windows; only of long recordings of a stationary rig
  std::vector<ComparedMap> maps;
  std::optional<LiveMap> live;          // of those maps, for the reader to turn; absent: none was asked for
  std::optional<CrossSection> section;  // the face that shows the offset best, if there is one
};

/// The charts of a report: that of the criterion that answered, then those of the paper's criteria. All have
/// the same line at the offset found; titles say where a criterion by itself has its best value.
std::vector<Chart> evidence_charts(const ReportContent& content);

/// The command that makes a report, quoted for a shell. It names files without their folders, and always the
/// folder "report": the page does not depend on where files lie. `options` begin with a space.
std::string report_command(const std::string& recording_name, const std::string& options);

/// One self-contained HTML page: what was recorded, the answer with its equation and uncertainty or the
/// reasons why there is none, the criteria, the maps, a profile, warnings, and how it was made. Pictures are
/// embedded; it contains no time and no host name, needs no network, and can be printed. With a live map its
/// reader can turn the offset; on paper, and where scripts or WebGL 2 are missing, the pictures stand in.
/// An interruption is ExitCode::kInterrupted.
Result<std::string> report_html(const ReportContent& content, const Job& job = {});

}  // namespace sweepscope
