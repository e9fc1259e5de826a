#include "wearwell/fleet/duckdb_engine.h"

#include <duckdb.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <chrono>
#include <cmath>
#include <future>
#include <limits>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/scratch_folder.h"
#include "wearwell/fleet/cycle_files.h"
#include "wearwell/fleet/duckdb_columns.h"
#include "wearwell/input/duckdb_closing.h"
#include "wearwell/input/duckdb_message.h"
#include "wearwell/input/duckdb_session.h"
#include "wearwell/input/equal_names.h"

namespace wearwell::fleet {
namespace {

namespace fs = std::filesystem;

long half_of_memory() {
  return sysconf(_SC_PHYS_PAGES) / 2 * (sysconf(_SC_PAGESIZE) / 1024) / 1024;
}

class Answer {
 public:
  Answer() = default;
  ~Answer() { duckdb_destroy_result(&result); }
  Answer(const Answer&) = delete;
  Answer& operator=(const Answer&) = delete;
  duckdb_result result{};
};

class DuckdbEngine : public Engine, public ColumnEngine {
 public:
  explicit DuckdbEngine(const DuckdbSettings& settings);
  ~DuckdbEngine() override { close(); }

  Dialect dialect() const override { return Dialect::duckdb; }
  std::string description() const override {
    return fmt::format("DuckDB {}", duckdb_library_version());
  }
  std::string table() const override { return "cycles"; }
  std::string source() const override { return source_; }
  std::string layout() const override { return files_.layout; }
  std::vector<EngineColumn> columns() override;
  void begin() override { execute("begin transaction"); }
  void commit() override { execute("commit"); }
  void run(const std::string& statements, const Monitor& monitor, const std::string& what,
           long long total) override;
  void rows(const std::string& query, std::size_t texts,
            const std::function<void(const Row&)>& take) override;

  long long known_rows() override;
  long memory() const override { return memory_; }
  std::unique_ptr<ColumnScan> scan(const std::string& query) override;
  std::unique_ptr<Appender> append(const std::string& table) override {
    return duckdb_append(connection_, table, [this](const std::string& error) { fail(error); });
  }

 private:
  void close();
  void execute(const std::string& statements, Answer& answer);
  void execute(const std::string& statements) {
    Answer answer;
    execute(statements, answer);
  }
  std::vector<std::string> expand(const std::vector<std::string>& patterns);
  void refuse_repeated_headings(const std::string& file);
  [[noreturn]] void fail(const std::string& message) const;

  ScratchFolder spill_;
  long memory_;
  std::string source_, view_;
  CycleFiles files_;
  duckdb_database database_ = nullptr;
  /// The second connection scans, while the first keeps the results.
  duckdb_connection connection_ = nullptr, scanning_ = nullptr;
};

DuckdbEngine::DuckdbEngine(const DuckdbSettings& settings)
    : spill_(settings.spill.empty() ? fs::path(".") : settings.spill),
      memory_(settings.memory > 0 ? settings.memory : half_of_memory()),
      source_(fmt::format("{}", fmt::join(settings.files, ", "))) {
  const fs::path database =
      settings.state.empty() ? spill_.path() / "sums.duckdb" : fs::absolute(settings.state);
  char* problem = nullptr;
  if (duckdb_open_ext(database.c_str(), &database_, nullptr, &problem) != DuckDBSuccess) {
    const std::string message = problem ? problem : "unknown";
    duckdb_free(problem);
    throw InputError(fmt::format("{} cannot be opened as a database of DuckDB: {}",
                                 settings.state.string(), printable(duckdb_sentence(message))));
  }
  try {
    if (duckdb_connect(database_, &connection_) != DuckDBSuccess)
      throw MachineError("cannot start DuckDB");
    execute("set autoinstall_known_extensions = false; set autoload_known_extensions = false");
    const double quarter = 0x1p20 * static_cast<double>(memory_) / 4;
    files_ = cycle_files(expand(settings.files), source_, settings.skip_bad, quarter);
    std::vector<std::string> allowed;
    for (const std::string& file : files_.paths) allowed.push_back(quoted(file, '\''));
    if (settings.threads > 0) execute(fmt::format("set threads = {}", settings.threads));
    execute(
        fmt::format("set memory_limit = '{}MiB'; set temp_directory = {}; set "
                    "preserve_insertion_order = true; "
                    "set enable_progress_bar = {}; set enable_progress_bar_print = false; set "
                    "allowed_paths = "
                    "[{}]; set allowed_directories = [{}]; set enable_external_access = false; set "
                    "lock_configuration = true",
                    memory_, quoted((spill_.path() / "spill").string(), '\''), settings.progress,
                    fmt::join(allowed, ", "), quoted(spill_.path().string() + "/", '\'')));
    view_ = "create or replace temp view cycles as select * from " + reader_of(files_, "");
    execute(view_);
    for (const std::string& file : files_.paths) refuse_repeated_headings(file);
    bool has_rows = false;
    rows("select 1e0 from cycles limit 1", 0, [&](const Row&) { has_rows = true; });
    if (!has_rows) throw InputError(fmt::format("{} has no rows", source_));
    for (const EngineColumn& each : columns()) {
      if (each.name != settings.unit || !each.is_number || !files_.csv) continue;
      view_ =
          "create or replace temp view cycles as select * from " + reader_of(files_, settings.unit);
      execute(view_);
    }
  } catch (...) {
    close();
    throw;
  }
}

void DuckdbEngine::close() {
  if (scanning_) duckdb_interrupt(scanning_);
  close_duckdb([this] {
    if (scanning_) duckdb_disconnect(&scanning_);
    if (connection_) duckdb_disconnect(&connection_);
    if (database_) duckdb_close(&database_);
  });
}

void DuckdbEngine::fail(const std::string& message) const {
  const auto has = [&](const char* part) { return message.find(part) != std::string::npos; };
  if (has("INTERRUPT")) throw Cancelled();
  if (boost::algorithm::starts_with(message, "Out of Memory"))
    throw MachineError(fmt::format("DuckDB needs more than its limit of {} MB (--memory): {}",
                                   memory_, printable(duckdb_sentence(message))));
  if (has("No space left"))
    throw MachineError(fmt::format("no space left in {} for data that do not fit into memory",
                                   spill_.path().parent_path().parent_path().string()));
  if (files_.csv && (has("Error when sniffing file") || has("unterminated quote")))
    refuse_invalid_lines(files_);
  std::string said = duckdb_sentence(message);
  for (std::size_t i = 0; i < files_.paths.size() && i < files_.names.size(); ++i)
    if (files_.paths[i] != files_.names[i])
      boost::algorithm::replace_all(said, files_.paths[i], files_.names[i]);
  throw InputError(fmt::format("{}: {}", source_, printable(said)));
}

void DuckdbEngine::execute(const std::string& statements, Answer& answer) {
  if (duckdb_query(connection_, statements.c_str(), &answer.result) == DuckDBSuccess) return;
  const char* error = duckdb_result_error(&answer.result);
  fail(error ? error : "an unknown error");
}

std::vector<std::string> DuckdbEngine::expand(const std::vector<std::string>& patterns) {
  std::vector<std::string> files;
  for (const std::string& pattern : patterns) {
    std::error_code ignored;
    refuse_remote(pattern);
    // Special characters in a file name are literal.
    if (fs::is_regular_file(pattern, ignored)) {
      files.push_back(fs::absolute(pattern).string());
      continue;
    }
    const std::size_t before = files.size();
    rows(fmt::format("select file from glob({}) order by file", quoted(pattern, '\'')), 1,
         [&](const Row& row) { files.push_back(fs::absolute(row.texts.front()).string()); });
    if (files.size() == before)
      throw InputError(fmt::format("there is no file {}", printable(pattern)));
  }
  return files;
}

// DuckDB renames the second of two columns with the same name, and ignores case.
void DuckdbEngine::refuse_repeated_headings(const std::string& file) {
  Answer answer;
  std::vector<std::string> names;
  const auto text = [&](idx_t column, idx_t row) {
    char* const value = duckdb_value_varchar(&answer.result, column, row);
    names.push_back(printable(value ? value : ""));
    duckdb_free(value);
  };
  if (files_.csv) {
    execute(
        fmt::format("select * from read_csv({}, header = false, all_varchar = true, delim = {}, "
                    "quote = '\"', escape = '\"', ignore_errors = true) limit 1",
                    quoted(file, '\''), quoted(std::string(1, files_.delimiter), '\'')),
        answer);
    if (duckdb_row_count(&answer.result) == 0) return;
    for (idx_t c = 0; c < duckdb_column_count(&answer.result); ++c) text(c, 0);
  } else {
    // The first row is the schema itself; an element with children is not a column.
    execute(fmt::format("select name from parquet_schema({}) where coalesce(num_children, 0) = 0",
                        quoted(file, '\'')),
            answer);
    for (idx_t r = 0; r < duckdb_row_count(&answer.result); ++r) text(0, r);
  }
  refuse_equal_names(names, printable(file));
}

std::vector<EngineColumn> DuckdbEngine::columns() {
  Answer answer;
  execute("select * from cycles limit 0", answer);
  std::vector<EngineColumn> found;
  // DuckDB gives the values beyond the heading a column of their own where short lines are padded.
  if (files_.all_text && duckdb_column_count(&answer.result) > files_.headings)
    throw InputError(fmt::format(
        "{}{}: a line has {} values, but the heading has {}; --skip-bad leaves out no line that is "
        "too long: a decimal comma may have cut a number in two",
        printable(files_.names.front()), files_.names.size() > 1 ? " or another file" : "",
        duckdb_column_count(&answer.result), files_.headings));
  for (idx_t c = 0; c < duckdb_column_count(&answer.result); ++c) {
    const duckdb_type type = duckdb_column_type(&answer.result, c);
    found.push_back(
        {duckdb_column_name(&answer.result, c), is_number(type),
         type == DUCKDB_TYPE_DOUBLE || type == DUCKDB_TYPE_FLOAT || type == DUCKDB_TYPE_DECIMAL,
         type == DUCKDB_TYPE_DATE,
         type == DUCKDB_TYPE_TIMESTAMP || type == DUCKDB_TYPE_TIMESTAMP_S ||
             type == DUCKDB_TYPE_TIMESTAMP_MS || type == DUCKDB_TYPE_TIMESTAMP_NS ||
             type == DUCKDB_TYPE_TIMESTAMP_TZ});
    if (files_.all_text) found.back().text_decimal = files_.decimal;
  }
  return found;
}

void DuckdbEngine::run(const std::string& statements, const Monitor& monitor,
                       const std::string& what, long long total) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  auto work = std::async(std::launch::async, [&] { execute(statements); });
  while (work.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready) {
    if (monitor.stop.stop_requested()) duckdb_interrupt(connection_);
    const double done = duckdb_query_progress(connection_).percentage;
    if (monitor.progress && done >= 0 && total > 0)
      monitor.progress({what, static_cast<long long>(done / 100 * static_cast<double>(total)),
                        total, std::chrono::duration<double>(Clock::now() - start).count()});
  }
  work.get();
}

void DuckdbEngine::rows(const std::string& query, std::size_t texts,
                        const std::function<void(const Row&)>& take) {
  duckdb_prepared_statement statement = nullptr;
  Answer answer;
  std::string problem;
  if (duckdb_prepare(connection_, query.c_str(), &statement) != DuckDBSuccess) {
    problem = duckdb_prepare_error(statement);
  } else if (duckdb_execute_prepared_streaming(statement, &answer.result) != DuckDBSuccess) {
    problem = duckdb_result_error(&answer.result);
  }
  duckdb_destroy_prepare(&statement);
  if (!problem.empty()) fail(problem);
  Row row;
  row.texts.resize(texts);
  const idx_t count = duckdb_column_count(&answer.result);
  row.numbers.resize(count - texts);
  std::vector<std::vector<std::string>> words(texts);
  std::vector<std::vector<double>> numbers(count - texts);
  while (duckdb_data_chunk chunk = duckdb_fetch_chunk(answer.result)) {
    const idx_t size = duckdb_data_chunk_get_size(chunk);
    for (idx_t c = 0; c < count; ++c) {
      duckdb_vector vector = duckdb_data_chunk_get_vector(chunk, c);
      if (c < texts) {
        words[c].clear();
        append_text(vector, size, words[c]);
      } else {
        numbers[c - texts].clear();
        append_numbers(vector, size, numbers[c - texts]);
      }
    }
    duckdb_destroy_data_chunk(&chunk);
    for (idx_t i = 0; i < size; ++i) {
      for (std::size_t c = 0; c < texts; ++c) row.texts[c] = words[c][i];
      for (std::size_t c = 0; c < numbers.size(); ++c) row.numbers[c] = numbers[c][i];
      take(row);
    }
  }
  const char* error = duckdb_result_error(&answer.result);
  if (error && *error) fail(error);
}

long long DuckdbEngine::known_rows() {
  double count = 0;
  if (!files_.csv)
    rows("select cast(count(*) as double) from cycles", 0,
         [&](const Row& row) { count = row.numbers[0]; });
  return static_cast<long long>(count);
}

std::unique_ptr<ColumnScan> DuckdbEngine::scan(const std::string& query) {
  const auto refuse = [this](const std::string& error) { fail(error); };
  if (!scanning_) {
    if (duckdb_connect(database_, &scanning_) != DuckDBSuccess)
      throw MachineError("cannot start DuckDB");
    Answer answer;
    if (duckdb_query(scanning_, view_.c_str(), &answer.result) != DuckDBSuccess)
      fail(duckdb_result_error(&answer.result));
  }
  return duckdb_scan(scanning_, query, refuse);
}

}  // namespace

std::unique_ptr<Engine> duckdb_engine(const DuckdbSettings& settings) {
  return std::make_unique<DuckdbEngine>(settings);
}

}  // namespace wearwell::fleet
