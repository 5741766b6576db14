#include "core/recording/ros1/ros_libraries.hpp"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "core/io/temporary_file.hpp"

namespace sweepscope {
namespace {

constexpr const char* kName = "ROS_HOME";

}  // namespace

RosHome::RosHome() {
  std::error_code error;
  const std::filesystem::path place = std::filesystem::temp_directory_path(error);
  std::string pattern = unique_pattern(place / "sweepscope-");
  if (error || mkdtemp(pattern.data()) == nullptr) return;
  folder_ = pattern;
  if (const char* before = std::getenv(kName)) before_ = before;
  setenv(kName, pattern.c_str(), 1);
}

RosHome::~RosHome() {
  if (folder_.empty()) return;
  const int reason = errno;  // of what failed meanwhile
  if (before_)
    setenv(kName, before_->c_str(), 1);
  else
    unsetenv(kName);
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
  errno = reason;
}

}  // namespace sweepscope
