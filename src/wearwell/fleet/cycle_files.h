#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wearwell/input/table_file.h"

namespace wearwell::fleet {

/// The files of a fleet's cycles as one relation of DuckDB.
struct CycleFiles {
  bool csv = false;
  char delimiter = ',', decimal = '.';
  bool all_text = false;             ///< every column of CSV is read as text
  std::size_t headings = 0;          ///< of the first file, if `all_text`
  std::vector<std::string> names;    ///< as given, absolute
  std::vector<std::string> paths;    ///< that DuckDB reads, beside `names`
  std::string layout;                ///< "semicolons, decimal comma"; empty for standard CSV
  std::vector<std::string> numbers;  ///< columns of numbers, if DuckDB is not to detect them
  /// Files in memory: standard CSV of those that DuckDB cannot read as they are.
  std::vector<std::unique_ptr<TableFile>> rewritten;
};

/// Finds the layout of CSV files as everywhere in the program (input/text_layout.h): separator,
/// decimal mark, encoding, heading. DuckDB reads points or commas and any separator; files of any
/// other layout are rewritten in memory, if they are smaller than `most_bytes`. With `skip_bad`,
/// columns are text, lines may be too short, and other layouts are refused. Throws InputError.
CycleFiles cycle_files(const std::vector<std::string>& files, const std::string& source,
                       bool skip_bad, double most_bytes);

/// Throws InputError that names file and line, if a line of one is not as its heading.
void refuse_invalid_lines(const CycleFiles& files);

/// "read_csv([...], ...)" with the column `unit` as text, unless it is empty.
std::string reader_of(const CycleFiles& files, const std::string& unit);

/// Throws InputError for "s3://bucket/..." and the like: DuckDB's part for object stores is not in
/// the program.
void refuse_remote(const std::string& file);

}  // namespace wearwell::fleet
