#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace wearwell {

enum class TableFormat { csv, json, parquet };

/// A table file, opened once: what is read is this file, whatever else its name could mean.
class TableFile {
 public:
  /// Throws InputError: no such file, a folder, no regular file, unreadable, empty, an ending that
  /// does not say what it holds, a .gz that is cut off or damaged.
  explicit TableFile(const std::filesystem::path& file);
  ~TableFile();
  TableFile(const TableFile&) = delete;
  TableFile& operator=(const TableFile&) = delete;

  const std::string& source() const { return source_; }  ///< the name, for messages
  TableFormat format() const { return format_; }
  bool gzip() const { return gzip_; }
  /// A path without patterns or folders that mean something: "/proc/self/fd/7".
  std::string path() const;

 private:
  std::string source_;
  TableFormat format_ = TableFormat::csv;
  bool gzip_ = false;
  int descriptor_ = -1;
};

/// What separates the columns of a CSV, and what the first line calls them.
struct CsvHeading {
  char delimiter = ',';
  std::vector<std::string> names;
};

/// Throws InputError: not UTF-8, no heading, two columns of one name, or columns that can be
/// separated in two ways.
CsvHeading read_csv_heading(const TableFile& file);

/// What is wrong with the first line that cannot be read ("line 3: 2 values where the heading has
/// 4: '1,2'"); empty when every line is sound.
std::string csv_fault(const TableFile& file, const CsvHeading& heading);

}  // namespace wearwell
