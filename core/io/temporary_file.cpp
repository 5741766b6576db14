#include "core/io/temporary_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "core/io/unfinished_files.hpp"

namespace sweepscope {

Result<TemporaryFile> TemporaryFile::create() {
  const auto refused = [](const std::string& folder, const std::string& why) {
    return failure(
        ExitCode::kWrongUsage,
        fmt::format("{}: no temporary file can be made: {}; set TMPDIR to a folder with room", folder, why));
  };
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) return refused("TMPDIR", error.message());
  std::string pattern = (folder / "sweepscope-XXXXXX").string();
  const int descriptor = mkstemp(pattern.data());
  if (descriptor < 0) return refused(folder.string(), std::strerror(errno));
  close(descriptor);
  remember_unfinished(pattern);
  return TemporaryFile(pattern);
}

TemporaryFile::~TemporaryFile() {
  if (path_.empty()) return;
  std::remove(path_.c_str());
  forget_unfinished(path_);
}

}  // namespace sweepscope
