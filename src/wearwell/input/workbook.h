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
  /// Why the numbers of a column cannot be read, by column index.
  std::map<std::size_t, std::string> doubts = {};
  std::vector<std::string> notes =
      {};  ///< remarks: "merged cells A2:A4 read in each of their rows"
};

/// A workbook with several non-empty sheets, none of which is named.
struct SeveralSheets : InputError {
  SeveralSheets(const std::string& message, std::vector<std::string> sheets)
      : InputError(message), names(std::move(sheets)) {}
  std::vector<std::string> names;
};

/// One sheet of an .xlsx as a CSV in memory; line n is row n of the sheet. The sheet is named by
/// `settings`, or is the only non-empty one; the range is that of `settings`, or all. Formulas
/// become their saved values, dates have the form 2024-03-01, numbers in text cells get a decimal
/// point (sheet_numbers.h), and a cell merged over several rows is repeated in each. Throws
/// InputError: damaged, too large, no such sheet or range, several sheets and none named
/// (SeveralSheets), a formula without its value.
SheetText sheet_text(const TableFile& book, const TableSettings& settings);

}  // namespace wearwell
