#include "core/io/output_check.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "core/io/atomic_file.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

/// What makes a file the same as another: device and inode; of a file that does not exist yet those of its
/// folder, and its name.
using Identity = std::tuple<dev_t, ino_t, std::string>;

std::optional<Identity> identity_of(const fs::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0) {
    if (!S_ISREG(status.st_mode)) return std::nullopt;
    return Identity{status.st_dev, status.st_ino, ""};
  }
  const auto target = behind_links(path);
  if (!target) return std::nullopt;
  const fs::path folder = target->has_parent_path() ? target->parent_path() : fs::path(".");
  if (stat(folder.c_str(), &status) != 0) return std::nullopt;
  return Identity{status.st_dev, status.st_ino, target->filename().string()};
}

/// Whether a folder can be made, and the missing ones above it.
Result<void> check_folder(const fs::path& folder) {
  std::error_code error;
  fs::path there = fs::absolute(folder, error);
  while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, error))
    return failure(ExitCode::kWrongUsage, fmt::format("{}: is not a folder", there.string()));
  if (access(there.c_str(), W_OK | X_OK) == 0) return {};
  return failure(ExitCode::kWrongUsage,
                 fmt::format("{}: cannot be written: {}", there.string(), std::strerror(errno)));
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  return !folder.empty() && file.parent_path() == (folder / "x").parent_path();
}

Result<void> check_output(const fs::path& output, const fs::path& folder) {
  std::error_code ignored;
  if (lies_in(output, folder) && !fs::exists(folder, ignored)) return check_folder(folder);
  return check_writable(output);
}

}  // namespace

Result<void> check_run_files(const RunFiles& files) {
  std::map<Identity, fs::path> inputs, outputs;
  for (const fs::path& input : files.inputs)
    if (const auto identity = identity_of(input)) inputs.emplace(*identity, input);
  for (const fs::path& output : files.outputs) {
    const auto refuse = [&](const std::string& why) {
      return failure(ExitCode::kWrongUsage, fmt::format("{}: {}", output.string(), why));
    };
    if (const auto identity = identity_of(output)) {
      const auto input = inputs.find(*identity);
      if (input != inputs.end())
        return refuse(input->second == output
                          ? std::string("is an input of this command and would be overwritten")
                          : fmt::format("is the same file as the input {}, which would be overwritten",
                                        input->second.string()));
      const auto [other, is_new] = outputs.emplace(*identity, output);
      if (!is_new)
        return refuse(other->second == output
                          ? std::string("two outputs of this command would be written to it")
                          : fmt::format("is the same file as the output {}", other->second.string()));
    }
    if (auto checked = check_output(output, files.folder); !checked) return checked;
  }
  return {};
}

}  // namespace sweepscope
