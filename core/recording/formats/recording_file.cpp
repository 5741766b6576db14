#include "core/recording/formats/recording_file.hpp"

#include <algorithm>
#include <utility>

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

Result<Recording> read_outline(const std::filesystem::path& path, const ReadOptions& options,
                               std::size_t max_beams, const Job& job) {
  ReadDetail detail;
  detail.max_beams = max_beams;
  return read(path, options, detail, job);
}

Result<RecordingFile> RecordingFile::open(std::filesystem::path path, ReadOptions options, const Job& job,
                                          std::size_t max_beams) {
  return read_outline(path, options, max_beams, job).map([&](Recording&& outline) {
    RecordingFile file(std::move(outline));
    file.path_ = std::move(path);
    file.options_ = std::move(options);
    return file;
  });
}

Result<Recording> RecordingFile::parts(const std::vector<RecordingPart>& parts, const Job& job) const {
  if (is_whole()) return parts_of(outline_, parts);
  const double begin_s = outline_.scans.front().first_beam_s;
  std::vector<char> kept;
  const auto keep = [&](const LaserScan& scan) {
    if (scan.first_range >= kept.size()) kept.resize(scan.first_range + 1, 0);
    kept[scan.first_range] = 1;
  };
  for (const LaserScan& scan : outline_.scans) {
    const double since_s = scan.first_beam_s - begin_s;
    const auto holds = [&](const RecordingPart& part) {
      return since_s >= part.begin_s && since_s <= part.end_s;
    };
    if (std::ranges::any_of(parts, holds)) keep(scan);
  }
  keep(outline_.scans.front());
  keep(outline_.scans.back());
  ReadDetail detail;
  detail.scans = &kept;
  ReadOptions same = options_;
  same.rig = outline_.rig;
  auto recording = read(path_, same, detail, job);
  if (recording) recording->report = outline_.report;
  return recording;
}

Result<Recording> RecordingFile::whole(const Job& job) const {
  if (is_whole()) return outline_;
  auto recording = read(path_, options_, {}, job);
  if (recording) recording->report = outline_.report;
  return recording;
}

}  // namespace sweepscope
