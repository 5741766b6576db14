#include "core/recording/formats/read_recording.hpp"

#include <set>
#include <string>
#include <vector>

#include "core/recording/assemble/assemble.hpp"
#include "core/recording/formats/read_raw_recording.hpp"

namespace sweepscope {

Result<Recording> read_recording(const std::filesystem::path& path, const ReadOptions& options,
                                 const Job& job) {
  const Rig rig = options.rig.value_or(Rig{});
  auto raw = read_raw_recording(path, rig, job);
  if (!raw) return tl::unexpected(std::move(raw.error()));
  std::set<std::string> with_intensities;
  for (RawLaser& laser : raw->lasers) {
    if (laser.intensities.empty()) continue;
    with_intensities.insert(laser.topic);
    if (options.keep_intensities) continue;
    std::vector<float>().swap(laser.intensities);
    laser.has_intensities = false;
  }
  auto recording = assemble(std::move(*raw), rig, options.stamps);
  if (recording) recording->report.intensities = with_intensities.contains(*recording->rig.laser.topic);
  return recording;
}

}  // namespace sweepscope
