#include "ui/model/file_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>

namespace sweepscope::ui {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxEntries = 2000;

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool begins_with(const std::string& text, const std::string& beginning) {
  return text.size() >= beginning.size() && std::equal(beginning.begin(), beginning.end(), text.begin(),
                                                       [](char a, char b) { return lower(a) == lower(b); });
}

/// A session or an estimate: their first key is the schema.
bool is_own_json(std::string_view begin) {
  return begin.starts_with("{") && (begin.find("\"sweepscope.session/") != begin.npos ||
                                    begin.find("\"sweepscope.estimate/") != begin.npos);
}

/// By content, as the readers distinguish formats.
bool opens(const fs::path& file) {
  using namespace std::string_view_literals;
  constexpr std::array kBeginnings{"#ROSBAG V2"sv, "\x89MCAP0"sv, "SQLite format 3"sv};
  std::array<char, 128> bytes{};
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), bytes.size());
  const std::string_view begin(bytes.data(), static_cast<std::size_t>(in.gcount()));
  if (begin.starts_with("\x28\xB5\x2F\xFD")) return file.stem().extension() == ".db3";
  if (is_own_json(begin)) return true;
  return std::any_of(kBeginnings.begin(), kBeginnings.end(),
                     [&](std::string_view known) { return begin.starts_with(known); });
}

FileEntry entry_of(const fs::directory_entry& found) {
  std::error_code failed;
  FileEntry entry;
  entry.name = found.path().filename().string();
  entry.folder = found.is_directory(failed);
  if (entry.folder) {
    entry.opens = opens_as_recording(found.path());
  } else if (found.is_regular_file(failed)) {  // a pipe would wait without end
    entry.opens = opens(found.path());
    const std::uintmax_t bytes = found.file_size(failed);
    entry.bytes = failed ? 0 : bytes;
  }
  return entry;
}

}  // namespace

bool opens_as_recording(const fs::path& folder) {
  std::error_code failed;
  for (const char* file : {"metadata.yaml", "scans.csv"})
    if (fs::is_regular_file(folder / file, failed)) return true;
  return false;
}

std::vector<FileEntry> list_folder(const fs::path& folder) {
  std::vector<FileEntry> entries;
  std::error_code failed;
  fs::directory_iterator at(folder.empty() ? "." : folder, fs::directory_options::skip_permission_denied,
                            failed);
  for (; !failed && at != fs::directory_iterator() && entries.size() < kMaxEntries; at.increment(failed)) {
    if (at->path().filename().string().starts_with(".")) continue;
    entries.push_back(entry_of(*at));
  }
  std::sort(entries.begin(), entries.end(), [](const FileEntry& a, const FileEntry& b) {
    return a.folder != b.folder ? a.folder : a.name < b.name;
  });
  return entries;
}

TypedPath split_typed(const std::string& typed) {
  const std::size_t slash = typed.rfind('/');
  if (slash == std::string::npos) return {"", typed == "~" ? "" : typed};
  return {typed.substr(0, slash + 1), typed.substr(slash + 1)};
}

std::string without_tilde(const std::string& typed, const std::string& home) {
  if (home.empty() || (typed != "~" && !typed.starts_with("~/"))) return typed;
  return home + typed.substr(1);
}

std::string home_folder() {
  const char* home = std::getenv("HOME");
  return home != nullptr && *home == '/' ? home : "";
}

std::vector<FileEntry> matching(const std::vector<FileEntry>& entries, const std::string& name, bool all) {
  std::vector<FileEntry> found;
  for (const FileEntry& entry : entries)
    if (begins_with(entry.name, name) && (all || entry.folder || entry.opens)) found.push_back(entry);
  return found;
}

std::string completed(const std::string& typed, const std::vector<FileEntry>& matching) {
  if (matching.empty()) return typed;
  std::string common = matching.front().name;
  for (const FileEntry& entry : matching) {
    const auto [end, ignored] =
        std::mismatch(common.begin(), common.end(), entry.name.begin(), entry.name.end());
    common.erase(end, common.end());
  }
  const TypedPath path = split_typed(typed);
  if (common.size() < path.name.size()) return typed;  // they agree but for upper and lower case
  return path.folder + common + (matching.size() == 1 && matching.front().folder ? "/" : "");
}

std::string size_in_words(std::uintmax_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (bytes >= 1000000000) return fmt::format("{:.1f} GB", value / 1e9);
  if (bytes >= 1000000) return fmt::format("{:.1f} MB", value / 1e6);
  if (bytes >= 1000) return fmt::format("{:.0f} kB", value / 1e3);
  return fmt::format("{} B", bytes);
}

}  // namespace sweepscope::ui
