#pragma once

#include <filesystem>
#include <string>

namespace wearwell {

enum class TableFormat { text, json, parquet, workbook };

/// A table file, opened once: what is read is this file, whatever else its name could mean.
class TableFile {
 public:
  /// Throws InputError: no such file, a folder, no regular file, unreadable, empty, an ending that
  /// does not say what it holds, a .gz that is cut off or damaged.
  explicit TableFile(const std::filesystem::path& file);
  /// A text in memory; closes the descriptor.
  TableFile(int descriptor, std::string source)
      : source_(std::move(source)), descriptor_(descriptor) {}
  ~TableFile();
  TableFile(const TableFile&) = delete;
  TableFile& operator=(const TableFile&) = delete;

  const std::string& source() const { return source_; }  ///< the name, for messages
  TableFormat format() const { return format_; }
  bool gzip() const { return gzip_; }
  int descriptor() const { return descriptor_; }
  /// A path without patterns or folders that mean something: "/proc/self/fd/7".
  std::string path() const;

 private:
  std::string source_;
  TableFormat format_ = TableFormat::text;
  bool gzip_ = false;
  int descriptor_ = -1;
};

}  // namespace wearwell
