#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "wearwell/input/table.h"

namespace wearwell {

/// Reads number columns in batches, in the order of the file, so that the file can be larger than
/// memory: CSV, Parquet, JSON, and other formats of DuckDB.
class ColumnStream {
 public:
  /// Throws InputError: no such file, unreadable, empty.
  explicit ColumnStream(const std::filesystem::path& file, const TableSettings& settings = {});
  ~ColumnStream();
  ColumnStream(const ColumnStream&) = delete;
  ColumnStream& operator=(const ColumnStream&) = delete;

  const std::string& source() const;
  /// All columns.
  const std::vector<std::string>& headings() const;
  /// The columns without rows: headings, and units from a units row.
  Table columns() const;

  /// Chooses columns, in this order, before the first batch. The column `named`, if given, may hold
  /// words; they are read as indices into `words()`, from 1, which begins with `known`. Throws
  /// InputError for any other column that does not hold numbers.
  void select(const std::vector<std::string>& columns, const std::string& named = "",
              std::vector<std::string> known = {});
  bool has_words() const;                         ///< whether the column `named` holds words
  const std::vector<std::string>& words() const;  ///< of the batches so far

  struct Batch {
    std::size_t first_row = 0;  ///< 0-based, of the file
    std::size_t rows = 0;
    std::vector<std::vector<double>> columns;  ///< NaN for missing values; storage is reused
  };
  /// The next rows; false at the end. Throws InputError if a row cannot be read.
  bool next(Batch& batch);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wearwell
