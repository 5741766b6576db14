#include "core/campaign/row_file.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "core/campaign/campaign_json.hpp"
#include "core/io/atomic_file.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "core/results/sealed_line.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

std::string header_line() {
  return sealed_line("{\"schema\":\"sweepscope.rows/1\"}");
}

std::string line_of(const KeptRow& kept) {
  Json json;
  json["key"] = kept.key;
  json["row"] = row_to_json(kept.row);
  return sealed_line(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

Result<std::unique_ptr<RowFile>> RowFile::open(const std::filesystem::path& path) {
  auto opened = SealedFile::open(path);
  if (!opened) return tl::unexpected(opened.error());
  std::unique_ptr<RowFile> file(new RowFile(std::move(*opened)));
  if (auto taken = file->take_up(); !taken) return tl::unexpected(taken.error());
  return file;
}

Result<void> RowFile::take_up() {
  const auto text = file_.text();
  if (!text) return tl::unexpected(text.error());
  const std::string header = header_line();
  if (SealedFile::is_begun(*text, header)) return file_.begin(header);
  if (!text->starts_with(header))
    return unreadable(
        fmt::format("{}: is not a file of rows of estimate --table; move it away", file_.path().string()));
  std::size_t whole_bytes = header.size();
  for (std::size_t end = 0; (end = text->find('\n', whole_bytes)) != text->npos; whole_bytes = end + 1) {
    const std::string_view line(text->data() + whole_bytes, end - whole_bytes);
    if (!is_sound_line(line)) continue;
    try {
      const Json json = Json::parse(line);
      rows_[json.at("key").get<std::string>()] = row_from_json(json.at("row"));
    } catch (const std::exception&) {
      continue;  // of a later version: estimated again
    }
  }
  return file_.cut(whole_bytes);
}

std::optional<CampaignRow> RowFile::find(const std::string& key) const {
  const std::lock_guard lock(mutex_);
  const auto found = rows_.find(key);
  return found == rows_.end() ? std::nullopt : std::optional(found->second);
}

void RowFile::keep(const KeptRow& kept) {
  const std::lock_guard lock(mutex_);
  if (failed_) return;
  if (auto appended = file_.append(line_of(kept)); !appended) {
    failed_ = appended.error();
    return;
  }
  rows_[kept.key] = kept.row;
}

std::optional<Error> RowFile::failed() const {
  const std::lock_guard lock(mutex_);
  return failed_;
}

Result<void> RowFile::replace(const std::vector<KeptRow>& rows) {
  const std::lock_guard lock(mutex_);
  std::string text = header_line();
  for (const KeptRow& kept : rows) text += line_of(kept);
  return write_file(file_.path(), text);
}

std::optional<std::string> recording_fingerprint(const std::filesystem::path& recording) {
  std::string text;
  for (const std::filesystem::path& file : recording_files(recording)) {
    struct stat status {};
    if (stat(file.c_str(), &status) != 0) return std::nullopt;
    text += fmt::format("{}\n{} {}.{:09}\n", file.string(), status.st_size, status.st_mtim.tv_sec,
                        status.st_mtim.tv_nsec);
  }
  return text.empty() ? std::nullopt : std::optional(text);
}

}  // namespace sweepscope
