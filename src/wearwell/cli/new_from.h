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

/// What `wearwell new` is asked.
struct NewOptions {
  std::string preset;
  std::filesystem::path folder, from;
  std::vector<std::string> columns;
  std::optional<int> failure;
  std::string limit;
  std::map<std::string, std::string> table;  ///< of [data]: how the file holds the table
  std::optional<WideTable> wide = {};        ///< found in the table: read by its SELECT
};

/// The model of that trade. Throws InputError that names all trades.
const Model& model_of(Models models, const std::string& preset);

/// Keys of [data] that are options while there is no study.
inline constexpr std::pair<const char*, const char*> table_keys[] = {
    {"sheet", "Sheet of a workbook: its name or number"},
    {"range", "Part of a sheet: B4:G22"},
    {"header_row", "Line of the headings, from 1"},
    {"units_row", "Whether units stand below the headings: below or none"},
    {"decimal", "Decimal mark: . or ,"},
    {"thousands", "Mark for thousands, or none"},
    {"delimiter", "What separates the columns"},
    {"encoding", "utf-8, utf-16 or cp1252"},
    {"summary_rows", "Rows below the data that are computed: last or none"},
    {"hidden_rows", "Hidden rows of a sheet: read or skip"},
    {"comment", "With what lines begin that are left out"}};

/// "--header-row" of "header_row".
std::string option_of(const std::string& key);

/// `wearwell new --from`: reads the table, asks what it leaves open, writes the study and prints what was read; or prints
/// the command of a selection. Returns the exit code: 1 where the study needs a hand before it runs, 2 where nobody is
/// there to be asked. Throws InputError.
int run_from(NewOptions options, Models models);

}  // namespace wearwell
