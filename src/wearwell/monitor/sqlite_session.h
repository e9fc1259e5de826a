#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace wearwell::monitor {

/// One connection to a file of SQLite. Throws StoreError for every error of SQLite, with its
/// message and the file.
class SqliteSession {
 public:
  explicit SqliteSession(const std::filesystem::path& file);
  ~SqliteSession();
  SqliteSession(const SqliteSession&) = delete;
  SqliteSession& operator=(const SqliteSession&) = delete;

  void run(const char* sql);
  int changes() const { return sqlite3_changes(database_); }
  sqlite3* get() const { return database_; }
  [[noreturn]] void fail() const;

 private:
  std::string file_;
  sqlite3* database_ = nullptr;
};

/// A prepared statement; parameters count from 1 and columns from 0, as in SQLite.
class SqliteStatement {
 public:
  SqliteStatement(SqliteSession& session, std::string_view sql);
  ~SqliteStatement() { sqlite3_finalize(statement_); }
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;

  SqliteStatement& bind(int at, std::int64_t value);
  SqliteStatement& bind(int at, double value);
  SqliteStatement& bind(int at, std::string_view value);  ///< text; copied
  SqliteStatement& bind_bytes(int at, std::string_view value);
  bool next();   ///< false after the last row
  void run();    ///< a statement without rows; ready for the next
  void reset();  ///< ready for the next
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_, column); }
  double number(int column) const { return sqlite3_column_double(statement_, column); }
  std::string text(int column) const;

 private:
  SqliteSession& session_;
  sqlite3_stmt* statement_ = nullptr;
};

/// A transaction that is rolled back unless it commits.
class SqliteTransaction {
 public:
  explicit SqliteTransaction(SqliteSession& session) : session_(session) {
    session_.run("BEGIN IMMEDIATE");
  }
  ~SqliteTransaction();
  void commit();

 private:
  SqliteSession& session_;
  bool open_ = true;
};

}  // namespace wearwell::monitor
