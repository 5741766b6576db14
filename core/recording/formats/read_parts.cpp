#include "core/recording/formats/read_parts.hpp"

#include <algorithm>

#include "core/recording/assemble/assemble.hpp"
#include "core/recording/formats/read_raw_recording.hpp"

namespace sweepscope {
namespace {

Result<Recording> read(const std::filesystem::path& path, const ReadOptions& options,
                       const ReadDetail& detail, const Job& job) {
  const Rig rig = options.rig.value_or(Rig{});
  auto raw = read_raw_recording(path, rig, job, detail);
  if (!raw) return tl::unexpected(std::move(raw.error()));
  for (RawLaser& laser : raw->lasers) {
    std::vector<float>().swap(laser.intensities);
    laser.has_intensities = false;
  }
  return assemble(std::move(*raw), rig, options.stamps);
}

}  // namespace

Result<Recording> read_without_ranges(const std::filesystem::path& path, const ReadOptions& options,
                                      const Job& job) {
  ReadDetail detail;
  detail.ranges = false;
  return read(path, options, detail, job);
}

Result<Recording> read_parts(const std::filesystem::path& path, const ReadOptions& options,
                             const Recording& outline, const std::vector<RecordingPart>& parts,
                             const Job& job) {
  if (!outline.ranges_m.empty() || outline.scans.empty()) return parts_of(outline, parts);
  const double begin_s = outline.scans.front().first_beam_s;
  std::vector<char> kept;
  const auto keep = [&](const LaserScan& scan) {
    if (scan.first_range >= kept.size()) kept.resize(scan.first_range + 1, 0);
    kept[scan.first_range] = 1;
  };
  for (const LaserScan& scan : outline.scans) {
    const double since_s = scan.first_beam_s - begin_s;
    const auto holds = [&](const RecordingPart& part) {
      return since_s >= part.begin_s && since_s <= part.end_s;
    };
    if (std::ranges::any_of(parts, holds)) keep(scan);
  }
  keep(outline.scans.front());
  keep(outline.scans.back());
  ReadDetail detail;
  detail.scans = &kept;
  ReadOptions same = options;
  same.rig = outline.rig;
  auto recording = read(path, same, detail, job);
  if (recording) recording->report = outline.report;
  return recording;
}

}  // namespace sweepscope
