#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace wearwell {

/// Reads columns of numbers in batches, in the order of the file, so that a file larger than memory
/// passes through: CSV, Parquet, JSON, whatever DuckDB reads.
class ColumnStream {
 public:
  /// Throws InputError: no such file, unreadable, empty.
  explicit ColumnStream(const std::filesystem::path& file);
  ~ColumnStream();
  ColumnStream(const ColumnStream&) = delete;
  ColumnStream& operator=(const ColumnStream&) = delete;

  const std::string& source() const;
  /// All there are.
  const std::vector<std::string>& headings() const;

  /// Chooses columns, in this order, before the first batch. Throws InputError for a column that
  /// does not hold numbers.
  void select(const std::vector<std::string>& columns);

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
