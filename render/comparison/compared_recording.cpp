#include "render/comparison/compared_recording.hpp"

#include <algorithm>
#include <utility>

#include "core/map/feature_points.hpp"
#include "render/comparison/scanner_pose.hpp"

namespace sweepscope {

Result<void> check_offset_count(std::size_t offsets) {
  if (offsets < 2 || offsets > 4)
    return failure(ExitCode::kWrongUsage,
                   "compare of a recording needs two to four offsets, such as --offsets-ms 19,24");
  return {};
}

Result<ComparedRecording> compared_recording(const PreparedRecording& prepared,
                                             std::span<const double> offsets_s, const MapOptions& options,
                                             bool by_features, const Job& job) {
  if (const auto counted = check_offset_count(offsets_s.size()); !counted)
    return tl::unexpected(counted.error());
  auto built = build_maps(prepared, offsets_s, options, job);
  if (!built) return tl::unexpected(built.error());
  ComparedRecording compared;
  compared.moving = built->front().moving;
  compared.walk = built->front().walk;
  compared.warning = built->front().warning;
  for (OffsetMap& map : *built) {
    ComparedMap& next = compared.maps.emplace_back();
    next.offset_s = map.offset_s;
    next.cloud = map.cloud;
    next.scanner = scanner_pose(*prepared.recording, map.trajectory, map.offset_s);
    next.path = std::move(map.trajectory);
    if (by_features) next.feature_kinds = feature_kinds(*prepared.features, *map.cloud);
  }
  return compared;
}

EstimateOptions criteria_about(const ComparedRecording& compared, std::span<const double> offsets_ms) {
  const auto [least, greatest] = std::minmax_element(offsets_ms.begin(), offsets_ms.end());
  EstimateOptions wanted;
  wanted.method = compared.moving ? Method::kMoving : Method::kStationary;
  wanted.walk = compared.walk;
  wanted.ranges = {{(*least - 5) * 1e-3, (*greatest + 5) * 1e-3, 1e-3}};
  return wanted;
}

}  // namespace sweepscope
