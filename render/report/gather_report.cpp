#include "render/report/gather_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/io/atomic_file.hpp"
#include "core/io/printable_text.hpp"
#include "core/map/offset_map.hpp"
#include "core/offset/kind/rig_motion.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "core/offset/prepared/search_window.hpp"
#include "core/offset/walk/walk.hpp"
#include "core/recording/inspect.hpp"
#include "core/results/estimate_json.hpp"
#include "render/comparison/comparison_json.hpp"

namespace sweepscope {
namespace {

constexpr double kOff_s = 0.005;
constexpr double kMinRatio = 1.3;  // of a wall's widths: below this a face shows no difference

/// The maps 5 ms off and at the answer, and the face that shows the difference best.
Result<void> add_maps(ReportContent& content, const PreparedRecording& prepared, std::size_t live_points,
                      const Job& job) {
  const Recording& recording = *prepared.recording;
  const double offset_s = std::round(*content.estimate.offset_s * 1e5) / 1e5;  // as it is printed
  const std::vector<double> offsets_s{offset_s - kOff_s, offset_s};
  MapOptions options;
  options.assume = content.estimate.kind;
  options.walk = content.estimate.walk;
  auto built = build_maps(prepared, offsets_s, options, job);
  if (!built) return tl::unexpected(built.error());
  std::vector<MapOnPath> on_paths;
  for (OffsetMap& map : *built) {
    ComparedMap& next = content.maps.emplace_back();
    next.offset_s = map.offset_s;
    next.cloud = map.cloud;
    next.path = std::move(map.trajectory);
    next.consistency = map.consistency;
    measure_thickness(next, job);
    if (job.cancelled()) return failure(ExitCode::kInterrupted, "interrupted while measuring the map");
  }
  if (live_points > 0) {
    content.live = live_map(prepared, built->front().walk, content.maps, content.criteria, live_points, job);
    content.live->charts = evidence_charts(content);
    if (job.cancelled()) return failure(ExitCode::kInterrupted, "interrupted while measuring the map");
  }
  for (const ComparedMap& map : content.maps)
    on_paths.push_back({map.cloud.get(), map.path, map.thickness.get()});
  SectionSearch search;
  search.motor_axis = recording.rig.mount.axis;
  const auto found = best_section(on_paths, search);
  if (found && found->widths_mm.at(0) > kMinRatio * found->widths_mm.at(1)) content.section = found->section;
  return {};
}

/// The candidates of a walk's criteria: 5 units to either side of the answer, closer together near it. A
/// parabola through them gives the extrema, so that finer steps would not move them.
std::vector<OffsetRange> ranges_about(double offset_s, const SearchScale& scale) {
  const double middle_s = scale.unit_s * std::round(offset_s / scale.unit_s),
               half_s = std::min(5 * scale.unit_s, scale.max_half_width_s);
  return {{middle_s - half_s, middle_s + half_s, scale.unit_s},
          {middle_s - scale.unit_s, middle_s + scale.unit_s, scale.unit_s / 4}};
}

/// The paper's criteria of the same recording, along the same trajectory: evidence beside the answer.
Result<void> add_criteria(ReportContent& content, const PreparedRecording& prepared, CandidateStore* kept,
                          const Job& job) {
  EstimateOptions wanted;
  wanted.method = content.estimate.kind == RigKind::kMoving ? Method::kMoving : Method::kStationary;
  wanted.assume = content.estimate.kind;
  wanted.walk = content.estimate.walk;
  if (wanted.method == Method::kMoving)
    wanted.ranges = ranges_about(*content.estimate.offset_s, search_scale(prepared.motor));
  auto found = estimate(prepared, wanted, {kept, {}}, job);
  if (!found) return tl::unexpected(found.error());
  if (found->interrupted) return failure(ExitCode::kInterrupted, "interrupted while computing the criteria");
  content.criteria = std::move(*found);
  return {};
}

/// Of a recording that is long enough for the offset to have changed.
Result<void> add_over_time(ReportContent& content, const PreparedRecording& prepared,
                           std::optional<RigKind> assume, const Job& job) {
  if (!content.estimate.sample) return {};
  EstimateOptions wanted;
  wanted.assume = assume;
  wanted.over_time_s = 0;
  auto found = estimate(prepared, wanted, {}, job);
  if (!found) return tl::unexpected(found.error());
  if (found->interrupted) return failure(ExitCode::kInterrupted, "interrupted while following the offset");
  content.over_time = std::move(*found);
  return {};
}

/// Of a motor whose offset is a gauge: the maps with the rig as given and as found.
Result<void> add_maps_of_rigs(ReportContent& content, const Recording& given, const Job& job) {
  MapOptions options;
  options.assume = content.estimate.kind;
  const auto add = [&](const Recording& recording, const char* label) -> Result<void> {
    const double offset_s = 0;
    const auto built = build_maps(recording, {&offset_s, 1}, options, job);
    if (!built) return tl::unexpected(built.error());
    ComparedMap& next = content.maps.emplace_back(compared_map(recording, built->front()));
    next.label = label;
    measure_thickness(next, job);
    if (job.cancelled()) return failure(ExitCode::kInterrupted, "interrupted while measuring the map");
    return {};
  };
  return add(given, "rig as given").and_then([&] {
    return add(with_rig(given, *content.estimate.rig), "rig as found");
  });
}

/// All that stands beside the answer; `prepared` has the rig that the answer was found with.
Result<void> add_evidence(ReportContent& content, const PreparedRecording& prepared,
                          const ReportOptions& wanted, CandidateStore* kept, const Job& job) {
  if (auto followed = add_over_time(content, prepared, wanted.assume, job); !followed) return followed;
  if (!content.estimate.identifiable) return {};
  return add_criteria(content, prepared, kept, job).and_then([&] {
    return add_maps(content, prepared, wanted.live_points, job);
  });
}

}  // namespace

Result<ReportContent> gather_report(const PreparedRecording& prepared, const ReportOptions& wanted,
                                    CandidateStore* kept, const Job& job) {
  ReportContent content;
  content.recording = inspect(*prepared.recording);
  const MotionTest motion = test_motion(prepared);
  if (motion.answered()) content.recording.motion = motion.moving() ? "moving" : "stationary";
  EstimateOptions options;
  options.assume = wanted.assume;
  options.solve = wanted.solve;
  auto found = estimate(prepared, options, {}, job);
  if (!found) return tl::unexpected(found.error());
  if (found->interrupted) return failure(ExitCode::kInterrupted, "interrupted while looking for the offset");
  content.estimate = std::move(*found);
  if (const auto& part = content.estimate.stationary_part)
    return prepare(std::make_shared<const Recording>(part_of_whole(*prepared.recording, *part)),
                   prepared.feature_options, job)
        .and_then([&](const PreparedRecording& stationary) {
          return add_evidence(content, stationary, wanted, kept, job);
        })
        .map([&] { return std::move(content); });
  if (content.estimate.rig && content.estimate.offset_is_gauge())
    return add_maps_of_rigs(content, *prepared.recording, job).map([&] { return std::move(content); });
  if (!content.estimate.rig)
    return add_evidence(content, prepared, wanted, kept, job).map([&] { return std::move(content); });
  const Recording corrected = with_rig(*prepared.recording, *content.estimate.rig);
  return prepare(corrected, prepared.feature_options, job)
      .and_then([&](const PreparedRecording& as_found) {
        return add_evidence(content, as_found, wanted, kept, job);
      })
      .map([&] { return std::move(content); });
}

/// The estimate, and how thick the maps are.
std::string report_json(const ReportContent& content) {
  const std::string estimate = estimate_to_json(content.estimate, Timing::kNull);
  auto json = nlohmann::ordered_json::parse(estimate);
  for (const ComparedMap& map : content.maps) {
    if (!map.thickness || !map.thickness->map) continue;
    nlohmann::ordered_json thickness{{"offset_ms", std::round(*map.offset_s * 1e12) / 1e9}};
    if (!map.label.empty()) thickness["label"] = map.label;
    thickness.update(thickness_json(*map.thickness->map));
    json["map_thickness"].push_back(std::move(thickness));
  }
  return json_text(std::move(json));
}

Result<void> make_report_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) return {};
  return failure(ExitCode::kWrongUsage,
                 fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
}

std::vector<std::filesystem::path> report_files(const std::filesystem::path& folder) {
  return {folder / "report.html", folder / "estimate.json"};
}

Result<void> write_report(const ReportContent& content, const std::filesystem::path& folder, const Job& job) {
  return make_report_folder(folder)
      .and_then([&] { return report_html(content, job); })
      .and_then([&](const std::string& page) { return write_file(folder / "report.html", page); })
      .and_then([&] { return write_file(folder / "estimate.json", report_json(content)); });
}

}  // namespace sweepscope
