#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace sweepscope::test {

/// A ROS 2 bag being written as an SQLite database, with the tables of rosbag2's schema 3.
class TestDatabase {
 public:
  explicit TestDatabase(const std::filesystem::path& path, const std::string& journal_mode = "DELETE",
                        bool tables = true) {
    EXPECT_EQ(sqlite3_open(path.c_str(), &database_), SQLITE_OK);
    run("PRAGMA synchronous = OFF; PRAGMA journal_mode = " + journal_mode);
    if (!tables) return;
    run("CREATE TABLE schema(schema_version INTEGER PRIMARY KEY,ros_distro TEXT NOT NULL);CREATE TABLE "
        "metadata(id INTEGER PRIMARY KEY,metadata_version INTEGER NOT NULL,metadata TEXT NOT NULL);CREATE "
        "TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,serialization_format TEXT "
        "NOT NULL,offered_qos_profiles TEXT NOT NULL);CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id "
        "INTEGER NOT NULL,timestamp INTEGER NOT NULL, data BLOB NOT NULL);CREATE INDEX timestamp_idx ON "
        "messages (timestamp ASC);");
    if (journal_mode == "DELETE") run("BEGIN");
  }
  ~TestDatabase() {
    if (sqlite3_get_autocommit(database_) == 0) run("COMMIT");
    sqlite3_close(database_);
  }
  TestDatabase(const TestDatabase&) = delete;
  TestDatabase& operator=(const TestDatabase&) = delete;

  void run(const std::string& sql) {
    EXPECT_EQ(sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database_);
  }
  void topic(int id, const std::string& name, const std::string& type) {
    run("INSERT INTO topics VALUES(" + std::to_string(id) + ",'" + name + "','" + type + "','cdr','')");
  }
  void message(int topic, std::int64_t receive_ns, const std::string& bytes) {
    sqlite3_stmt* insert = nullptr;
    EXPECT_EQ(sqlite3_prepare_v2(database_, "INSERT INTO messages VALUES(NULL,?,?,?)", -1, &insert, nullptr),
              SQLITE_OK);
    sqlite3_bind_int(insert, 1, topic);
    sqlite3_bind_int64(insert, 2, receive_ns);
    sqlite3_bind_blob(insert, 3, bytes.data(), static_cast<int>(bytes.size()), SQLITE_TRANSIENT);
    EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE) << sqlite3_errmsg(database_);
    sqlite3_finalize(insert);
  }

 private:
  sqlite3* database_ = nullptr;
};

}  // namespace sweepscope::test
