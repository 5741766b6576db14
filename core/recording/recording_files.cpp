#include "core/recording/recording_files.hpp"

#include "core/recording/csv_recording.hpp"
#include "core/recording/ros2_recording.hpp"

namespace sweepscope {

namespace fs = std::filesystem;

std::vector<fs::path> recording_files(const fs::path& recording) {
  std::error_code ignored;
  std::vector<fs::path> named{recording};
  if (fs::is_directory(recording, ignored)) {
    named = ros2_files(recording);
    named.push_back(recording / kScansCsv);
    named.push_back(recording / kMotorCsv);
  }
  std::vector<fs::path> files;
  for (const fs::path& file : named)
    for (const char* of_database : {"", "-wal", "-shm", "-journal"})
      if (const fs::path path = file.string() + of_database; fs::exists(path, ignored)) files.push_back(path);
  return files;
}

}  // namespace sweepscope
