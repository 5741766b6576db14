#include "ui/explorer/rig_recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/recording/formats/read_recording.hpp"
#include "core/together/estimate_together.hpp"

namespace sweepscope::ui {
namespace {

constexpr const char* kTogether = "together";

tl::unexpected<Error> refused(std::string why) {
  return failure(ExitCode::kWrongUsage, std::move(why));
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code unknown;
  return a == b || std::filesystem::equivalent(a, b, unknown);
}

// `file`, read like the recording that is open.
Result<Recording> read_like(const ReadingChoices& open, const std::string& file, const Job& job) {
  ReadingChoices choices = open;
  choices.file = file;
  return read_options(choices).and_then(
      [&](const ReadOptions& options) { return read_recording(file, options, job); });
}

Result<Estimate> estimate_of_all(const Loaded& open, const std::vector<std::string>& files,
                                 const EstimateOptions& options, bool own_offsets, const Job& job) {
  std::vector<Recording> others;
  others.reserve(files.size());  // sources point to them
  std::vector<RecordingSource> sources;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (files[i] == open.choices.file) {
      sources.emplace_back(open.prepared);
      continue;
    }
    job.report("reading", double(i) / double(files.size()));
    auto read = read_like(open.choices, files[i], job);
    if (!read) return tl::unexpected(read.error());
    others.push_back(std::move(*read));
    sources.emplace_back(others.back());
  }
  return estimate_together(sources, options, own_offsets, job);
}

}  // namespace

Result<void> RigRecordings::add(const Loaded* open, const std::string& file) {
  if (open == nullptr || open->choices.file.empty())
    return refused("Open a recording from a file first: others of its rig are added to it.");
  const std::string& of_open = open->choices.file;
  const auto is_it = [&](const std::string& other) { return is_same_file(other, file); };
  if (is_it(of_open) || std::ranges::any_of(files_, is_it)) return refused(file + " is in the list already.");
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown))
    return failure(ExitCode::kUnreadableInput, file + ": there is no such file or folder");
  if (files_.empty()) files_.push_back(of_open);
  files_.push_back(file);
  return {};
}

Result<void> RigRecordings::leave_out(const Loaded* open, std::size_t number) {
  if (number < 1 || number > files_.size())
    return refused(fmt::format("The list has no recording {}.", number));
  if (open != nullptr && files_[number - 1] == open->choices.file)
    return refused("The recording that is open cannot be left out: open another one of the list first.");
  files_.erase(files_.begin() + std::ptrdiff_t(number - 1));
  if (files_.size() == 1) files_.clear();
  return {};
}

void RigRecordings::opened(const Loaded* loaded) {
  const auto listed = std::ranges::find_if(files_, [&](const std::string& file) {
    return loaded != nullptr && is_same_file(file, loaded->choices.file);
  });
  if (listed == files_.end()) return files_.clear();
  *listed = loaded->choices.file;  // as it was opened: the one that is open is known by it
}

Result<void> RigRecordings::estimate(LoadedPtr open, const EstimateOptions& options, bool own_offsets) {
  if (files_.empty()) return refused("Add other recordings of this rig first.");
  background_.cancel(kTogether);
  background_.start("estimate", kTogether, "Estimating from all recordings",
                    [this, open = std::move(open), files = files_, options,
                     own_offsets](const Job& job) -> Background::Finish {
                      auto found = std::make_shared<Result<Estimate>>(
                          estimate_of_all(*open, files, options, own_offsets, job));
                      return [this, found] {
                        if (!*found) return messages_.error(found->error());
                        found_(std::move(**found));
                      };
                    });
  return {};
}

bool RigRecordings::is_running() const {
  return background_.has(kTogether);
}

}  // namespace sweepscope::ui
