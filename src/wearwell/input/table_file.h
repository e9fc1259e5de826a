#pragma once

#include <filesystem>
#include <string>

namespace wearwell {

enum class TableFormat { text, json, parquet, workbook };

/// A table file, opened once, so that later changes of the name do not matter.
class TableFile {
 public:
  /// Throws InputError: missing file, a folder, not a regular file, unreadable, empty, unknown
  /// extension, a truncated or damaged .gz.
  explicit TableFile(const std::filesystem::path& file);
  /// A text in memory; closes the descriptor.
  TableFile(int descriptor, std::string source)
      : source_(std::move(source)), descriptor_(descriptor) {}
  ~TableFile();
  TableFile(const TableFile&) = delete;
  TableFile& operator=(const TableFile&) = delete;

  const std::string& source() const { return source_; }  ///< name in messages
  TableFormat format() const { return format_; }
  bool gzip() const { return gzip_; }
  int descriptor() const { return descriptor_; }
  /// A path without patterns or meaningful folder names: "/proc/self/fd/7".
  std::string path() const;

 private:
  std::string source_;
  TableFormat format_ = TableFormat::text;
  bool gzip_ = false;
  int descriptor_ = -1;
};

}  // namespace wearwell
