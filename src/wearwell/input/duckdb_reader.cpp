#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/input/column_stream.h"
#include "wearwell/input/duckdb_session.h"
#include "wearwell/input/table.h"

namespace wearwell {

Table read_table(const std::filesystem::path& path, const std::optional<std::string>& sql,
                 const QueryLimits& limits) {
  const TableFile file(path);
  const DuckdbSession session(file);
  Table table;
  table.source = file.source();
  if (sql) {
    table.source += " (through sql)";
    run_query(session, *sql, limits);
  } else {
    DuckdbResult(session, "create temp table result as select * from data");
  }

  // All numbers as double, all else as text.
  std::vector<std::string> selected;
  {
    DuckdbResult header(session, "select * from result limit 0");
    for (idx_t c = 0; c < header.columns(); ++c) {
      table.columns.push_back({header.name(c), is_number(header.type(c)), {}, {}});
      selected.push_back(fmt::format("cast({} as {})", quoted(header.name(c), '"'),
                                     table.columns.back().is_number ? "double" : "varchar"));
    }
  }
  DuckdbResult rows(session, fmt::format("select {} from result", fmt::join(selected, ", ")));
  for (duckdb_data_chunk chunk = rows.next(); chunk; chunk = rows.next()) {
    const idx_t count = duckdb_data_chunk_get_size(chunk);
    for (idx_t c = 0; c < table.columns.size(); ++c) {
      duckdb_vector vector = duckdb_data_chunk_get_vector(chunk, c);
      Column& column = table.columns[c];
      if (column.is_number) {
        append_numbers(vector, count, column.numbers);
      } else {
        append_text(vector, count, column.text);
      }
    }
    table.rows += count;
    duckdb_destroy_data_chunk(&chunk);
  }
  if (table.rows == 0) throw InputError(fmt::format("{} has no rows", table.source));
  return table;
}

/// Rows come as they are asked for instead of all at once.
struct ColumnStream::State {
  TableFile file;
  DuckdbSession session;
  std::vector<std::string> headings;
  std::vector<bool> is_numeric;
  duckdb_prepared_statement statement = nullptr;
  duckdb_result result{};
  bool running = false;
  std::size_t rows_seen = 0;

  explicit State(const std::filesystem::path& path) : file(path), session(file) {}
  ~State() {
    if (running) duckdb_destroy_result(&result);
    if (statement) duckdb_destroy_prepare(&statement);
  }
};

ColumnStream::ColumnStream(const std::filesystem::path& file)
    : state_(std::make_unique<State>(file)) {
  DuckdbResult header(state_->session, "select * from data limit 0");
  for (idx_t c = 0; c < header.columns(); ++c) {
    state_->headings.push_back(header.name(c));
    state_->is_numeric.push_back(is_number(header.type(c)));
  }
}

ColumnStream::~ColumnStream() = default;

const std::string& ColumnStream::source() const {
  return state_->file.source();
}
const std::vector<std::string>& ColumnStream::headings() const {
  return state_->headings;
}

void ColumnStream::select(const std::vector<std::string>& columns) {
  std::vector<std::string> selected;
  for (const std::string& column : columns) {
    const auto at = std::find(state_->headings.begin(), state_->headings.end(), column);
    if (at == state_->headings.end() ||
        !state_->is_numeric[static_cast<std::size_t>(at - state_->headings.begin())]) {
      // Without rows there is nothing to tell numbers by.
      DuckdbResult any(state_->session, "select 1 from data limit 1");
      duckdb_data_chunk chunk = any.next();
      const bool has_rows = chunk && duckdb_data_chunk_get_size(chunk) > 0;
      if (chunk) duckdb_destroy_data_chunk(&chunk);
      throw InputError(has_rows
                           ? fmt::format("{}: column '{}' does not hold numbers", source(), column)
                           : fmt::format("{} has no rows", source()));
    }
    selected.push_back(fmt::format("cast({} as double)", quoted(column, '"')));
  }
  const std::string query = fmt::format("select {} from data", fmt::join(selected, ", "));
  if (duckdb_prepare(state_->session.connection(), query.c_str(), &state_->statement) !=
      DuckDBSuccess)
    state_->session.fail(duckdb_prepare_error(state_->statement));
  if (duckdb_execute_prepared_streaming(state_->statement, &state_->result) != DuckDBSuccess) {
    const std::string message = duckdb_result_error(&state_->result);
    duckdb_destroy_result(&state_->result);
    state_->session.fail(message);
  }
  state_->running = true;
}

bool ColumnStream::next(Batch& batch) {
  duckdb_data_chunk chunk = duckdb_fetch_chunk(state_->result);
  if (!chunk) {
    const char* message = duckdb_result_error(&state_->result);
    if (message && *message) state_->session.fail(message);
    return false;
  }
  batch.first_row = state_->rows_seen;
  batch.rows = duckdb_data_chunk_get_size(chunk);
  batch.columns.resize(duckdb_data_chunk_get_column_count(chunk));
  for (idx_t c = 0; c < batch.columns.size(); ++c) {
    batch.columns[c].clear();
    append_numbers(duckdb_data_chunk_get_vector(chunk, c), batch.rows, batch.columns[c]);
  }
  state_->rows_seen += batch.rows;
  duckdb_destroy_data_chunk(&chunk);
  return batch.rows > 0 || next(batch);
}

}  // namespace wearwell
