#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/study/model.h"
#include "wearwell/study/wide_table.h"

namespace wearwell {

/// The options of `wearwell new`.
struct NewOptions {
  std::string preset;
  std::filesystem::path folder, from;
  std::vector<std::string> columns;
  std::optional<int> failure;
  std::string limit;
  std::map<std::string, std::string> table;  ///< of [data]: how the file stores the table
  std::optional<WideTable> wide = {};        ///< found in the table: read through its SELECT
};

/// The model of that application. Throws InputError that names all applications.
const Model& model_of(Models models, const std::string& preset);

/// Keys of [data] that are options while there is no study.
inline constexpr std::pair<const char*, const char*> table_keys[] = {
    {"sheet", "Sheet of a workbook: its name or number"},
    {"range", "Part of a sheet: B4:G22"},
    {"header_row", "Line of the headings, counted from 1"},
    {"units_row", "Line of units below the headings: below or none"},
    {"decimal", "Decimal mark: . or ,"},
    {"thousands", "Thousands separator, or none"},
    {"delimiter", "Separator of the columns"},
    {"encoding", "utf-8, utf-16 or cp1252"},
    {"summary_rows", "Computed rows below the data: last or none"},
    {"hidden_rows", "Hidden rows of a sheet: read or skip"},
    {"comment", "Start of the lines to leave out"}};

/// "--header-row" of "header_row".
std::string option_of(const std::string& key);

/// `wearwell new --from`: reads the table, asks what it leaves open, writes the study and prints
/// what was read; or prints the command of a selection. Returns the exit code: 1 where the study
/// needs corrections before it runs, 2 where a question is open and there is no terminal to ask.
/// Throws InputError.
int run_from(NewOptions options, Models models);

}  // namespace wearwell
