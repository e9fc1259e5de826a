// The only file that sees duckdb.h.
#include <duckdb.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <fstream>
#include <limits>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/table/column_stream.h"
#include "wearwell/table/table.h"

namespace wearwell {
namespace {

class Database {
 public:
  Database() {
    if (duckdb_open(nullptr, &database_) != DuckDBSuccess ||
        duckdb_connect(database_, &connection_) != DuckDBSuccess) {
      throw MachineError("cannot start DuckDB");
    }
  }
  ~Database() {
    duckdb_disconnect(&connection_);
    duckdb_close(&database_);
  }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  duckdb_connection connection() const { return connection_; }

 private:
  duckdb_database database_ = nullptr;
  duckdb_connection connection_ = nullptr;
};

// DuckDB's messages run over many lines with hints about its own options; the first says what is
// wrong.
std::string first_line(const char* message) {
  const std::string text = message ? message : "unknown error";
  return text.substr(0, text.find('\n'));
}

class Result {
 public:
  Result(const Database& database, const std::string& query, const std::string& source) {
    if (duckdb_query(database.connection(), query.c_str(), &result_) != DuckDBSuccess) {
      const std::string message = first_line(duckdb_result_error(&result_));
      duckdb_destroy_result(&result_);
      throw InputError(fmt::format("{}: {}", source, message));
    }
  }
  ~Result() { duckdb_destroy_result(&result_); }
  Result(const Result&) = delete;
  Result& operator=(const Result&) = delete;

  idx_t columns() { return duckdb_column_count(&result_); }
  std::string name(idx_t column) { return duckdb_column_name(&result_, column); }
  duckdb_type type(idx_t column) { return duckdb_column_type(&result_, column); }
  duckdb_data_chunk next() { return duckdb_fetch_chunk(result_); }
  /// Of a query for one count.
  long long first_count() {
    duckdb_data_chunk chunk = next();
    const auto* count =
        static_cast<const int64_t*>(duckdb_vector_get_data(duckdb_data_chunk_get_vector(chunk, 0)));
    const long long value = *count;
    duckdb_destroy_data_chunk(&chunk);
    return value;
  }

 private:
  duckdb_result result_;
};

bool is_number(duckdb_type type) {
  switch (type) {
    case DUCKDB_TYPE_TINYINT:
    case DUCKDB_TYPE_SMALLINT:
    case DUCKDB_TYPE_INTEGER:
    case DUCKDB_TYPE_BIGINT:
    case DUCKDB_TYPE_UTINYINT:
    case DUCKDB_TYPE_USMALLINT:
    case DUCKDB_TYPE_UINTEGER:
    case DUCKDB_TYPE_UBIGINT:
    case DUCKDB_TYPE_HUGEINT:
    case DUCKDB_TYPE_UHUGEINT:
    case DUCKDB_TYPE_FLOAT:
    case DUCKDB_TYPE_DOUBLE:
    case DUCKDB_TYPE_DECIMAL:
      return true;
    default:
      return false;
  }
}

std::string quoted(const std::string& name, char quote) {
  const std::string one(1, quote);
  return one + boost::algorithm::replace_all_copy(name, one, one + one) + one;
}

// Without BOOLEAN: a column of the letter F alone (failures) would be read as false.
constexpr const char* csv_types = "['BIGINT', 'DOUBLE', 'TIME', 'DATE', 'TIMESTAMP', 'VARCHAR']";

bool is_csv(const std::string& path) {
  const std::string lower = boost::algorithm::to_lower_copy(path);
  for (const char* ending : {".csv", ".tsv", ".txt", ".csv.gz", ".tsv.gz"}) {
    if (boost::algorithm::ends_with(lower, ending)) return true;
  }
  return false;
}

// DuckDB would silently rename the second of two equal columns.
void refuse_duplicate_names(const Database& database, const std::string& path,
                            const std::string& source) {
  Result header(
      database,
      fmt::format("select * from read_csv({}, header = false, all_varchar = true) limit 1",
                  quoted(path, '\'')),
      source);
  std::set<std::string> seen;
  for (duckdb_data_chunk chunk = header.next(); chunk; chunk = header.next()) {
    for (idx_t c = 0; c < header.columns() && duckdb_data_chunk_get_size(chunk) > 0; ++c) {
      duckdb_vector vector = duckdb_data_chunk_get_vector(chunk, c);
      uint64_t* valid = duckdb_vector_get_validity(vector);
      if (valid && !duckdb_validity_row_is_valid(valid, 0)) continue;
      auto* text = static_cast<duckdb_string_t*>(duckdb_vector_get_data(vector));
      const std::string name(duckdb_string_t_data(text), duckdb_string_t_length(*text));
      if (!seen.insert(name).second) {
        duckdb_destroy_data_chunk(&chunk);
        throw InputError(fmt::format("{} has two columns named '{}'", source, name));
      }
    }
    duckdb_destroy_data_chunk(&chunk);
  }
}

void check_readable(const std::filesystem::path& file, const std::string& source) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    throw InputError(fmt::format("no such file: {}", source));
  }
  if (std::filesystem::is_directory(file, ignored)) {
    throw InputError(fmt::format("{} is a folder, not a file", source));
  }
  std::ifstream stream(file);
  if (!stream) throw InputError(fmt::format("{} cannot be read (permissions?)", source));
  if (stream.peek() == std::ifstream::traits_type::eof()) {
    throw InputError(fmt::format("{} is empty", source));
  }
}

void append_numbers(duckdb_vector vector, idx_t count, std::vector<double>& out) {
  const auto* data = static_cast<const double*>(duckdb_vector_get_data(vector));
  uint64_t* valid = duckdb_vector_get_validity(vector);
  if (!valid) {
    out.insert(out.end(), data, data + count);
    return;
  }
  for (idx_t i = 0; i < count; ++i) {
    const bool present = duckdb_validity_row_is_valid(valid, i);
    out.push_back(present ? data[i] : std::numeric_limits<double>::quiet_NaN());
  }
}

void append_text(duckdb_vector vector, idx_t count, std::vector<std::string>& out) {
  auto* data = static_cast<duckdb_string_t*>(duckdb_vector_get_data(vector));
  uint64_t* valid = duckdb_vector_get_validity(vector);
  for (idx_t i = 0; i < count; ++i) {
    const bool present = !valid || duckdb_validity_row_is_valid(valid, i);
    out.emplace_back();
    if (present) out.back().assign(duckdb_string_t_data(&data[i]), duckdb_string_t_length(data[i]));
  }
}

/// Makes the file the view `data`.
void open_view(const Database& database, const std::filesystem::path& file,
               const std::string& source) {
  const std::string path = file.string();
  check_readable(file, source);
  if (is_csv(path)) refuse_duplicate_names(database, path, source);
  const std::string literal = quoted(path, '\'');
  const std::string reader =
      is_csv(path) ? fmt::format("read_csv({}, header = true, auto_type_candidates = {})", literal,
                                 csv_types)
                   : literal;
  Result(database, fmt::format("create view data as select * from {}", reader), source);
}

}  // namespace

Table read_table(const std::filesystem::path& file, const std::optional<std::string>& sql) {
  Table table;
  table.source = file.string();
  const Database database;
  open_view(database, file, table.source);
  const std::string query = sql ? *sql : "select * from data";
  if (sql) table.source += " (through sql)";
  Result(database, "create temp table result as " + query, table.source);

  // All numbers as double, all else as text.
  std::vector<std::string> selected;
  {
    Result header(database, "select * from result limit 0", table.source);
    for (idx_t c = 0; c < header.columns(); ++c) {
      table.columns.push_back({header.name(c), is_number(header.type(c)), {}, {}});
      selected.push_back(fmt::format("cast({} as {})", quoted(header.name(c), '"'),
                                     table.columns.back().is_number ? "double" : "varchar"));
    }
  }
  Result rows(database, fmt::format("select {} from result", fmt::join(selected, ", ")),
              table.source);
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
  std::string source;
  Database database;
  std::vector<std::string> headings;
  std::vector<bool> is_numeric;
  duckdb_prepared_statement statement = nullptr;
  duckdb_result result{};
  bool running = false;
  std::size_t rows_seen = 0;

  ~State() {
    if (running) duckdb_destroy_result(&result);
    if (statement) duckdb_destroy_prepare(&statement);
  }
  [[noreturn]] void fail(const char* message) const {
    throw InputError(fmt::format("{}: {}", source, first_line(message)));
  }
};

ColumnStream::ColumnStream(const std::filesystem::path& file) : state_(std::make_unique<State>()) {
  state_->source = file.string();
  open_view(state_->database, file, state_->source);
  Result header(state_->database, "select * from data limit 0", state_->source);
  for (idx_t c = 0; c < header.columns(); ++c) {
    state_->headings.push_back(header.name(c));
    state_->is_numeric.push_back(is_number(header.type(c)));
  }
}

ColumnStream::~ColumnStream() = default;

const std::string& ColumnStream::source() const {
  return state_->source;
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
      Result any(state_->database, "select count(*) from (select 1 from data limit 1)", source());
      throw InputError(any.first_count() == 0 ? fmt::format("{} has no rows", source())
                                              : fmt::format("{}: column '{}' does not hold numbers",
                                                            source(), column));
    }
    selected.push_back(fmt::format("cast({} as double)", quoted(column, '"')));
  }
  const std::string query = fmt::format("select {} from data", fmt::join(selected, ", "));
  if (duckdb_prepare(state_->database.connection(), query.c_str(), &state_->statement) !=
      DuckDBSuccess)
    state_->fail(duckdb_prepare_error(state_->statement));
  if (duckdb_execute_prepared_streaming(state_->statement, &state_->result) != DuckDBSuccess) {
    const std::string message = first_line(duckdb_result_error(&state_->result));
    duckdb_destroy_result(&state_->result);
    state_->fail(message.c_str());
  }
  state_->running = true;
}

bool ColumnStream::next(Batch& batch) {
  duckdb_data_chunk chunk = duckdb_fetch_chunk(state_->result);
  if (!chunk) {
    const char* message = duckdb_result_error(&state_->result);
    if (message && *message) state_->fail(message);
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
