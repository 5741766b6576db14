#include "core/recording/ros2/sqlite_bag.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <memory>

#include "core/io/input_file.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

constexpr int kStepsPerLook = 100'000;  // of SQLite's machine, between looks at the job

using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;
using Statement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

/// How a database is opened. None of them makes a file beside it, nor changes one.
enum class Opening {
  kAsItLies,     // journals left alone: there are none, or they cannot be read
  kShared,       // with the files of another program that has it open
  kWithJournal,  // with a write-ahead journal that is not open elsewhere: SQLite keeps its index in memory
};

const char* parameters(Opening opening) {
  switch (opening) {
    case Opening::kAsItLies:
      return "?immutable=1";
    case Opening::kShared:
      return "?mode=ro";
    case Opening::kWithJournal:
      // An index in memory requires an exclusive lock, which cannot be taken for reading only. A program that
      // writes to the database keeps its index in a file, so no other program needs the lock.
      return "?mode=ro&vfs=unix-none";
  }
  return "";
}

/// "file:" with what has a meaning in it escaped.
std::string uri_of(const fs::path& path, Opening opening) {
  std::string uri = "file:";
  for (const char c : fs::absolute(path).string()) {
    if (c == '%' || c == '?' || c == '#')
      uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    else
      uri += c;
  }
  return uri + parameters(opening);
}

/// A file beside the database: "-wal", its write-ahead journal; "-shm", that one's index; "-journal", what
/// takes a transaction back.
bool holds_bytes(const fs::path& database, const char* suffix) {
  std::error_code error;
  const auto bytes = fs::file_size(database.string() + suffix, error);
  return !error && bytes > 0;
}

/// Whether a program has the write-ahead journal open: each holds a lock on its index. One that was killed
/// leaves the index, and no lock.
bool journal_in_use(const fs::path& database) {
  const int file = ::open((database.string() + "-shm").c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return errno != ENOENT;
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  const bool known = fcntl(file, F_GETLK, &lock) == 0;
  close(file);
  return !known || lock.l_type != F_UNLCK;
}

Opening opening_of(const fs::path& database) {
  if (holds_bytes(database, "-wal"))
    return journal_in_use(database) ? Opening::kShared : Opening::kWithJournal;
  return holds_bytes(database, "-journal") ? Opening::kShared : Opening::kAsItLies;
}

/// Reads one bag.
class SqliteReader {
 public:
  SqliteReader(const fs::path& path, const SqliteVisitor& visit, const Job& job,
               const SqliteTopicVisitor& visit_topic)
      : path_(path), visit_(visit), visit_topic_(visit_topic), job_(job) {}

  Result<std::vector<std::string>> read();

 private:
  bool open(Opening opening);
  bool begin();
  bool must_be_taken_back();
  Statement prepare(const char* sql);
  bool read_topics();
  void read_descriptions();
  std::string text_of(sqlite3_stmt* row, int column);
  std::optional<Error> read_messages();
  std::optional<Error> visit_row(sqlite3_stmt* row);
  bool has_table(const char* name);
  Error unreadable_because(const std::string& why) const;
  std::string problem() const { return sqlite3_errmsg(database_.get()); }
  /// Of the job and not of SQLite, whose last error is that of the statement asked last.
  bool interrupted() const { return job_.cancelled(); }

  fs::path path_;
  const SqliteVisitor& visit_;
  const SqliteTopicVisitor& visit_topic_;
  const Job& job_;
  Database database_{nullptr, sqlite3_close};
  std::map<std::int64_t, SqliteTopic> topics_;
  std::int64_t last_id_ = 0, visited_ = 0, max_ids_ = 0;
  std::size_t orphans_ = 0;
  std::vector<std::string> warnings_;
};

Error SqliteReader::unreadable_because(const std::string& why) const {
  if (interrupted())
    return {ExitCode::kInterrupted, fmt::format("{}: reading was interrupted", path_.string())};
  return {ExitCode::kUnreadableInput, fmt::format("{}: {}", path_.string(), why)};
}

bool SqliteReader::open(Opening opening) {
  sqlite3* database = nullptr;
  const int code = sqlite3_open_v2(uri_of(path_, opening).c_str(), &database,
                                   SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
  database_.reset(database);
  if (code != SQLITE_OK) return false;
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH, kMaxSqliteMessage_bytes);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  // Without this the last one to close a journal writes it into the database and removes it.
  sqlite3_db_config(database, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  if (opening == Opening::kWithJournal)
    sqlite3_exec(database, "PRAGMA locking_mode = EXCLUSIVE", nullptr, nullptr, nullptr);
  const auto look = [](void* job) { return static_cast<const Job*>(job)->cancelled() ? 1 : 0; };
  sqlite3_progress_handler(database, kStepsPerLook, look, const_cast<Job*>(&job_));
  return true;
}

Statement SqliteReader::prepare(const char* sql) {
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr);
  return {statement, sqlite3_finalize};
}

bool SqliteReader::has_table(const char* name) {
  const Statement statement = prepare("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = ?");
  return statement && sqlite3_bind_text(statement.get(), 1, name, -1, SQLITE_STATIC) == SQLITE_OK &&
         sqlite3_step(statement.get()) == SQLITE_ROW;
}

/// Whether the recorder was ended within a write, which is half done in the database. SQLite takes it back,
/// which a reader must not.
bool SqliteReader::must_be_taken_back() {
  has_table("topics");
  return sqlite3_extended_errcode(database_.get()) == SQLITE_READONLY_ROLLBACK;
}

/// Opens the database, with the journal of a recorder that was not ended where there is one. A file shorter
/// than its header says is read all the same, as far as it goes.
bool SqliteReader::begin() {
  const Opening opening = opening_of(path_);
  if (!open(opening)) return false;
  if (holds_bytes(path_, "-wal") && !has_table("topics")) {
    warnings_.push_back(fmt::format("it was never closed, and its journal {}-wal could not be read: {}",
                                    path_.filename().string(), problem()));
    if (!open(Opening::kAsItLies)) return false;
  }
  if (has_table("topics")) return true;
  const int code = sqlite3_errcode(database_.get());
  if (code != SQLITE_CORRUPT && code != SQLITE_NOTADB) return true;
  // Only for reading: with it SQLite believes the file's length, and not its header's.
  sqlite3_exec(database_.get(), "PRAGMA writable_schema = ON", nullptr, nullptr, nullptr);
  if (has_table("topics"))
    warnings_.push_back("it is damaged or cut short; the intact part before the damage was read");
  return true;
}

std::string SqliteReader::text_of(sqlite3_stmt* row, int column) {
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return bytes == nullptr ? "" : bytes;
}

bool SqliteReader::read_topics() {
  const Statement rows = prepare("SELECT id, name, type, serialization_format FROM topics");
  if (!rows) return false;
  int code = 0;
  while ((code = sqlite3_step(rows.get())) == SQLITE_ROW)
    topics_[sqlite3_column_int64(rows.get(), 0)] = {text_of(rows.get(), 1), text_of(rows.get(), 2),
                                                    text_of(rows.get(), 3)};
  return code == SQLITE_DONE;
}

/// What only some versions of ROS 2 record of a topic.
void SqliteReader::read_descriptions() {
  if (const Statement rows = prepare("SELECT id, offered_qos_profiles FROM topics"))
    while (sqlite3_step(rows.get()) == SQLITE_ROW)
      topics_[sqlite3_column_int64(rows.get(), 0)].qos = text_of(rows.get(), 1);
  if (const Statement rows = prepare("SELECT id, type_description_hash FROM topics"))
    while (sqlite3_step(rows.get()) == SQLITE_ROW)
      topics_[sqlite3_column_int64(rows.get(), 0)].type_hash = text_of(rows.get(), 1);
  const Statement rows =
      prepare("SELECT topic_type, encoding, encoded_message_definition FROM message_definitions");
  while (rows && sqlite3_step(rows.get()) == SQLITE_ROW) {
    for (auto& [id, topic] : topics_) {
      if (topic.type != text_of(rows.get(), 0)) continue;
      topic.schema_encoding = text_of(rows.get(), 1);
      topic.definition = text_of(rows.get(), 2);
    }
  }
}

std::optional<Error> SqliteReader::visit_row(sqlite3_stmt* row) {
  last_id_ = sqlite3_column_int64(row, 0);
  ++visited_;
  const auto topic = topics_.find(sqlite3_column_int64(row, 1));
  if (topic == topics_.end()) {
    ++orphans_;
    return std::nullopt;
  }
  const auto* bytes = static_cast<const std::byte*>(sqlite3_column_blob(row, 3));
  const auto count = static_cast<std::size_t>(sqlite3_column_bytes(row, 3));
  const std::span message(bytes, bytes == nullptr ? 0 : count);
  return visit_({topic->second, sqlite3_column_int64(row, 2), message, last_id_});
}

std::optional<Error> SqliteReader::read_messages() {
  if (const Statement last = prepare("SELECT max(rowid) FROM messages");
      last && sqlite3_step(last.get()) == SQLITE_ROW) {
    max_ids_ = sqlite3_column_int64(last.get(), 0);
  }
  const Statement rows = prepare("SELECT rowid, topic_id, timestamp, data FROM messages ORDER BY rowid");
  if (!rows) return unreadable_because(fmt::format("its table of messages cannot be read: {}", problem()));
  int code = 0;
  while ((code = sqlite3_step(rows.get())) == SQLITE_ROW) {
    if (auto error = visit_row(rows.get())) return error;
    if (visited_ % 512 == 0 && max_ids_ > 0)
      job_.report("reading", std::min(1.0, static_cast<double>(last_id_) / static_cast<double>(max_ids_)));
    if (interrupted()) return unreadable_because("");
  }
  if (interrupted()) return unreadable_because("");
  if (code == SQLITE_DONE) return std::nullopt;
  warnings_.push_back(
      fmt::format("its table of messages is damaged after message {} ({}); what comes before was read",
                  last_id_, problem()));
  return std::nullopt;
}

Result<std::vector<std::string>> SqliteReader::read() {
  if (!begin()) return tl::unexpected(unreadable_because(problem()));
  if (must_be_taken_back()) {
    const std::string name = path_.filename().string();
    return tl::unexpected(unreadable_because(
        fmt::format("its recorder was killed during a write, which {}-journal rolls back; copy both files to "
                    "a writable folder, run `sqlite3 {} .schema` there, and read that copy",
                    name, name)));
  }
  if (!has_table("topics") || !has_table("messages")) {
    const int code = sqlite3_errcode(database_.get());
    const bool sound = code == SQLITE_DONE || code == SQLITE_OK;
    return tl::unexpected(unreadable_because(
        sound ? "is an SQLite database without the tables topics and messages of a ROS 2 bag"
              : fmt::format("is an SQLite database that cannot be read: {}", problem())));
  }
  if (!read_topics())
    return tl::unexpected(
        unreadable_because(fmt::format("its table of topics cannot be read: {}", problem())));
  if (visit_topic_) {
    read_descriptions();
    for (const auto& [id, topic] : topics_) visit_topic_(topic);
  }
  if (auto error = read_messages()) return tl::unexpected(std::move(*error));
  if (orphans_ > 0) warnings_.push_back(fmt::format("{} messages belong to no topic", orphans_));
  return std::move(warnings_);
}

}  // namespace

Result<std::vector<std::string>> read_sqlite_bag(const fs::path& path, const SqliteVisitor& visit,
                                                 const Job& job, const SqliteTopicVisitor& visit_topic) {
  if (const auto file = InputFile::open(path); !file) return tl::unexpected(file.error());
  return SqliteReader(path, visit, job, visit_topic).read();
}

}  // namespace sweepscope
