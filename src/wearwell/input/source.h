#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "wearwell/input/table.h"
#include "wearwell/input/text_file.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell {

/// A study and the source of its data: files beside it, or tables in memory.
struct Source {
  TextFile study;  ///< its path is used in messages and to find files beside it
  /// By the name of the data in the study; these take precedence over files.
  std::map<std::string, Table> tables = {};
  /// Parameters of a fit of the same study, in SI: a model starts from them and does not search.
  std::map<std::string, double> starts = {};

  std::filesystem::path folder() const { return study.path.parent_path(); }
};

/// A study file on disk. Throws InputError if it does not exist or cannot be read.
Source source_of(const std::filesystem::path& file);

/// The table that `section` names as its `file`, in memory or beside the study, after its `sql` if
/// any. Throws InputError at these keys, and like read_table.
Table read_table(const TomlReader& section, const Source& source);

/// The layout of a table according to `section`: its keys decimal, thousands, delimiter, encoding,
/// header_row, units_row, summary_rows, hidden_rows, comment, sheet and range. Throws InputError at
/// these keys.
TableSettings read_table_settings(const TomlReader& section);

/// A required file beside the study. Throws InputError at the key that names it.
std::filesystem::path required_file(const TomlReader& section, const std::string& key,
                                    const std::filesystem::path& folder);

}  // namespace wearwell
