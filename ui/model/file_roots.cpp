#include "ui/model/file_roots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/io/atomic_file.hpp"
#include "core/io/printable_text.hpp"

namespace sweepscope::ui {
namespace {

namespace fs = std::filesystem;

/// From the root of the file system, without links and dots. Nothing if that cannot be found out.
std::optional<fs::path> resolved(const fs::path& path) {
  std::error_code failed;
  const auto target = behind_links(path);
  if (!target) return std::nullopt;
  const fs::path whole = fs::absolute(*target, failed);
  if (failed) return std::nullopt;
  fs::path plain = fs::weakly_canonical(whole, failed);
  if (failed) return std::nullopt;
  // Dots after a folder that does not exist, and a link that leads nowhere in the middle, are not followed.
  for (const fs::path& part : plain)
    if (part == "..") return std::nullopt;
  if (!plain.has_filename()) plain = plain.parent_path();
  return plain;
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

bool lies_in_any(const fs::path& path, const std::vector<fs::path>& folders) {
  const auto plain = resolved(path);
  return plain && std::any_of(folders.begin(), folders.end(),
                              [&](const fs::path& folder) { return lies_in(*plain, folder); });
}

}  // namespace

Result<FileRoots> FileRoots::of(std::span<const fs::path> folders) {
  FileRoots roots;
  for (const fs::path& folder : folders) {
    std::error_code failed;
    const auto plain = resolved(folder);
    if (!plain || !fs::is_directory(*plain, failed))
      return failure(ExitCode::kWrongUsage,
                     fmt::format("--root {}: there is no such folder", printable_line(folder.string())));
    roots.folders_.push_back(*plain);
  }
  return roots;
}

void FileRoots::allow_reading(const fs::path& path) {
  if (const auto plain = resolved(path)) readable_.push_back(*plain);
}

bool FileRoots::can_read(const fs::path& path) const {
  return !limited() || lies_in_any(path, folders_) || lies_in_any(path, readable_);
}

bool FileRoots::can_write(const fs::path& path) const {
  return !limited() || lies_in_any(path, folders_);
}

Result<void> FileRoots::check_read(const fs::path& path) const {
  if (can_read(path)) return {};
  return tl::unexpected(outside(path));
}

Result<void> FileRoots::check_write(const fs::path& path) const {
  if (can_write(path)) return {};
  return tl::unexpected(outside(path));
}

Error FileRoots::outside(const fs::path& path) const {
  std::string names;
  for (const fs::path& folder : folders_) names += (names.empty() ? "" : ", ") + folder.string();
  return {ExitCode::kWrongUsage,
          fmt::format("{}: lies outside of the folders that this program may open (--root): {}",
                      path.string(), names)};
}

}  // namespace sweepscope::ui
