#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sweepscope::ui {

/// An entry of a folder, for a dialog.
struct FileEntry {
  std::string name;
  bool folder = false;
  bool opens =
      false;  // a recording, a session or an estimate, by its first bytes; a folder: a recording of files
  std::uintmax_t bytes = 0;

  bool operator==(const FileEntry&) const = default;
};

/// What a folder holds, without hidden entries: folders, then files, each by name. At most 2000; empty if it
/// cannot be read.
std::vector<FileEntry> list_folder(const std::filesystem::path& folder);

/// Whether a folder is a recording: a ROS 2 bag, or tables.
bool opens_as_recording(const std::filesystem::path& folder);

/// A typed path: its folder as it was typed, up to the last slash, and what comes after it.
struct TypedPath {
  std::string folder, name;
};
TypedPath split_typed(const std::string& typed);

/// "~" and "~/..." with the home folder; any other path as it is.
std::string without_tilde(const std::string& typed, const std::string& home);
/// The home folder of this user; empty without one.
std::string home_folder();

/// The entries whose name begins with `name`, in any case; files that do not open only if `all`.
std::vector<FileEntry> matching(const std::vector<FileEntry>& entries, const std::string& name, bool all);

/// The typed path completed as far as all matching entries agree, with a slash after the only folder.
std::string completed(const std::string& typed, const std::vector<FileEntry>& matching);

/// "24.1 MB"
std::string size_in_words(std::uintmax_t bytes);

}  // namespace sweepscope::ui
