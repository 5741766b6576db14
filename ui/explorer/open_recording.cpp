#include "ui/explorer/open_recording.hpp"

#include <filesystem>

#include "ui/jobs/task_plans.hpp"

namespace sweepscope::ui {
namespace {

constexpr const char* kLoad = "load";

/// What there is to choose from in a file that cannot be opened as it was asked for.
std::optional<ReadingSurvey> choosable(const ReadingChoices& choices, const Job& job) {
  if (choices.file.empty() || job.cancelled()) return std::nullopt;
  auto survey = survey_file(choices, job);
  const bool any = survey && !(survey->streams.lasers.empty() && survey->streams.joints.empty());
  return any ? std::optional(std::move(*survey)) : std::nullopt;
}

}  // namespace

void OpenRecording::read(const ReadingChoices& choices, std::optional<Restored> restored) {
  std::filesystem::path file = choices.file;
  if (!file.has_filename()) file = file.parent_path();  // a folder
  start("Reading " + file.filename().string(), steps_of_loading(),
        [choices](const Job& job) { return load_file(choices, job); },
        {choices, std::move(restored), {}, {}, {}});
}

void OpenRecording::simulate(const std::string& scene, double seconds, std::optional<Restored> restored) {
  start("Simulating " + scene, steps_of_simulating(),
        [=](const Job& job) { return load_sample(scene, seconds, job); },
        {{}, std::move(restored), {}, {}, {}});
}

bool OpenRecording::is_opening() const {
  return background_.has(kLoad);
}

void OpenRecording::start(const std::string& title, std::vector<TaskStep> steps,
                          std::function<Result<LoadedPtr>(const Job&)> load, Opened result) {
  background_.cancel(kLoad);
  failure_.reset();
  background_.start(
      kLoad, kLoad, title,
      [this, load = std::move(load), result = std::move(result)](const Job& job) -> Background::Finish {
        Opened opened = result;
        opened.loaded = load(job);
        if (opened.loaded) {
          job.report("the first map", 0);
          const Loaded& loaded = **opened.loaded;
          // At 0 ms whatever the settings are, so that the same lines always give the same picture.
          opened.first_map = map_without_solving(loaded, was_stationary(loaded, assume_), 0, job);
        } else {
          opened.survey = choosable(opened.choices, job);
        }
        return [this, opened] {
          if (!opened.loaded) failure_ = opened.loaded.error();
          ended_(opened);
        };
      },
      std::move(steps));
}

}  // namespace sweepscope::ui
