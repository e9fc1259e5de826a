#include "wearwell/input/duckdb_session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <limits>
#include <mutex>
#include <system_error>
#include <thread>

#include "wearwell/base/error.h"
#include "wearwell/input/duckdb_message.h"
#include "wearwell/input/thousands.h"

namespace wearwell {
namespace {

// Without BOOLEAN: a column of the letter F alone (failures) would be read as false.
constexpr const char* csv_types = "['BIGINT', 'DOUBLE', 'TIME', 'DATE', 'TIMESTAMP', 'VARCHAR']";

/// Half of the machine's memory, in MB; what a table may take within DuckDB.
long memory_limit() {
  return sysconf(_SC_PHYS_PAGES) / 2 * (sysconf(_SC_PAGESIZE) / 1024) / 1024;
}

/// Interrupts what runs on a connection when its time is over.
class Deadline {
 public:
  Deadline(duckdb_connection connection, double seconds)
      : thread_([this, connection, seconds] {
          std::unique_lock lock(mutex_);
          if (!changed_.wait_for(lock, std::chrono::duration<double>(seconds),
                                 [this] { return done_; }))
            duckdb_interrupt(connection);
        }) {}
  ~Deadline() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    changed_.notify_one();
    thread_.join();
  }
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
  std::thread thread_;
};

/// The text that makes DuckDB read the file. Nothing is left to guessing that could drop or join
/// lines: comments, leading lines, ragged lines, patterns in names, columns out of folders.
std::string reader(const TableFile& file, const std::optional<CsvHeading>& heading, bool as_text) {
  const std::string path = quoted(file.path(), '\'');
  const char* packed = file.gzip() ? "gzip" : "uncompressed";
  switch (file.format()) {
    case TableFormat::csv:
      return fmt::format(
          "read_csv({}, compression = '{}', delim = {}, quote = '\"', escape = '\"', header = "
          "true, skip = 0, comment = '', strict_mode = true, null_padding = false, ignore_errors = "
          "false, hive_partitioning = false, {})",
          path, file.gzip() ? "gzip" : "none", quoted(std::string(1, heading->delimiter), '\''),
          as_text ? "all_varchar = true" : fmt::format("auto_type_candidates = {}", csv_types));
    case TableFormat::json:
      return fmt::format(
          "read_json({}, compression = '{}', ignore_errors = false, hive_partitioning = false)",
          path, packed);
    case TableFormat::parquet:
      break;
  }
  return fmt::format("read_parquet({}, hive_partitioning = false)", path);
}

}  // namespace

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

DuckdbResult::DuckdbResult(const DuckdbSession& session, const std::string& query) {
  if (duckdb_query(session.connection(), query.c_str(), &result_) == DuckDBSuccess) return;
  const char* error = duckdb_result_error(&result_);
  const std::string message = error ? error : "";
  duckdb_destroy_result(&result_);
  session.fail(message);
}

DuckdbSession::DuckdbSession(const TableFile& file) : file_(file) {
  if (file.format() == TableFormat::csv) heading_ = read_csv_heading(file);
  if (duckdb_open(nullptr, &database_) != DuckDBSuccess ||
      duckdb_connect(database_, &connection_) != DuckDBSuccess)
    throw MachineError("cannot start DuckDB");
  try {
    DuckdbResult(
        *this, fmt::format("set temp_directory = ''; set autoinstall_known_extensions = false; set "
                           "autoload_known_extensions = false; set allowed_paths = [{}]; set "
                           "memory_limit = '{}MiB'; set enable_external_access = false; set "
                           "lock_configuration = true",
                           quoted(file.path(), '\''), memory_limit()));
    open_view();
    if (heading_) refuse_thousands_marks();
  } catch (...) {
    close();
    throw;
  }
}

DuckdbSession::~DuckdbSession() {
  close();
}

/// Ends a query that still runs, and the threads that work for it. While an exception is on its way
/// through the thread that disconnects, DuckDB does not wait for the others: they go on in memory
/// that is freed (ClientContext::~ClientContext). So that is left to a thread without one.
void DuckdbSession::close() {
  if (connection_) duckdb_interrupt(connection_);
  const auto disconnect = [this] {
    duckdb_disconnect(&connection_);
    duckdb_close(&database_);
  };
  if (std::uncaught_exceptions() == 0) {
    disconnect();
    return;
  }
  try {
    std::thread(disconnect).join();
  } catch (const std::system_error&) {
    // No thread to be had: the database stays open, and what works for it has its memory.
  }
}

void DuckdbSession::fail(const std::string& message) const {
  if (message.starts_with("Out of Memory"))
    throw MachineError(fmt::format("{} does not fit into the {} MB that a table may take here",
                                   file_.source(), memory_limit()));
  if (heading_) {
    if (const std::string fault = csv_fault(file_, *heading_); !fault.empty())
      throw InputError(fmt::format("{}, {}", file_.source(), fault));
  }
  std::string sentence = duckdb_sentence(message);
  boost::algorithm::replace_all(sentence, file_.path(), file_.source());
  throw InputError(
      fmt::format("{}{}{}", file_.source(), sentence.starts_with("line ") ? ", " : ": ", sentence));
}

void DuckdbSession::open_view() {
  DuckdbResult(*this, "create view data as select * from " + reader(file_, heading_, false));
}

/// The first row of a query for texts; empty where there is none.
std::vector<std::string> DuckdbSession::first_row(const std::string& query) const {
  DuckdbResult rows(*this, query);
  std::vector<std::string> cells;
  duckdb_data_chunk chunk = rows.next();
  for (idx_t c = 0; chunk && c < rows.columns() && duckdb_data_chunk_get_size(chunk) > 0; ++c)
    append_text(duckdb_data_chunk_get_vector(chunk, c), 1, cells);
  if (chunk) duckdb_destroy_data_chunk(&chunk);
  return cells;
}

/// A column that holds dots, each of which may be a mark for thousands, is refused where the file
/// shows commas as decimal marks; and where the commas do not separate the columns (as they do
/// where the dot is the decimal mark) and no other column has a dot that must be a decimal mark.
void DuckdbSession::refuse_thousands_marks() {
  std::vector<std::string> numbers, texts;
  {
    DuckdbResult header(*this, "select * from data limit 0");
    for (idx_t c = 0; c < header.columns(); ++c) {
      const duckdb_type type = header.type(c);
      if (type == DUCKDB_TYPE_DOUBLE) numbers.push_back(header.name(c));
      if (type == DUCKDB_TYPE_VARCHAR) texts.push_back(header.name(c));
    }
  }
  if (numbers.empty()) return;
  // The cells as they are written. Where dots are decimal marks, the first rows show it.
  const std::string cells = reader(file_, heading_, true);
  const auto cell = [](const std::string& name) {
    return fmt::format("trim({})", quoted(name, '"'));
  };
  std::vector<std::string> is_decimal, doubtful;
  for (const std::string& name : numbers)
    is_decimal.push_back(fmt::format("(contains({0}, '.') and not regexp_full_match({0}, '{1}'))",
                                     cell(name), thousands_pattern));
  std::vector<std::string> early;
  for (const std::string& each : is_decimal)
    early.push_back(fmt::format("cast(bool_or({}) as varchar)", each));
  early = first_row(
      fmt::format("select {} from (select * from {} limit 2048)", fmt::join(early, ", "), cells));
  for (std::size_t c = 0; c < numbers.size(); ++c) {
    if (c < early.size() && early[c] == "true") continue;
    if (first_row(fmt::format("select 'here' from {} where {} limit 1", cells, is_decimal[c]))
            .empty())
      doubtful.push_back(numbers[c]);
  }
  const bool dots_are_decimal = heading_->delimiter == ',' || doubtful.size() < numbers.size();
  for (const std::string& name : doubtful) {
    const auto found =
        first_row(fmt::format("select cast(row as varchar), cell from (select row_number() over () "
                              "as row, {} as cell from "
                              "{}) where regexp_full_match(cell, '{}') limit 1",
                              cell(name), cells, thousands_pattern));
    if (found.empty()) continue;
    std::vector<std::string> comma;
    for (std::size_t t = 0; t < texts.size() && comma.empty(); ++t)
      comma =
          first_row(fmt::format("select {0} from {1} where regexp_full_match({0}, '{2}') limit 1",
                                cell(texts[t]), cells, decimal_comma_pattern));
    if (comma.empty() && dots_are_decimal) continue;
    throw InputError(fmt::format(
        "{}, row {}, column '{}': {}{}", file_.source(), found[0], name, two_readings(found[1]),
        comma.empty() ? "" : fmt::format(" (the file has '{}', with a decimal comma)", comma[0])));
  }
}

void run_query(const DuckdbSession& session, const std::string& query, const QueryLimits& limits) {
  const std::string source = session.file().source() + " (through sql)";
  const auto refuse = [&](const std::string& reason) {
    throw QueryError(fmt::format("{}: {}", source, reason));
  };
  const auto describe = [&](const char* message) {
    std::string sentence = duckdb_sentence(message ? message : "");
    boost::algorithm::replace_all(sentence, session.file().path(), session.file().source());
    return sentence;
  };
  duckdb_extracted_statements statements = nullptr;
  const idx_t count = duckdb_extract_statements(session.connection(), query.c_str(), &statements);
  std::string reason;
  if (count == 0) {
    const char* error = duckdb_extract_statements_error(statements);
    reason = error ? describe(error) : "it is empty";
  } else if (count > 1) {
    reason = "it must be one SELECT, and nothing behind it";
  } else {
    duckdb_prepared_statement statement = nullptr;
    const bool prepared = duckdb_prepare_extracted_statement(session.connection(), statements, 0,
                                                             &statement) == DuckDBSuccess;
    if (!prepared) {
      reason = describe(duckdb_prepare_error(statement));
    } else if (duckdb_prepared_statement_type(statement) != DUCKDB_STATEMENT_TYPE_SELECT) {
      reason = "it must be one SELECT; nothing else is possible";
    } else if (duckdb_nparams(statement) > 0) {
      reason = "it has a parameter ('?' or '$'), for which there is no value";
    }
    duckdb_destroy_prepare(&statement);
  }
  duckdb_destroy_extracted(&statements);
  if (!reason.empty()) refuse(reason);

  duckdb_result result;
  duckdb_state outcome = DuckDBSuccess;
  {
    const Deadline deadline(session.connection(), limits.seconds);
    outcome = duckdb_query(session.connection(), ("create temp table result as " + query).c_str(),
                           &result);
  }
  if (outcome != DuckDBSuccess) {
    const std::string message =
        duckdb_result_error(&result) ? duckdb_result_error(&result) : "an unknown error";
    if (message.starts_with("INTERRUPT")) {
      reason = fmt::format("it takes more than the {:g} seconds that it may", limits.seconds);
    } else if (message.starts_with("Out of Memory")) {
      reason = fmt::format("it takes more than the {} MB of memory that it may", memory_limit());
    } else {
      reason = describe(message.c_str());
    }
  }
  duckdb_destroy_result(&result);
  if (!reason.empty()) refuse(reason);
}

}  // namespace wearwell
