#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/fleet/engine.h"

namespace wearwell::fleet {

/// Some rows by column. The pointers are valid until the next rows are requested.
struct ColumnChunk {
  std::size_t rows = 0;
  bool has_words = false;  ///< `words` name units; else `numbers` do
  std::vector<std::string_view> words;
  std::vector<std::int64_t> numbers;
  std::vector<char> named;            ///< whether the row has a unit
  std::vector<const double*> values;  ///< NaN if missing
};

/// A running query, in the order of the table's rows unless it has another.
class ColumnScan {
 public:
  virtual ~ColumnScan() = default;
  /// False after the last row.
  virtual bool next(ColumnChunk& chunk) = 0;
};

/// Further functions of an engine within the program: it gives columns, and takes rows.
class ColumnEngine {
 public:
  virtual ~ColumnEngine() = default;
  /// Rows of the table of cycles; 0 if they are not known without reading it.
  virtual long long known_rows() = 0;
  /// Memory limit in MB.
  virtual long memory() const = 0;
  /// The first column is `unit`, all others are doubles.
  virtual std::unique_ptr<ColumnScan> scan(const std::string& query) = 0;

  /// A 128-bit integer.
  __extension__ typedef __int128 Whole;
  struct WholeRow {
    std::string_view word;
    const std::vector<std::int64_t>& small;
    const std::vector<Whole>& large;
  };
  /// Into a temporary table of one text, then 64-bit and 128-bit numbers.
  class Appender {
   public:
    virtual ~Appender() = default;
    virtual void add(const WholeRow& row) = 0;
    virtual void finish() = 0;
  };
  virtual std::unique_ptr<Appender> append(const std::string& table) = 0;
};

}  // namespace wearwell::fleet
