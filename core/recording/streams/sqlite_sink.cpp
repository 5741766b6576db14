#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <memory>

#include "core/io/atomic_file.hpp"
#include "core/recording/streams/message_sink.hpp"

namespace sweepscope {
namespace {

using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;
using Statement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

/// rosbag2's tables since ROS 2 Iron (version 4), which earlier ones read too. Without a
/// journal: the file appears only when it is complete.
constexpr const char* kTables = R"(
PRAGMA journal_mode = OFF;
PRAGMA synchronous = OFF;
PRAGMA locking_mode = EXCLUSIVE;
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
                    serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL,
                    type_description_hash TEXT NOT NULL);
CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT NULL,
                                 encoded_message_definition TEXT NOT NULL,
                                 type_description_hash TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
                      data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
INSERT INTO schema VALUES (4, 'unknown');
BEGIN;
)";

class SqliteSink : public MessageSink {
 public:
  explicit SqliteSink(AtomicFile file) : file_(std::move(file)) {}

  Result<void> begin();
  Result<void> add_topic(const StreamTopic& topic) override;
  Result<void> write(const StreamMessage& message) override;
  Result<void> finish(const std::vector<std::string>& records) override;

 private:
  Result<void> run(const std::string& statements);
  Result<void> insert(const char* statement, std::initializer_list<std::string_view> texts);
  tl::unexpected<Error> failed() const {
    return tl::unexpected(file_.error(sqlite3_errmsg(database_.get())));
  }

  AtomicFile file_;
  Database database_{nullptr, sqlite3_close};
  Statement insert_message_{nullptr, sqlite3_finalize};
  std::vector<std::string> defined_;  // types whose definition was written
  std::int64_t topics_ = 0, last_id_ = 0;
};

Result<void> SqliteSink::run(const std::string& statements) {
  if (sqlite3_exec(database_.get(), statements.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    return failed();
  return {};
}

Result<void> SqliteSink::begin() {
  sqlite3* database = nullptr;
  const int code = sqlite3_open_v2(file_.part_path().c_str(), &database,
                                   SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, nullptr);
  database_.reset(database);
  if (code != SQLITE_OK) return failed();
  if (auto made = run(kTables); !made) return made;
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(database, "INSERT INTO messages VALUES (?, ?, ?, ?)", -1, &statement, nullptr);
  insert_message_.reset(statement);
  return statement == nullptr ? Result<void>(failed()) : Result<void>();
}

/// The texts are the parameters from the second on; the first is the id, which SQLite chooses.
Result<void> SqliteSink::insert(const char* statement, std::initializer_list<std::string_view> texts) {
  sqlite3_stmt* prepared = nullptr;
  sqlite3_prepare_v2(database_.get(), statement, -1, &prepared, nullptr);
  const Statement row(prepared, sqlite3_finalize);
  if (!row) return failed();
  int place = 0;
  for (const std::string_view text : texts)
    sqlite3_bind_text(row.get(), ++place, text.data(), static_cast<int>(text.size()), SQLITE_STATIC);
  return sqlite3_step(row.get()) == SQLITE_DONE ? Result<void>() : Result<void>(failed());
}

Result<void> SqliteSink::add_topic(const StreamTopic& topic) {
  if (topic.encoding != "cdr")
    return tl::unexpected(file_.error(
        fmt::format("the database of a ROS 2 bag holds messages of ROS 2 only, and those on {} are encoded "
                    "as {}; write OUT.mcap",
                    topic.name, topic.encoding)));
  ++topics_;
  const std::string hash = topic.metadata_of("topic_type_hash");
  auto added =
      insert("INSERT INTO topics VALUES (NULL, ?, ?, ?, ?, ?)",
             {topic.name, topic.type, topic.encoding, topic.metadata_of("offered_qos_profiles"), hash});
  if (!added || topic.definition.empty() || std::ranges::find(defined_, topic.type) != defined_.end())
    return added;
  defined_.push_back(topic.type);
  return insert("INSERT INTO message_definitions VALUES (NULL, ?, ?, ?, ?)",
                {topic.type, topic.schema_encoding, topic.definition, hash});
}

Result<void> SqliteSink::write(const StreamMessage& message) {
  sqlite3_stmt* const row = insert_message_.get();
  last_id_ = std::max(last_id_ + 1, message.id);
  sqlite3_bind_int64(row, 1, last_id_);
  sqlite3_bind_int64(row, 2, static_cast<std::int64_t>(message.topic) + 1);
  sqlite3_bind_int64(row, 3, message.log_ns);
  // Otherwise an empty message would be NULL.
  const void* const bytes = message.bytes.empty() ? static_cast<const void*>("") : message.bytes.data();
  sqlite3_bind_blob64(row, 4, bytes, message.bytes.size(), SQLITE_STATIC);
  const int code = sqlite3_step(row);
  sqlite3_reset(row);
  return code == SQLITE_DONE ? Result<void>() : Result<void>(failed());
}

Result<void> SqliteSink::finish(const std::vector<std::string>& records) {
  if (auto made =
          run(fmt::format("CREATE TABLE {}(id INTEGER PRIMARY KEY, record TEXT NOT NULL)", kAppliedTable));
      !made)
    return made;
  for (const std::string& record : records) {
    const std::string statement = fmt::format("INSERT INTO {} VALUES (NULL, ?)", kAppliedTable);
    if (auto added = insert(statement.c_str(), {record}); !added) return added;
  }
  if (auto ended = run("COMMIT"); !ended) return ended;
  insert_message_.reset();
  if (sqlite3_close(database_.release()) != SQLITE_OK) return tl::unexpected(file_.error("it is in use"));
  return file_.commit();
}

}  // namespace

Result<std::unique_ptr<MessageSink>> create_sqlite_sink(const std::filesystem::path& path) {
  auto file = AtomicFile::create_seekable(path);
  if (!file) return tl::unexpected(file.error());
  auto sink = std::make_unique<SqliteSink>(std::move(*file));
  if (const auto begun = sink->begin(); !begun) return tl::unexpected(begun.error());
  return sink;
}

}  // namespace sweepscope
