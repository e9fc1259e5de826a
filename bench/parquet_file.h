#pragma once

#include <duckdb.h>
#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace wearwell {

/// The rows of a query as Parquet in the temporary folder, as long as this lives.
class ParquetFile {
 public:
  ParquetFile(const std::string& name, const std::string& query)
      : path_(std::filesystem::temp_directory_path() / (name + ".parquet")) {
    duckdb_database database = nullptr;
    duckdb_connection connection = nullptr;
    if (duckdb_open(nullptr, &database) != DuckDBSuccess ||
        duckdb_connect(database, &connection) != DuckDBSuccess)
      throw std::runtime_error("cannot start DuckDB");
    const std::string copy =
        fmt::format("copy ({}) to '{}' (format parquet)", query, path_.string());
    const bool done = duckdb_query(connection, copy.c_str(), nullptr) == DuckDBSuccess;
    duckdb_disconnect(&connection);
    duckdb_close(&database);
    if (!done) throw std::runtime_error("cannot write " + path_.string());
  }
  ~ParquetFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  ParquetFile(const ParquetFile&) = delete;
  ParquetFile& operator=(const ParquetFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace wearwell
