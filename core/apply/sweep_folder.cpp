#include "core/apply/sweep_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/apply/added_topics.hpp"
#include "core/apply/applied_records.hpp"
#include "core/io/abandoned_parts.hpp"
#include "core/io/atomic_folder.hpp"
#include "core/io/cloud_file.hpp"
#include "core/io/trajectory_file.hpp"
#include "core/offset/readings/fitting_recording.hpp"
#include "core/recording/streams/message_sink.hpp"
#include "core/recording/streams/message_stream.hpp"

namespace sweepscope {
namespace {

ClockShift shift_of(const Recording& recording, const AppliedOffset& offset) {
  const auto ns = [&](double time_s) { return recording.epoch_ns + std::llround(time_s * 1e9); };
  if (recording.scans.empty()) return ClockShift(offset.offset_s);
  return clock_shift(offset, ns(recording.scans.front().first_beam_s),
                     ns(recording.scans.back().first_beam_s));
}

}  // namespace

Result<WrittenSweeps> write_sweeps(Recording recording, const AppliedOffset& offset,
                                   const AddOptions& options, const std::filesystem::path& folder,
                                   const std::string& extension, const Job& job) {
  const ClockShift clocks = shift_of(recording, offset);
  const Recording corrected = without_offset(std::move(recording), clocks);
  const auto map = map_options(options, corrected);
  if (!map) return tl::unexpected(map.error());
  const auto prepared = prepare(corrected, map->features, job);
  if (!prepared) return tl::unexpected(prepared.error());
  const auto clouds = SweepClouds::create(*prepared, 0, *map, job);
  if (!clouds) return tl::unexpected(clouds.error());
  remove_abandoned_parts(folder);
  auto output = AtomicFolder::create(folder);
  if (!output) return tl::unexpected(output.error());
  WrittenSweeps written{clouds->size(), clouds->moving(), {}};
  if (!clouds->warning().empty()) written.warnings.push_back(clouds->warning());
  if (clouds->lost()) written.warnings.push_back("the motion could not be followed: do not trust the clouds");
  std::vector<StampedPose> poses;
  const double epoch_s = double(corrected.epoch_ns) * 1e-9;
  for (std::size_t i = 0; i < clouds->size(); ++i) {
    if (job.cancelled()) return failure(ExitCode::kInterrupted, "interrupted");
    SweepCloud cloud = clouds->at(i);
    for (MapPoint& point : cloud.points.points) point.time_s += epoch_s;  // the clock of poses.tum
    const auto path = output->part_path() / fmt::format("{:06}{}", i, extension);
    if (auto done = write_cloud(path, cloud.points); !done) return tl::unexpected(done.error());
    poses.push_back({cloud.begin_s, cloud.map_from_base.translation_m, cloud.map_from_base.rotation});
    job.report("writing", double(i + 1) / double(clouds->size()));
  }
  if (auto done = write_tum(output->part_path() / "poses.tum", poses, corrected.epoch_ns); !done)
    return tl::unexpected(done.error());
  if (auto done = output->commit(); !done) return tl::unexpected(done.error());
  return written;
}

Result<WrittenSweeps> write_applied_sweeps(const std::filesystem::path& path, const ApplyOptions& options,
                                           const std::filesystem::path& folder, const std::string& extension,
                                           const Job& job) {
  auto recording = read_fitting(path, {options.rig, options.stamps}, job);
  if (!recording) return tl::unexpected(recording.error());
  const auto stream = open_stream(path, job);
  if (!options.again && stream) {
    const auto& topics = recording->report.topics;
    const bool has_record = std::ranges::find(topics, kAppliedTopic, &RecordedTopic::name) != topics.end();
    if (const auto checked = check_not_applied(*stream, has_record); !checked)
      return tl::unexpected(checked.error());
  }
  if (const auto checked = check_within_period(*recording, options); !checked)
    return tl::unexpected(checked.error());
  return write_sweeps(std::move(*recording), options.offset, options.add, folder, extension, job);
}

}  // namespace sweepscope
