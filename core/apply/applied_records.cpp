#include "core/apply/applied_records.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <memory>

#include "core/recording/ros2/mcap_extras.hpp"
#include "core/recording/streams/message_sink.hpp"

namespace sweepscope {
namespace {

constexpr std::uint64_t kMaxRecord_bytes = std::uint64_t{16} << 20;

Result<std::vector<std::string>> of_mcap(const std::filesystem::path& path) {
  const auto extras = find_mcap_extras(path);
  if (!extras) return tl::unexpected(extras.error());
  std::vector<std::string> records;
  for (const McapExtra& extra : extras->records) {
    if (extra.op != McapOp::kMetadata) continue;
    std::string content;
    const auto read = read_mcap_extra(path, extra, kMaxRecord_bytes, [&](std::string_view block) {
      content += block;
      return Result<void>();
    });
    if (!read) return tl::unexpected(read.error());
    McapFields fields(std::as_bytes(std::span(content)));
    if (fields.text() != kAppliedMetadata) continue;
    fields.number<std::uint32_t>();  // the bytes of the map
    fields.text();                   // the key
    records.emplace_back(fields.text());
  }
  return records;
}

/// Opened immutable: a database that sweepscope wrote has no journal.
std::vector<std::string> of_database(const std::filesystem::path& path) {
  sqlite3* opened = nullptr;
  const int code =
      sqlite3_open_v2(path.c_str(), &opened, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, nullptr);
  const std::unique_ptr<sqlite3, int (*)(sqlite3*)> database(opened, sqlite3_close);
  if (code != SQLITE_OK) return {};
  sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_stmt* prepared = nullptr;
  const std::string question = fmt::format("SELECT record FROM {} ORDER BY id", kAppliedTable);
  sqlite3_prepare_v2(opened, question.c_str(), -1, &prepared, nullptr);
  const std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> rows(prepared, sqlite3_finalize);
  std::vector<std::string> records;
  while (rows && sqlite3_step(rows.get()) == SQLITE_ROW) {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(rows.get(), 0));
    records.emplace_back(text == nullptr ? "" : text);
  }
  return records;
}

}  // namespace

Result<std::vector<std::string>> applied_records(const StreamFile& file) {
  if (file.format == StreamFormat::kMcap) return of_mcap(file.readable());
  if (file.format == StreamFormat::kSqlite) return of_database(file.readable());
  return std::vector<std::string>();
}

Result<void> check_not_applied(const StreamRecording& recording, bool has_record_topic) {
  bool applied = has_record_topic;
  for (const StreamFile& file : recording.files) {
    const auto records = applied_records(file);
    if (!records) return tl::unexpected(records.error());
    applied = applied || !records->empty();
  }
  if (!applied) return {};
  return failure(
      ExitCode::kWrongUsage,
      fmt::format("{}: an offset was applied before, see its record {}; apply another one with --again",
                  recording.path.string(), kAppliedMetadata));
}

}  // namespace sweepscope
