#pragma once

#include <filesystem>
#include <vector>

namespace sweepscope {

/// The files that a recording consists of, so that nothing is written over them: the file itself and, beside
/// a database, its journals; of a folder its CSV tables and, where it is a ROS 2 bag, metadata.yaml and every
/// file that is stored as one. Files that do not exist are not listed; nothing is read beyond their
/// beginnings.
std::vector<std::filesystem::path> recording_files(const std::filesystem::path& recording);

}  // namespace sweepscope
