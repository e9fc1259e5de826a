#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/input/as_read.h"
#include "wearwell/input/column_stream.h"
#include "wearwell/input/csv_reader.h"
#include "wearwell/input/duckdb_session.h"
#include "wearwell/input/memory_text.h"
#include "wearwell/input/table.h"

namespace wearwell {

namespace {

const std::vector<TextColumn> no_columns;

void refuse_doubt(const std::string& source, const std::string& doubt) {
  if (!doubt.empty()) throw InputError(fmt::format("{}, {}", source, doubt));
}

/// The column of a text layout.
void describe(const DuckdbSession& session, Column& column) {
  const TextColumn* const known = session.column(column.name);
  if (!known) return;
  column.unit = known->unit;
  column.marks = known->marks;
  column.doubt = known->doubt;
  column.unit_in_cells = known->unit_in_cells;
}

/// Appends texts in printable form (base/printable.h), so that a label is the same in the study, in
/// output and in options of commands.
void append_words(duckdb_vector vector, idx_t count, std::vector<std::string>& words) {
  const std::size_t before = words.size();
  append_text(vector, count, words);
  for (std::size_t i = before; i < words.size(); ++i) words[i] = printable(words[i], "\n\t");
}

/// Adds the columns of the table `result`: numbers as double, everything else as text.
void add_result(const DuckdbSession& session, bool described, Table& table) {
  std::vector<std::string> selected;
  {
    DuckdbResult header(session, "select * from result limit 0");
    for (idx_t c = 0; c < header.columns(); ++c) {
      table.columns.push_back({header.name(c), is_number(header.type(c)), {}, {}});
      if (described) describe(session, table.columns.back());
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
        append_words(vector, count, column.text);
      }
    }
    table.rows += count;
    duckdb_destroy_data_chunk(&chunk);
    check_stop();
  }
  if (table.rows == 0) throw InputError(fmt::format("{} has no rows", table.source));
}

}  // namespace

Table read_table(const std::filesystem::path& path, const std::optional<std::string>& sql,
                 const QueryLimits& limits, const TableSettings& settings) {
  const TableFile file(path);
  DuckdbSession session(file, settings);
  Table table;
  table.source = file.source();
  table.layout = session.layout_text();
  if (sql) {
    table.source += " (through sql)";
    for (const TextColumn& column : session.layout() ? session.layout()->columns : no_columns) {
      if (column.is_number) refuse_doubt(file.source(), column.doubt);
    }
    run_query(session, *sql, limits);
  } else {
    DuckdbResult(session, "create temp table result as select * from data");
  }

  add_result(session, !sql, table);
  if (!sql) table.lines = std::move(session.lines());
  return table;
}

namespace {

/// The shortest text that reads back to the same double.
std::string written_cell(const Table& table, const Column& column, bool numbers, std::size_t row) {
  if (!numbers) return csv_cell(column.text[row]);
  const double number = cell_number(table, column, row);
  return std::isnan(number) ? std::string() : fmt::format("{}", number);
}

}  // namespace

Table query_table(const Table& table, const std::string& sql, const QueryLimits& limits) {
  MemoryText text;
  std::vector<std::string> cells;
  std::vector<bool> numbers;
  for (const Column& column : table.columns) {
    cells.push_back(csv_cell(column.name));
    numbers.push_back(holds_numbers(column));
  }
  text.add_line(fmt::format("{}", fmt::join(cells, ",")));
  for (std::size_t i = 0; i < table.rows; ++i) {
    for (std::size_t c = 0; c < cells.size(); ++c)
      cells[c] = written_cell(table, table.columns[c], numbers[c], i);
    text.add_line(fmt::format("{}", fmt::join(cells, ",")));
  }
  const std::unique_ptr<TableFile> file = text.table(table.source);
  TableSettings plain;
  plain.decimal = '.';
  plain.thousands = '\0';
  plain.delimiter = ',';
  plain.encoding = Encoding::utf8;
  plain.header_row = 1;
  plain.units_row = false;
  DuckdbSession session(*file, plain);
  Table result;
  result.source = table.source + " (through sql)";
  result.layout = table.layout;
  run_query(session, sql, limits);
  add_result(session, false, result);
  return result;
}

/// Rows are fetched on demand instead of all at once.
struct ColumnStream::State {
  TableFile file;
  DuckdbSession session;
  std::vector<std::string> headings;
  std::vector<bool> is_numeric;
  duckdb_prepared_statement statement = nullptr;
  duckdb_result result{};
  bool running = false;
  // For the column of words, if there is one.
  std::optional<std::size_t> named;
  std::vector<std::string> words;
  std::unordered_map<std::string, double> place_of_word;

  double place(const std::string& word) {
    const auto [at, fresh] = place_of_word.try_emplace(word, static_cast<double>(words.size() + 1));
    if (fresh) words.push_back(word);
    return at->second;
  }
  std::size_t rows_seen = 0;

  State(const std::filesystem::path& path, const TableSettings& settings)
      : file(path), session(file, settings) {}
  ~State() {
    if (running) duckdb_destroy_result(&result);
    if (statement) duckdb_destroy_prepare(&statement);
  }
};

ColumnStream::ColumnStream(const std::filesystem::path& file, const TableSettings& settings)
    : state_(std::make_unique<State>(file, settings)) {
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

Table ColumnStream::columns() const {
  Table table;
  table.source = source();
  for (std::size_t c = 0; c < state_->headings.size(); ++c) {
    table.columns.push_back({state_->headings[c], state_->is_numeric[c], {}, {}});
    describe(state_->session, table.columns.back());
  }
  return table;
}

bool ColumnStream::has_words() const {
  return state_->named.has_value();
}
const std::vector<std::string>& ColumnStream::words() const {
  return state_->words;
}

void ColumnStream::select(const std::vector<std::string>& columns, const std::string& named,
                          std::vector<std::string> known) {
  std::vector<std::string> selected;
  for (const std::string& column : columns) {
    const auto at = std::find(state_->headings.begin(), state_->headings.end(), column);
    const bool is_text =
        at != state_->headings.end() &&
        !state_->is_numeric[static_cast<std::size_t>(at - state_->headings.begin())];
    if (column == named && is_text) {
      state_->named = selected.size();
      for (const std::string& word : known) state_->place(word);
      selected.push_back(fmt::format("cast({} as varchar)", quoted(column, '"')));
      continue;
    }
    if (const TextColumn* const text = state_->session.column(column))
      refuse_doubt(source(), text->doubt);
    if (at == state_->headings.end() ||
        !state_->is_numeric[static_cast<std::size_t>(at - state_->headings.begin())]) {
      // Without rows, column types are unknown.
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
    if (state_->named == c) {
      std::vector<std::string> words;
      append_words(duckdb_data_chunk_get_vector(chunk, c), batch.rows, words);
      for (const std::string& word : words)
        batch.columns[c].push_back(word.empty() ? NAN : state_->place(word));
      continue;
    }
    append_numbers(duckdb_data_chunk_get_vector(chunk, c), batch.rows, batch.columns[c]);
  }
  state_->rows_seen += batch.rows;
  duckdb_destroy_data_chunk(&chunk);
  return batch.rows > 0 || next(batch);
}

}  // namespace wearwell
