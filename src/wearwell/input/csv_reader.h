#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace wearwell {

/// Row by row through a CSV file: a heading, then rows of as many cells; quotes as RFC 4180 has
/// them; lines that begin with '#' are comments. What is wrong throws InputError with file, row (from
/// 1, below the heading) and column.
class CsvReader {
 public:
  /// `row` and `cells`: what messages call them.
  explicit CsvReader(const std::filesystem::path& file, const char* row = "row",
                     const char* cells = "cells");

  const std::vector<std::string>& heading() const { return heading_; }
  /// Throws unless the heading has this column.
  std::size_t column(const std::string& name) const;

  bool next();  ///< false after the last row
  std::size_t row() const { return row_; }
  const std::string& text(std::size_t column) const { return cells_[column]; }
  double number(std::size_t column) const;  ///< "inf" and "nan" are numbers too
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

/// A cell, in quotes where it needs them.
std::string csv_cell(const std::string& text);

/// The same of a file that people get: nothing in it commands a terminal (base/printable.h).
std::string printable_csv_cell(const std::string& text);

}  // namespace wearwell
