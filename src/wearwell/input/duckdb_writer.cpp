#include <duckdb.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>

#include "wearwell/base/error.h"
#include "wearwell/input/duckdb_session.h"
#include "wearwell/input/parquet_writer.h"

namespace wearwell {
namespace {

/// A file without a name, in memory.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("parquet", MFD_CLOEXEC)) {
    if (descriptor_ < 0) fail();
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

  std::string content() const {
    struct stat about {};
    if (fstat(descriptor_, &about) != 0) fail();
    std::string bytes(static_cast<std::size_t>(about.st_size), '\0');
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t count =
          pread(descriptor_, bytes.data() + at, bytes.size() - at, static_cast<off_t>(at));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) fail();
      at += static_cast<std::size_t>(count);
    }
    return bytes;
  }

 private:
  [[noreturn]] static void fail() {
    throw MachineError(fmt::format("no memory for a table: {}", std::strerror(errno)));
  }
  int descriptor_;
};

/// A database in memory for one table.
class Database {
 public:
  Database() {
    if (duckdb_open(nullptr, &database_) != DuckDBSuccess ||
        duckdb_connect(database_, &connection_) != DuckDBSuccess)
      throw MachineError("cannot start DuckDB");
  }
  ~Database() {
    duckdb_disconnect(&connection_);
    duckdb_close(&database_);
  }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// DuckDB's error message; empty if there is none.
  std::string run(const std::string& query) {
    duckdb_result result;
    const bool done = duckdb_query(connection_, query.c_str(), &result) == DuckDBSuccess;
    const char* said = done ? nullptr : duckdb_result_error(&result);
    std::string message = done ? "" : said ? said : "unknown";
    duckdb_destroy_result(&result);
    return message;
  }

  std::string fill(const std::vector<WordColumn>& texts, const std::vector<NumberColumn>& columns) {
    duckdb_appender appender = nullptr;
    bool good = duckdb_appender_create(connection_, nullptr, "t", &appender) == DuckDBSuccess;
    const std::size_t rows =
        texts.empty() ? columns.front().values.size() : texts.front().values.size();
    for (std::size_t i = 0; good && i < rows; ++i) {
      for (const WordColumn& column : texts) {
        const std::string& value = column.values[i];
        good = good &&
               duckdb_append_varchar_length(appender, value.data(), value.size()) == DuckDBSuccess;
      }
      for (const NumberColumn& column : columns) {
        const double value = column.values[i];
        good = good && (std::isnan(value) ? duckdb_append_null(appender)
                                          : duckdb_append_double(appender, value)) == DuckDBSuccess;
      }
      good = good && duckdb_appender_end_row(appender) == DuckDBSuccess;
    }
    good = good && duckdb_appender_close(appender) == DuckDBSuccess;
    const char* said = good || !appender ? nullptr : duckdb_appender_error(appender);
    std::string message = good ? "" : said ? said : "unknown";
    duckdb_appender_destroy(&appender);
    return message;
  }

 private:
  duckdb_database database_ = nullptr;
  duckdb_connection connection_ = nullptr;
};

}  // namespace

std::string parquet_of(const std::vector<NumberColumn>& columns) {
  return parquet_of({}, columns);
}

std::string parquet_of(const std::vector<WordColumn>& texts,
                       const std::vector<NumberColumn>& columns) {
  std::string names;
  for (const WordColumn& column : texts)
    names += fmt::format("{}{} varchar", names.empty() ? "" : ", ", quoted(column.name, '"'));
  for (const NumberColumn& column : columns)
    names += fmt::format("{}{} double", names.empty() ? "" : ", ", quoted(column.name, '"'));
  const MemoryFile file;
  std::string message;
  {
    Database database;
    message = database.run("set threads to 1");
    if (message.empty()) message = database.run(fmt::format("create table t ({})", names));
    if (message.empty()) message = database.fill(texts, columns);
    if (message.empty())
      message = database.run(
          fmt::format("copy t to '{}' (format parquet, use_tmp_file false)", file.path()));
  }
  if (!message.empty()) throw MachineError(fmt::format("cannot write Parquet: {}", message));
  return file.content();
}

}  // namespace wearwell
