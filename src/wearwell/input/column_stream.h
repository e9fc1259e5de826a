#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "wearwell/input/table.h"

namespace wearwell {

/// Reads columns of numbers in batches, in the order of the file, so that a file larger than memory
/// passes through: CSV, Parquet, JSON, whatever DuckDB reads.
class ColumnStream {
 public:
  /// Throws InputError: no such file, unreadable, empty.
  explicit ColumnStream(const std::filesystem::path& file, const TableSettings& settings = {});
  ~ColumnStream();
  ColumnStream(const ColumnStream&) = delete;
  ColumnStream& operator=(const ColumnStream&) = delete;

  const std::string& source() const;
  /// All there are.
  const std::vector<std::string>& headings() const;
  /// The columns without their rows: headings, and units from a row of them.
  Table columns() const;

  /// Chooses columns, in this order, before the first batch. The column `named`, if there is one, may
  /// hold words, which come as their places among `words()`, from 1, beginning with `known`. Throws
  /// InputError for another column that does not hold numbers.
  void select(const std::vector<std::string>& columns, const std::string& named = "",
              std::vector<std::string> known = {});
  bool has_words() const;                         ///< whether the column `named` holds words
  const std::vector<std::string>& words() const;  ///< of the batches so far

  struct Batch {
    std::size_t first_row = 0;  ///< 0-based, of the file
    std::size_t rows = 0;
    std::vector<std::vector<double>> columns;  ///< NaN where there is no value; storage is reused
  };
  /// The next rows; false at the end. Throws InputError where a row cannot be read.
  bool next(Batch& batch);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wearwell
