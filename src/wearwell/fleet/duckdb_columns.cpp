#include "wearwell/fleet/duckdb_columns.h"

#include <limits>

namespace wearwell::fleet {
namespace {

template <class T>
void append_whole(const void* data, idx_t size, std::vector<std::int64_t>& out) {
  const T* const x = static_cast<const T*>(data);
  out.assign(x, x + size);
}

/// False for a type that is neither text nor a 64-bit integer.
bool is_key(duckdb_type type) {
  switch (type) {
    case DUCKDB_TYPE_VARCHAR:
    case DUCKDB_TYPE_TINYINT:
    case DUCKDB_TYPE_UTINYINT:
    case DUCKDB_TYPE_SMALLINT:
    case DUCKDB_TYPE_USMALLINT:
    case DUCKDB_TYPE_INTEGER:
    case DUCKDB_TYPE_UINTEGER:
    case DUCKDB_TYPE_BIGINT:
      return true;
    default:
      return false;
  }
}

void read_wholes(duckdb_type type, const void* data, idx_t size, std::vector<std::int64_t>& out) {
  switch (type) {
    case DUCKDB_TYPE_TINYINT:
      return append_whole<std::int8_t>(data, size, out);
    case DUCKDB_TYPE_UTINYINT:
      return append_whole<std::uint8_t>(data, size, out);
    case DUCKDB_TYPE_SMALLINT:
      return append_whole<std::int16_t>(data, size, out);
    case DUCKDB_TYPE_USMALLINT:
      return append_whole<std::uint16_t>(data, size, out);
    case DUCKDB_TYPE_INTEGER:
      return append_whole<std::int32_t>(data, size, out);
    case DUCKDB_TYPE_UINTEGER:
      return append_whole<std::uint32_t>(data, size, out);
    default:
      return append_whole<std::int64_t>(data, size, out);
  }
}

class Scan : public ColumnScan {
 public:
  Scan(duckdb_connection connection, const std::string& query, const DuckdbFailure& fail)
      : fail_(fail) {
    start(connection, query);
    if (is_key(duckdb_column_type(&result_, 0))) return;
    duckdb_destroy_result(&result_);
    start(connection,
          "select cast(unit as varchar) as unit, * exclude (unit) from (" + query + ")");
  }
  ~Scan() override {
    if (chunk_) duckdb_destroy_data_chunk(&chunk_);
    duckdb_destroy_result(&result_);
  }
  Scan(const Scan&) = delete;
  Scan& operator=(const Scan&) = delete;

  bool next(ColumnChunk& to) override {
    if (chunk_) duckdb_destroy_data_chunk(&chunk_);
    chunk_ = duckdb_fetch_chunk(result_);
    if (!chunk_) {
      const char* error = duckdb_result_error(&result_);
      if (error && *error) fail_(error);
      return false;
    }
    const idx_t size = duckdb_data_chunk_get_size(chunk_);
    to.rows = size;
    read_key(duckdb_data_chunk_get_vector(chunk_, 0), size, to);
    to.values.clear();
    for (idx_t c = 1; c < duckdb_column_count(&result_); ++c) {
      duckdb_vector vector = duckdb_data_chunk_get_vector(chunk_, c);
      auto* data = static_cast<double*>(duckdb_vector_get_data(vector));
      uint64_t* valid = duckdb_vector_get_validity(vector);
      for (idx_t i = 0; valid && i < size; ++i) {
        if (!duckdb_validity_row_is_valid(valid, i))
          data[i] = std::numeric_limits<double>::quiet_NaN();
      }
      to.values.push_back(data);
    }
    return true;
  }

 private:
  void start(duckdb_connection connection, const std::string& query) {
    duckdb_prepared_statement statement = nullptr;
    std::string problem;
    if (duckdb_prepare(connection, query.c_str(), &statement) != DuckDBSuccess) {
      problem = duckdb_prepare_error(statement);
    } else if (duckdb_execute_prepared_streaming(statement, &result_) != DuckDBSuccess) {
      problem = duckdb_result_error(&result_);
      duckdb_destroy_result(&result_);
    }
    duckdb_destroy_prepare(&statement);
    if (!problem.empty()) fail_(problem);
  }

  void read_key(duckdb_vector vector, idx_t size, ColumnChunk& to) {
    uint64_t* valid = duckdb_vector_get_validity(vector);
    to.named.assign(size, 1);
    for (idx_t i = 0; valid && i < size; ++i)
      to.named[i] = duckdb_validity_row_is_valid(valid, i) ? 1 : 0;
    const duckdb_type type = duckdb_column_type(&result_, 0);
    to.has_words = type == DUCKDB_TYPE_VARCHAR;
    void* const data = duckdb_vector_get_data(vector);
    if (!to.has_words) return read_wholes(type, data, size, to.numbers);
    auto* texts = static_cast<duckdb_string_t*>(data);
    to.words.assign(size, {});
    for (idx_t i = 0; i < size; ++i) {
      if (to.named[i])
        to.words[i] = {duckdb_string_t_data(&texts[i]), duckdb_string_t_length(texts[i])};
    }
  }

  const DuckdbFailure fail_;
  duckdb_result result_{};
  duckdb_data_chunk chunk_ = nullptr;
};

class RowAppender : public ColumnEngine::Appender {
 public:
  RowAppender(duckdb_connection connection, const std::string& table, const DuckdbFailure& fail)
      : fail_(fail) {
    if (duckdb_appender_create_ext(connection, "temp", "main", table.c_str(), &appender_) !=
        DuckDBSuccess)
      complain();
  }
  ~RowAppender() override { duckdb_appender_destroy(&appender_); }
  RowAppender(const RowAppender&) = delete;
  RowAppender& operator=(const RowAppender&) = delete;

  void add(const ColumnEngine::WholeRow& row) override {
    bool good =
        duckdb_append_varchar_length(appender_, row.word.data(), row.word.size()) == DuckDBSuccess;
    for (const std::int64_t x : row.small)
      good &= duckdb_append_int64(appender_, x) == DuckDBSuccess;
    for (const ColumnEngine::Whole x : row.large)
      good &= duckdb_append_hugeint(
                  appender_, {static_cast<std::uint64_t>(x), static_cast<std::int64_t>(x >> 64)}) ==
              DuckDBSuccess;
    if (!good || duckdb_appender_end_row(appender_) != DuckDBSuccess) complain();
  }
  void finish() override {
    if (duckdb_appender_close(appender_) != DuckDBSuccess) complain();
  }

 private:
  void complain() {
    const char* const error = duckdb_appender_error(appender_);
    fail_(error ? error : "rows cannot be added");
  }

  const DuckdbFailure fail_;
  duckdb_appender appender_ = nullptr;
};

}  // namespace

std::unique_ptr<ColumnScan> duckdb_scan(duckdb_connection connection, const std::string& query,
                                        const DuckdbFailure& fail) {
  return std::make_unique<Scan>(connection, query, fail);
}

std::unique_ptr<ColumnEngine::Appender> duckdb_append(duckdb_connection connection,
                                                      const std::string& table,
                                                      const DuckdbFailure& fail) {
  return std::make_unique<RowAppender>(connection, table, fail);
}

}  // namespace wearwell::fleet
