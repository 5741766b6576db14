#include "ui/explorer/kept_answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace sweepscope::ui {
namespace {

constexpr std::size_t kMaxAnswers = 24;

/// Size and time of a file, or of all files of a folder.
std::string state_of(const std::filesystem::path& path) {
  std::error_code ignored;
  if (path.empty()) return "";
  const auto state = [&](const std::filesystem::path& file) {
    const auto written = std::filesystem::last_write_time(file, ignored).time_since_epoch().count();
    return fmt::format(" {} {}", std::filesystem::file_size(file, ignored), written);
  };
  if (!std::filesystem::is_directory(path, ignored)) return state(path);
  std::vector<std::string> states;
  for (const auto& entry : std::filesystem::directory_iterator(path, ignored))
    states.push_back(entry.path().filename().string() + state(entry.path()));
  std::ranges::sort(states);
  return fmt::format("{}", fmt::join(states, ","));
}

std::string key_of(const Loaded& loaded) {
  const ReadingChoices& read = loaded.choices;
  std::string key = loaded.source + to_json(read).dump();
  for (const std::string& file : {read.file, read.poses, read.rig_file}) key += state_of(file);
  return key;
}

}  // namespace

void KeptAnswers::keep(const Loaded& loaded, const Estimate& estimate) {
  const std::string key = key_of(loaded);
  std::erase_if(all_, [&](const auto& kept) { return kept.first == key; });
  all_.emplace_back(key, estimate);
  if (all_.size() > kMaxAnswers) all_.erase(all_.begin());
}

std::optional<Estimate> KeptAnswers::of(const Loaded& loaded) const {
  const auto found = std::ranges::find(all_, key_of(loaded), &std::pair<std::string, Estimate>::first);
  return found != all_.end() ? std::optional(found->second) : std::nullopt;
}

}  // namespace sweepscope::ui
