#include "wearwell/input/source.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell {

Source source_of(const std::filesystem::path& file) {
  return {read_text_file(file)};
}

std::filesystem::path required_file(const TomlReader& section, const std::string& key,
                                    const std::filesystem::path& folder) {
  const std::string name = section.required_text(key);
  if (name.empty() || name.find('\0') != name.npos) section.fail(key, "names no file");
  std::filesystem::path file = folder / name;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    section.fail(key, fmt::format("no such file: {}", valid_utf8(file.string())));
  return file;
}

Table read_table(const TomlReader& section, const Source& source) {
  const auto in_memory = source.tables.find(section.required_text("file"));
  const auto sql = section.text("sql");
  if (in_memory != source.tables.end()) {
    if (sql) section.fail("sql", "cannot be asked of a table in memory: hand over its result");
    return in_memory->second;
  }
  const std::filesystem::path file = required_file(section, "file", source.folder());
  try {
    return read_table(file, sql);
  } catch (const QueryError& error) {
    section.fail("sql", error.what());
  }
}

}  // namespace wearwell
