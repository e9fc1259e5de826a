#include "wearwell/input/duckdb_session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <map>
#include <mutex>
#include <thread>

#include "wearwell/base/error.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/input/duckdb_closing.h"
#include "wearwell/input/duckdb_message.h"
#include "wearwell/input/equal_names.h"
#include "wearwell/input/stoppable_query.h"
#include "wearwell/input/text_lines.h"
#include "wearwell/input/text_rewrite.h"
#include "wearwell/input/workbook.h"

namespace wearwell {
namespace {

// Without BOOLEAN, because a column with only the letter F (failures) would be read as false.
// Without BIGINT, because 2.5 after thousands of whole numbers would be read as 3.
constexpr const char* csv_types = "['DOUBLE', 'TIME', 'DATE', 'TIMESTAMP', 'VARCHAR']";
// Other dates stay text: 01/02/2024 would silently be the first of February.
constexpr const char* csv_dates = "dateformat = '%Y-%m-%d', timestampformat = '%Y-%m-%d %H:%M:%S'";

/// The memory limit of DuckDB: half of the machine's memory, in MB.
long memory_limit() {
  return sysconf(_SC_PHYS_PAGES) / 2 * (sysconf(_SC_PAGESIZE) / 1024) / 1024;
}

/// Interrupts the query of a connection at its deadline.
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

/// Checks that the settings apply to this kind of table. Throws InputError.
TableSettings settings_for(const TableFile& file, TableSettings settings) {
  const bool workbook = file.format() == TableFormat::workbook;
  if (!workbook && (settings.sheet || settings.range || settings.hidden_rows))
    throw InputError(fmt::format(
        "{} is not a workbook; sheet, range and hidden_rows are keys for .xlsx", file.source()));
  if (workbook && (settings.delimiter || settings.encoding))
    throw InputError(fmt::format(
        "{}: delimiter and encoding are keys for tables of text (.csv, .txt)", file.source()));
  if (file.format() != TableFormat::text && !workbook &&
      (settings.decimal || settings.thousands || settings.delimiter || settings.encoding))
    throw InputError(fmt::format(
        "{}: decimal, thousands, delimiter and encoding are keys for tables of text (.csv, .txt)",
        file.source()));
  if (file.format() != TableFormat::text && !workbook &&
      (settings.header_row || settings.units_row || settings.summary_rows || settings.comment))
    throw InputError(fmt::format(
        "{}: header_row, units_row, summary_rows and comment are keys for .csv, .txt and "
        ".xlsx",
        file.source()));
  if (workbook) {
    settings.decimal = '.';
    settings.thousands = 0;
    settings.delimiter = ',';
    settings.encoding = Encoding::utf8;
  }
  return settings;
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
  const StoppableQuery stoppable(session.connection());
  if (duckdb_query(session.connection(), query.c_str(), &result_) == DuckDBSuccess) return;
  const char* error = duckdb_result_error(&result_);
  const std::string message = error ? error : "";
  duckdb_destroy_result(&result_);
  check_stop();
  session.fail(message);
}

DuckdbSession::DuckdbSession(const TableFile& file, const TableSettings& settings)
    : file_(file), settings_(settings_for(file, settings)) {
  std::map<std::size_t, std::string> doubts;
  std::vector<std::string> notes;
  if (file.format() == TableFormat::workbook) {
    SheetText sheet = sheet_text(file, settings);
    sheet_ = std::move(sheet.text);
    sheet_name_ = std::move(sheet.name);
    doubts = std::move(sheet.doubts);
    notes = std::move(sheet.notes);
  }
  if (file.format() == TableFormat::text || sheet_) {
    layout_ = find_layout(read(), settings_);
    for (auto& [column, doubt] : doubts) {
      if (column >= layout_->columns.size() || !layout_->columns[column].doubt.empty()) continue;
      TextColumn& doubtful = layout_->columns[column];
      doubtful.doubt = fmt::format("column '{}': {}", doubtful.name, doubt);
      layout_->plain = false;
    }
    layout_->notes.insert(layout_->notes.begin(), notes.begin(), notes.end());
    if (!layout_->plain) rewritten_ = rewritten(read(), *layout_, lines_);
  }
  if (duckdb_open(nullptr, &database_) != DuckDBSuccess ||
      duckdb_connect(database_, &connection_) != DuckDBSuccess)
    throw MachineError("cannot start DuckDB");
  try {
    const DuckdbResult configured(
        *this, fmt::format("set temp_directory = ''; set autoinstall_known_extensions = false; set "
                           "autoload_known_extensions = false; set allowed_paths = [{}]; set "
                           "memory_limit = '{}MiB'; set enable_external_access = false; set "
                           "lock_configuration = true",
                           quoted(read().path(), '\''), memory_limit()));
    if (file.format() == TableFormat::parquet) refuse_equal_columns();
    DuckdbResult(*this, "create view data as select * from " + reader());
  } catch (...) {
    close();
    throw;
  }
}

DuckdbSession::~DuckdbSession() {
  close();
}

/// Ends a running query and its worker threads.
void DuckdbSession::close() {
  if (connection_) duckdb_interrupt(connection_);
  close_duckdb([this] {
    duckdb_disconnect(&connection_);
    duckdb_close(&database_);
  });
}

void DuckdbSession::fail(const std::string& message) const {
  if (message.starts_with("Out of Memory"))
    throw MachineError(fmt::format("{} exceeds the memory limit of {} MB for tables",
                                   file_.source(), memory_limit()));
  if (layout_ && !rewritten_) {
    // A line far below the inspected ones may be invalid UTF-8.
    const TextLayout whole = find_layout(read(), settings_, true);
    if (whole.encoding != layout_->encoding)
      throw InputError(
          fmt::format("{} is not UTF-8 in all lines; state encoding = \"{}\" in [data]",
                      file_.source(), encoding_name(whole.encoding)));
  }
  const std::string what = sentence(message);
  throw InputError(
      fmt::format("{}{}{}", file_.source(), what.starts_with("line ") ? ", " : ": ", what));
}

std::string DuckdbSession::sentence(const std::string& message) const {
  std::string text = duckdb_sentence(message);
  boost::algorithm::replace_all(text, read().path(), file_.source());
  return text;
}

TableLayout DuckdbSession::layout_text() const {
  if (!layout_) return {};
  return {description(*layout_, sheet_name_), layout_->notes};
}

const TextColumn* DuckdbSession::column(const std::string& name) const {
  if (!layout_) return nullptr;
  const auto found = std::find_if(layout_->columns.begin(), layout_->columns.end(),
                                  [&](const TextColumn& each) { return each.name == name; });
  return found == layout_->columns.end() ? nullptr : &*found;
}

// DuckDB renames the second of two columns with one name, so names are read from the Parquet
// schema. It is a tree, root first; children of a column are not columns.
void DuckdbSession::refuse_equal_columns() const {
  DuckdbResult schema(*this, fmt::format("select cast(name as varchar), "
                                         "cast(coalesce(num_children, 0) as double) "
                                         "from parquet_schema({})",
                                         quoted(read().path(), '\'')));
  std::vector<std::string> all, names;
  std::vector<double> children;
  for (duckdb_data_chunk chunk = schema.next(); chunk; chunk = schema.next()) {
    const idx_t count = duckdb_data_chunk_get_size(chunk);
    append_text(duckdb_data_chunk_get_vector(chunk, 0), count, all);
    append_numbers(duckdb_data_chunk_get_vector(chunk, 1), count, children);
    duckdb_destroy_data_chunk(&chunk);
  }
  for (std::size_t i = 1; i < all.size();) {
    names.push_back(all[i]);
    for (double within = 1; within > 0 && i < all.size(); ++i) within += children[i] - 1;
  }
  refuse_equal_names(names, file_.source());
}

/// The SQL that reads the file. Disables all detection that could drop or join lines: comments,
/// leading lines, ragged lines, patterns in names, columns from folder names.
std::string DuckdbSession::reader() const {
  const std::string path = quoted(read().path(), '\'');
  const char* packed = file_.gzip() ? "gzip" : "uncompressed";
  if (layout_) {
    std::vector<std::string> names, types;
    for (const TextColumn& each : layout_->columns) {
      names.push_back(quoted(each.name, '\''));
      types.push_back(fmt::format("{}: '{}'", names.back(),
                                  each.is_number && each.doubt.empty() ? "DOUBLE" : "VARCHAR"));
    }
    return fmt::format(
        "read_csv({}, compression = '{}', delim = {}, quote = '\"', escape = '\"', header = true, "
        "skip = 0, comment = '', strict_mode = true, null_padding = false, ignore_errors = false, "
        "hive_partitioning = false, {}, {})",
        path, read().gzip() ? "gzip" : "none",
        quoted(std::string(1, rewritten_ ? ',' : layout_->delimiter), '\''),
        rewritten_ ? fmt::format("auto_detect = false, columns = {{{}}}", fmt::join(types, ", "))
                   : fmt::format("names = [{}], auto_type_candidates = {}", fmt::join(names, ", "),
                                 csv_types),
        csv_dates);
  }
  if (file_.format() == TableFormat::json)
    return fmt::format(
        "read_json({}, compression = '{}', ignore_errors = false, hive_partitioning = false, "
        "sample_size = -1)",
        path, packed);
  return fmt::format("read_parquet({}, hive_partitioning = false)", path);
}

void run_query(const DuckdbSession& session, const std::string& query, const QueryLimits& limits) {
  const std::string source = session.file().source() + " (through sql)";
  const auto refuse = [&](const std::string& reason) {
    throw QueryError(fmt::format("{}: {}", source, reason));
  };
  const auto describe = [&](const char* message) {
    return session.sentence(message ? message : "");
  };
  duckdb_extracted_statements statements = nullptr;
  const idx_t count = duckdb_extract_statements(session.connection(), query.c_str(), &statements);
  std::string reason;
  if (count == 0) {
    const char* error = duckdb_extract_statements_error(statements);
    reason = error ? describe(error) : "it is empty";
  } else if (count > 1) {
    reason = "it must be one SELECT, with nothing after it";
  } else {
    duckdb_prepared_statement statement = nullptr;
    const bool prepared = duckdb_prepare_extracted_statement(session.connection(), statements, 0,
                                                             &statement) == DuckDBSuccess;
    if (!prepared) {
      reason = describe(duckdb_prepare_error(statement));
    } else if (duckdb_prepared_statement_type(statement) != DUCKDB_STATEMENT_TYPE_SELECT) {
      reason = "it must be one SELECT";
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
    const StoppableQuery stoppable(session.connection());
    outcome = duckdb_query(session.connection(), ("create temp table result as " + query).c_str(),
                           &result);
  }
  if (outcome != DuckDBSuccess) {
    const std::string message =
        duckdb_result_error(&result) ? duckdb_result_error(&result) : "an unknown error";
    if (message.starts_with("INTERRUPT")) {
      reason = fmt::format("it exceeds the time limit of {:g} seconds", limits.seconds);
    } else if (message.starts_with("Out of Memory")) {
      reason = fmt::format("it exceeds the memory limit of {} MB", memory_limit());
    } else {
      reason = describe(message.c_str());
    }
  }
  duckdb_destroy_result(&result);
  check_stop();
  if (!reason.empty()) refuse(reason);
}

}  // namespace wearwell
