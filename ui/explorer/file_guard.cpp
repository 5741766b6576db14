#include "ui/explorer/file_guard.hpp"

#include "core/io/output_check.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "render/report/gather_report.hpp"

namespace sweepscope::ui {

std::string whole_path(const std::filesystem::path& path) {
  std::error_code failed;
  const auto whole = std::filesystem::absolute(path, failed);
  return failed ? path.string() : whole.lexically_normal().string();
}

Result<void> FileGuard::check(const Call& call) const {
  for (std::size_t i = 0; i < call.command->parameters.size(); ++i) {
    const Parameter& parameter = call.command->parameters[i];
    const std::string name = call.text(i);
    if (parameter.file == FileUse::kNone || (parameter.optional && name.empty())) continue;
    auto checked =
        parameter.file == FileUse::kRead ? roots_.check_read(name) : check_written(name, parameter.file);
    if (!checked) return checked;
  }
  return {};
}

Result<void> FileGuard::check_written(const std::string& name, FileUse use) const {
  const bool report = use == FileUse::kReport;
  std::vector<std::filesystem::path> files{name};
  if (report) files = report_files(name);
  for (const auto& file : files)
    if (auto inside = roots_.check_write(file); !inside) return inside;
  if (auto inside = roots_.check_write(name); !inside) return inside;
  if (is_session(name, use)) return {};
  return check_outputs(std::move(files), report ? name : "");
}

Result<void> FileGuard::check_reading(const ReadingChoices& choices) const {
  if (!roots_.limited()) return {};
  std::vector<std::filesystem::path> files{choices.file};
  if (!choices.poses.empty() && choices.poses != given_.poses) files.emplace_back(choices.poses);
  if (!choices.rig_file.empty() && choices.rig_file != given_.rig_file) files.emplace_back(choices.rig_file);
  for (const auto& file : files)
    if (auto inside = roots_.check_read(file); !inside) return inside;
  for (const auto& file : recording_files(choices.file))
    if (auto inside = roots_.check_read(file); !inside) return inside;
  return {};
}

Result<void> FileGuard::check_outputs(std::vector<std::filesystem::path> outputs,
                                      const std::filesystem::path& folder) const {
  return check_run_files({inputs_, std::move(outputs), folder});
}

std::string FileGuard::replaced_by(const Call& call) const {
  for (std::size_t i = 0; i < call.command->parameters.size(); ++i) {
    const FileUse use = call.command->parameters[i].file;
    std::filesystem::path path = call.text(i);
    if (use == FileUse::kNone || use == FileUse::kRead || path.empty()) continue;
    if (use == FileUse::kReport) path /= "report.html";
    std::error_code failed;
    const bool exists = roots_.can_write(path) && std::filesystem::exists(path, failed);
    return exists && !is_session(path, use) ? whole_path(path) : "";
  }
  return "";
}

void FileGuard::add_inputs(const ReadingChoices& choices) {
  for (const auto& file : recording_files(choices.file)) inputs_.push_back(file);
  for (const std::string& file : {choices.poses, choices.rig_file})
    if (!file.empty()) inputs_.emplace_back(file);
}

bool FileGuard::is_session(const std::filesystem::path& file, FileUse use) const {
  std::error_code ignored;
  return use == FileUse::kSession && std::filesystem::equivalent(file, session_, ignored);
}

}  // namespace sweepscope::ui
