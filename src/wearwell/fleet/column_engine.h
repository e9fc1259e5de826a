#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/fleet/engine.h"

namespace wearwell::fleet {

/// Some rows by column. What it points to is there until the next are asked for.
struct ColumnChunk {
  std::size_t rows = 0;
  bool has_words = false;  ///< `words` name units; else `numbers` do
  std::vector<std::string_view> words;
  std::vector<std::int64_t> numbers;
  std::vector<char> named;            ///< whether the row has a unit
  std::vector<const double*> values;  ///< NaN where there is none
};

/// A query that goes on, in the order of the table's rows where it asks for no other.
class ColumnScan {
 public:
  virtual ~ColumnScan() = default;
  /// False behind the last row.
  virtual bool next(ColumnChunk& chunk) = 0;
};

/// What an engine within the program can do besides: give columns as they are, and take rows.
class ColumnEngine {
 public:
  virtual ~ColumnEngine() = default;
  /// Rows of the table of cycles; 0 where they are not known without reading it.
  virtual long long known_rows() = 0;
  /// MB that all may take.
  virtual long memory() const = 0;
  /// The first column is `unit`, all others are doubles.
  virtual std::unique_ptr<ColumnScan> scan(const std::string& query) = 0;

  /// A whole number of 128 bits.
  __extension__ typedef __int128 Whole;
  struct WholeRow {
    std::string_view word;
    const std::vector<std::int64_t>& small;
    const std::vector<Whole>& large;
  };
  /// Into a temporary table of one text, then numbers of 64 and of 128 bits.
  class Appender {
   public:
    virtual ~Appender() = default;
    virtual void add(const WholeRow& row) = 0;
    virtual void finish() = 0;
  };
  virtual std::unique_ptr<Appender> append(const std::string& table) = 0;
};

}  // namespace wearwell::fleet
