#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "wearwell/input/table.h"
#include "wearwell/input/text_file.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell {

/// A study and where its data are: files beside it, or tables in memory.
struct Source {
  TextFile study;  ///< the path is the name in messages, and files are looked for beside it
  /// By the name that the study gives its data: these come before files.
  std::map<std::string, Table> tables = {};

  std::filesystem::path folder() const { return study.path.parent_path(); }
};

/// A study file on the disk. Throws InputError when there is none or it cannot be read.
Source source_of(const std::filesystem::path& file);

/// The table that `section` names as its `file`: in memory, or beside the study, through its `sql` if
/// it has one. Throws InputError at these keys, and as read_table does.
Table read_table(const TomlReader& section, const Source& source);

/// How a table is written, as far as `section` says: its keys decimal, thousands, delimiter, encoding,
/// header_row, units_row, summary_rows, hidden_rows, comment, sheet and range. Throws InputError at these keys.
TableSettings read_table_settings(const TomlReader& section);

/// A file beside the study that must be there. Throws InputError at the key that names it.
std::filesystem::path required_file(const TomlReader& section, const std::string& key,
                                    const std::filesystem::path& folder);

}  // namespace wearwell
