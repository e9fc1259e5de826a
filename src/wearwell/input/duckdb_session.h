#pragma once

#include <duckdb.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/quoted.h"
#include "wearwell/input/table.h"
#include "wearwell/input/table_file.h"
#include "wearwell/input/text_layout.h"

namespace wearwell {

/// An in-memory database that can read one file and nothing else: no other file, no network, no
/// extension, no temporary file; its configuration is locked. The file is its view `data`.
class DuckdbSession {
 public:
  /// Throws InputError: the file cannot be read as a table.
  DuckdbSession(const TableFile& file, const TableSettings& settings);
  ~DuckdbSession();
  DuckdbSession(const DuckdbSession&) = delete;
  DuckdbSession& operator=(const DuckdbSession&) = delete;

  duckdb_connection connection() const { return connection_; }
  const TableFile& file() const { return file_; }
  /// The layout of a text or a sheet.
  const std::optional<TextLayout>& layout() const { return layout_; }
  TableLayout layout_text() const;  ///< empty for other files
  const TextColumn* column(const std::string& name) const;
  /// The line of each row, if rows are not in consecutive lines.
  std::vector<std::size_t>& lines() { return lines_; }

  /// Translates a message of DuckDB to the user's file and columns.
  std::string sentence(const std::string& message) const;

  /// Throws InputError that states the problem of the file, or MachineError if memory runs out.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  void close();
  void refuse_equal_columns() const;
  std::string reader() const;
  const TableFile& read() const { return rewritten_ ? *rewritten_ : sheet_ ? *sheet_ : file_; }

  const TableFile& file_;
  const TableSettings settings_;
  std::unique_ptr<TableFile> sheet_, rewritten_;
  std::optional<TextLayout> layout_;
  std::vector<std::size_t> lines_;
  std::string sheet_name_;
  duckdb_database database_ = nullptr;
  duckdb_connection connection_ = nullptr;
};

/// Rows of a query.
class DuckdbResult {
 public:
  /// Throws like DuckdbSession::fail.
  DuckdbResult(const DuckdbSession& session, const std::string& query);
  ~DuckdbResult() { duckdb_destroy_result(&result_); }
  DuckdbResult(const DuckdbResult&) = delete;
  DuckdbResult& operator=(const DuckdbResult&) = delete;

  idx_t columns() { return duckdb_column_count(&result_); }
  std::string name(idx_t column) { return duckdb_column_name(&result_, column); }
  duckdb_type type(idx_t column) { return duckdb_column_type(&result_, column); }
  duckdb_data_chunk next() { return duckdb_fetch_chunk(result_); }

 private:
  duckdb_result result_;
};

bool is_number(duckdb_type type);
/// NaN for a missing value.
void append_numbers(duckdb_vector vector, idx_t count, std::vector<double>& out);
/// Empty for a missing value.
void append_text(duckdb_vector vector, idx_t count, std::vector<std::string>& out);

/// Runs the user's query into the table `result`. Throws QueryError if it is not one SELECT, is
/// forbidden, fails, or exceeds `limits`.
void run_query(const DuckdbSession& session, const std::string& query, const QueryLimits& limits);

}  // namespace wearwell
