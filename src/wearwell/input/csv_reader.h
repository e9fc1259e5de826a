#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace wearwell {

/// Reads a CSV file row by row: a heading, then rows with as many cells; quotes follow RFC 4180;
/// lines that begin with '#' are comments. Errors throw InputError with file, row (from 1, below
/// the heading) and column.
class CsvReader {
 public:
  /// `row` and `cells` are their names in messages.
  explicit CsvReader(const std::filesystem::path& file, const char* row = "row",
                     const char* cells = "cells");

  const std::vector<std::string>& heading() const { return heading_; }
  /// The index of a column. Throws if the heading does not have it.
  std::size_t column(const std::string& name) const;

  bool next();  ///< false after the last row
  std::size_t row() const { return row_; }
  const std::string& text(std::size_t column) const { return cells_[column]; }
  double number(std::size_t column) const;  ///< accepts "inf" and "nan"
  long long integer(std::size_t column) const;
  bool flag(std::size_t column) const;  ///< 0 or 1

  [[noreturn]] void fail(std::size_t column, const std::string& expected) const;

 private:
  bool read_row(std::vector<std::string>& cells);

  std::string file_, noun_, cells_are_;
  std::ifstream stream_;
  std::string line_;
  std::vector<std::string> heading_, cells_;
  std::size_t row_ = 0;
};

/// A cell, quoted if necessary.
std::string csv_cell(const std::string& text);

/// The same for files that people read: control characters are escaped (base/printable.h).
std::string printable_csv_cell(const std::string& text);

}  // namespace wearwell
