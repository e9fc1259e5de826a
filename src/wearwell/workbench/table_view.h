#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/workbench/session.h"

namespace wearwell::workbench {

/// Reads a table of the folder; a wide one through its SELECT, as `wearwell new --from` does.
/// Throws InputError, SeveralSheets for a workbook without the key `sheet`.
OpenTable open_table(const std::filesystem::path& folder, const std::string& file,
                     const std::map<std::string, std::string>& settings);

/// {file, rows, layout, remarks, settings, wide, headings, columns: [{name, unit, kind, empty,
/// refused, least, largest}], roles, names}. `names`: the roles whose cells are read as names, also digits. `headings`: of a wide table before its SELECT; chosen roles name them. `kind`: "number", or "text"; text in which most cells are numbers has `refused`, the
/// number of the others; at most 1000 are counted, and then there is no least and largest.
nlohmann::ordered_json table_json(const OpenTable& open);

/// `OpenTable::shown` with the number of the table.
nlohmann::ordered_json shown_table(const OpenTable& open);

/// {from, rows: [{row, line, cells, refused: {COLUMN: message}}]} of `count` rows and `columns`
/// columns; a missing number is null, an infinite one "inf" or "-inf".
nlohmann::ordered_json rows_json(const OpenTable& open, std::size_t from, std::size_t count,
                                 std::size_t from_column, std::size_t columns);

/// An axis of a plot: a column by its index, or the number of the row.
struct PlotAxis {
  std::optional<std::size_t> column = {};
  bool log = false;
};

/// {points: [[x, y, row, label]], labels: [{text, runout}], rows, shown, left_out: {empty,
/// not_positive}}: of many points of one label in one place only the first is kept (a grid of 160 by
/// 90), so that 10^6 rows stay a picture. `by`: the column of the labels, if any; the eight most
/// frequent, and an index behind them for all others. `runout`: whether the word means that the test
/// ended without a failure.
nlohmann::ordered_json plot_json(const OpenTable& open, const PlotAxis& x, const PlotAxis& y,
                                 std::optional<std::size_t> by = {});

}  // namespace wearwell::workbench
