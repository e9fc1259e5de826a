#include "wearwell/monitor/sqlite_session.h"

#include <fmt/format.h>

#include "wearwell/monitor/store.h"

namespace wearwell::monitor {

SqliteSession::SqliteSession(const std::filesystem::path& file) : file_(file.string()) {
  const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
  if (sqlite3_open_v2(file_.c_str(), &database_, flags, nullptr) != SQLITE_OK) {
    const std::string why = database_ ? sqlite3_errmsg(database_) : "out of memory";
    sqlite3_close(database_);
    throw StoreError(fmt::format("{}: {}", file_, why));
  }
  sqlite3_busy_timeout(database_, 10'000);
  sqlite3_extended_result_codes(database_, 1);
}

SqliteSession::~SqliteSession() {
  sqlite3_close(database_);
}

void SqliteSession::fail() const {
  const int code = sqlite3_errcode(database_) & 0xff;
  throw StoreError(fmt::format("{}: {}{}", file_, sqlite3_errmsg(database_),
                               code == SQLITE_FULL ? ": is the disk full?" : ""));
}

void SqliteSession::run(const char* sql) {
  if (sqlite3_exec(database_, sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

SqliteStatement::SqliteStatement(SqliteSession& session, std::string_view sql) : session_(session) {
  if (sqlite3_prepare_v2(session.get(), sql.data(), static_cast<int>(sql.size()), &statement_,
                         nullptr) != SQLITE_OK)
    session.fail();
}

SqliteStatement& SqliteStatement::bind(int at, std::int64_t value) {
  if (sqlite3_bind_int64(statement_, at, value) != SQLITE_OK) session_.fail();
  return *this;
}

SqliteStatement& SqliteStatement::bind(int at, double value) {
  if (sqlite3_bind_double(statement_, at, value) != SQLITE_OK) session_.fail();
  return *this;
}

SqliteStatement& SqliteStatement::bind(int at, std::string_view value) {
  if (sqlite3_bind_text64(statement_, at, value.data(), value.size(), SQLITE_TRANSIENT,
                          SQLITE_UTF8) != SQLITE_OK)
    session_.fail();
  return *this;
}

SqliteStatement& SqliteStatement::bind_bytes(int at, std::string_view value) {
  if (sqlite3_bind_blob64(statement_, at, value.data(), value.size(), SQLITE_TRANSIENT) !=
      SQLITE_OK)
    session_.fail();
  return *this;
}

bool SqliteStatement::next() {
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  // The reset keeps the connection's message.
  sqlite3_reset(statement_);
  session_.fail();
}

void SqliteStatement::run() {
  while (next()) {
  }
  reset();
}

void SqliteStatement::reset() {
  sqlite3_reset(statement_);
  sqlite3_clear_bindings(statement_);
}

std::string SqliteStatement::text(int column) const {
  const void* bytes = sqlite3_column_blob(statement_, column);
  const int size = sqlite3_column_bytes(statement_, column);
  return bytes ? std::string(static_cast<const char*>(bytes), static_cast<std::size_t>(size))
               : std::string();
}

SqliteTransaction::~SqliteTransaction() {
  // Some errors have rolled it back already.
  if (open_ && !sqlite3_get_autocommit(session_.get()))
    sqlite3_exec(session_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void SqliteTransaction::commit() {
  session_.run("COMMIT");
  open_ = false;
}

}  // namespace wearwell::monitor
