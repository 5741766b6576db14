#include "ui/recent.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "core/io/atomic_file.hpp"

namespace sweepscope::ui {
namespace {

constexpr std::size_t kMax = 8;

}  // namespace

std::filesystem::path recent_list_path() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state == '/')
    return std::filesystem::path(state) / "sweepscope" / "recent";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/')
    return std::filesystem::path(home) / ".local/state/sweepscope/recent";
  return {};
}

std::vector<std::string> read_recent(const std::filesystem::path& list) {
  std::vector<std::string> recent;
  const auto text = list.empty() ? Result<std::string>("") : read_file(list);
  if (!text) return recent;
  std::istringstream lines(*text);
  std::error_code ignored;
  for (std::string line; std::getline(lines, line) && recent.size() < kMax;) {
    // A recording is a file or a folder.
    if (!line.empty() && std::filesystem::exists(line, ignored)) recent.push_back(line);
  }
  return recent;
}

std::vector<std::string> remember_recent(const std::filesystem::path& list, std::vector<std::string> recent,
                                         const std::string& file) {
  std::error_code ignored;
  const std::string path = std::filesystem::absolute(file, ignored).string();
  std::erase(recent, path);
  recent.insert(recent.begin(), path);
  if (recent.size() > kMax) recent.resize(kMax);
  if (list.empty()) return recent;
  std::string text;
  for (const std::string& line : recent) text += line + "\n";
  std::filesystem::create_directories(list.parent_path(), ignored);
  (void)write_file(list, text);
  return recent;
}

}  // namespace sweepscope::ui
