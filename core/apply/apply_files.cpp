#include "core/apply/apply_files.hpp"

#include <utility>

#include "core/io/output_check.hpp"
#include "core/recording/formats/read_raw_recording.hpp"

namespace sweepscope {

Result<void> check_apply_files(const std::filesystem::path& recording, const std::filesystem::path& output,
                               const std::optional<std::filesystem::path>& sweeps,
                               std::vector<std::filesystem::path> others) {
  std::vector<std::filesystem::path> inputs = recording_files(recording);
  inputs.insert(inputs.end(), others.begin(), others.end());
  if (sweeps)
    if (auto checked = check_run_files({inputs, {*sweeps / "poses.tum"}, *sweeps});
        !checked || output.empty())
      return checked;
  const bool folder = !output.has_filename() || output.extension().empty();
  if (folder) return check_run_files({std::move(inputs), {output / "metadata.yaml"}, output});
  return check_run_files({std::move(inputs), {output}, {}});
}

}  // namespace sweepscope
