#include "wearwell/input/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/as_read.h"

namespace wearwell {

Source source_of(const std::filesystem::path& file) {
  static const std::vector<std::string> tables = {".csv", ".tsv", ".xlsx", ".xls", ".parquet"};
  std::error_code ignored;
  if (std::filesystem::is_regular_file(file, ignored) &&
      std::find(tables.begin(), tables.end(), file.extension().string()) != tables.end()) {
    throw InputError(
        fmt::format("{} is a table, not a study; name it in a study (TOML) with data.file = \"{}\" "
                    "(wearwell new writes a first study)",
                    valid_utf8(file.string()), valid_utf8(file.filename().string())));
  }
  return {read_text_file(file)};
}

namespace {

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  constexpr std::size_t most = 1000;
  std::vector<std::string> names;
  std::error_code ignored;
  const std::filesystem::path here = folder.empty() ? "." : folder;
  for (std::filesystem::directory_iterator at(here, ignored), end; at != end && names.size() < most;
       at.increment(ignored))
    names.push_back(at->path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

std::filesystem::path required_file(const TomlReader& section, const std::string& key,
                                    const std::filesystem::path& folder) {
  const std::string name = section.required_text(key);
  if (name.empty() || name.find('\0') != name.npos) section.fail(key, "is not given");
  std::filesystem::path file = folder / name;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    const std::vector<std::string> files = files_in(file.parent_path());
    const auto near = near_name(file.filename().string(), files);
    section.fail(key,
                 fmt::format("no such file: {}{}", valid_utf8(file.string()),
                             did_you_mean(file.filename().string(), files)),
                 near ? Repair{file.filename().string(), *near} : Repair{});
  }
  if (std::filesystem::is_directory(file, ignored))
    section.fail(key, fmt::format("{} is a folder, not a file", valid_utf8(file.string())));
  return file;
}

namespace {

std::optional<char> one_sign(const TomlReader& section, const char* key,
                             const std::vector<std::string>& allowed) {
  const auto sign = section.choice(key, allowed);
  if (!sign) return {};
  if (*sign == "none") return '\0';
  return *sign == "tab" ? '\t' : sign->front();
}

}  // namespace

TableSettings read_table_settings(const TomlReader& section) {
  TableSettings settings;
  settings.decimal = one_sign(section, "decimal", {".", ","});
  settings.thousands = one_sign(section, "thousands", {".", ",", "'", " ", "none"});
  if (settings.decimal && settings.thousands == settings.decimal)
    section.fail("thousands", "is also the decimal mark");
  settings.delimiter = one_sign(section, "delimiter", {",", ";", "\t", "tab", "|"});
  if (const auto encoding = section.choice(
          "encoding", {"utf-8", "utf-16", "cp1252", "latin-1", "iso-8859-1", "windows-1252"})) {
    // Files that claim Latin-1 usually contain cp1252, which extends it.
    settings.encoding = *encoding == "utf-8"    ? Encoding::utf8
                        : *encoding == "utf-16" ? Encoding::utf16_le
                                                : Encoding::cp1252;
  }
  constexpr long long most_lines = 1'000'000;
  if (const auto row = section.integer("header_row", 1, most_lines))
    settings.header_row = static_cast<std::size_t>(*row);
  if (const auto units = section.choice("units_row", {"below", "none"}))
    settings.units_row = *units == "below";
  if (const auto rows = section.choice("summary_rows", {"last", "none"}))
    settings.summary_rows = *rows == "last";
  if (const auto rows = section.choice("hidden_rows", {"read", "skip"}))
    settings.hidden_rows = *rows == "read";
  settings.comment = section.text("comment");
  if (settings.comment && settings.comment->empty())
    section.fail("comment", "is empty; state how comment lines begin");
  if (section.has("sheet"))
    settings.sheet = section.is_text("sheet")
                         ? *section.text("sheet")
                         : fmt::format("{}", *section.integer("sheet", 1, 10'000));
  settings.range = section.text("range");
  return settings;
}

Table read_table(const TomlReader& section, const Source& source) {
  const auto as_read = source.tables.find(as_read_name(section));
  if (as_read != source.tables.end()) return as_read->second;
  const auto in_memory = source.tables.find(section.required_text("file"));
  const auto sql = section.text("sql");
  const TableSettings settings = read_table_settings(section);
  if (in_memory != source.tables.end()) {
    if (sql)
      section.fail("sql", "cannot be applied to a table in memory; pass the result of the query");
    for (const char* key :
         {"decimal", "thousands", "delimiter", "encoding", "header_row", "units_row",
          "summary_rows", "hidden_rows", "comment", "sheet", "range"}) {
      if (section.has(key)) section.fail(key, "is for tables in files");
    }
    return in_memory->second;
  }
  const std::filesystem::path file = required_file(section, "file", source.folder());
  try {
    return read_table(file, sql, {}, settings);
  } catch (const QueryError& error) {
    section.fail("sql", error.what());
  }
}

}  // namespace wearwell
