#pragma once

#include <span>
#include <string>
#include <vector>

#include "wearwell/input/source.h"
#include "wearwell/input/table.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// A column of numbers and its unit.
struct NumberColumn {
  const Column* column = nullptr;
  Unit unit;
};

/// The column of this name, with its unit in the heading ("wear [um]", "wear_um") or in a row of
/// units. Throws InputError if there is none or two, or its unit is missing or wrong.
NumberColumn number_column(const Table& table, const ReadingColumn& wanted);

/// The name of a unit in a cell.
std::string unit_name(const Column& units, std::size_t row);

/// The rows of a table as readings: the columns of the tracker by the study's names, and its
/// labels. The table must outlive it.
class ReadingTable {
 public:
  /// Throws InputError that names the missing column, or the unit that is wrong.
  ReadingTable(const Tracker& tracker, const Table& table);

  /// Throws InputError that names row and column of a cell that is not a number.
  Reading reading(std::size_t row) const;

 private:
  const Table& table_;
  std::vector<NumberColumn> numbers_;
  std::vector<const Column*> labels_;
};

/// The reading of each row, in the order of the rows. A column of units, named by the tracker's noun,
/// may only name this unit. Throws InputError that names the row of a reading that is invalid for
/// every unit.
std::vector<Reading> readings_of_unit(const Tracker& tracker, const std::string& unit,
                                      const Table& table);

/// A table whose columns have the headings of a study's data, with the study's names in place of
/// them; columns of numbers that state no unit have that of the study. `source`: the study with its
/// data; `columns`: those of numbers. For callers who hold such a table in memory; in files a missing
/// unit is refused.
Table in_study_names(const Table& table, std::span<const ReadingColumn> columns,
                     const Source& source);

}  // namespace wearwell::prognosis
