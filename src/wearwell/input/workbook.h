#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/input/table_file.h"
#include "wearwell/input/table_settings.h"

namespace wearwell {

/// A sheet of an .xlsx as a text.
struct SheetText {
  std::unique_ptr<TableFile> text;
  std::string name;
  /// Why the numbers of a column cannot be read, by its place from 0.
  std::map<std::size_t, std::string> doubts = {};
  std::vector<std::string> notes =
      {};  ///< what was seen: "merged cells A2:A4 read in each of their rows"
};

/// A workbook of which several sheets hold something, and none was named.
struct SeveralSheets : InputError {
  SeveralSheets(const std::string& message, std::vector<std::string> sheets)
      : InputError(message), names(std::move(sheets)) {}
  std::vector<std::string> names;
};

/// One sheet of an .xlsx as a CSV in memory, whose line n is row n of the sheet: the sheet that `settings`
/// name, or else the only one that holds anything; of it the range that they name, or else all. Formulas are
/// the values that were saved with them, dates are written 2024-03-01, numbers in cells of text have a decimal point
/// (sheet_numbers.h), and a cell merged over several rows stands in each of them. Throws InputError: damaged, too
/// large, no such sheet or range, several sheets and none named (SeveralSheets), a formula without its value.
SheetText sheet_text(const TableFile& book, const TableSettings& settings);

}  // namespace wearwell
