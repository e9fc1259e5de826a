#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/source.h"
#include "wearwell/input/table.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/study/units_check.h"

namespace wearwell::recurrence {

/// One repairable unit: its failures between the ages at which its observation began and ended. Ages in SI.
struct UnitHistory {
  std::string name;
  double start = 0, end = 0;
  std::vector<double> failures = {};  ///< ascending
  bool ends_at_failure = false;       ///< failure truncated: the last failure ended the observation
  bool grouped = false;  ///< failures stand at the ends of the intervals that they fell into
  std::vector<std::string> modes = {};  ///< of the failures, in a table with failure modes
};

/// From one event of a unit, or from the start of its observation, to the next event: one row of the table. Ages in SI.
struct Gap {
  std::size_t unit = 0;
  double from = 0, to = 0;
  bool failed = false;  ///< else the end of observation
  bool first = false;   ///< it begins at the start of the observation
  /// Of grouped data: the number of failures within it, at unknown ages; `failed` is not used.
  std::optional<std::size_t> count = {};
};

struct RecurrenceData {
  std::vector<UnitHistory> units;
  std::vector<Gap> gaps;  ///< in the order of the rows
  std::string si;         ///< SI unit of ages: "s", "m", "cycle"
  Unit unit;              ///< unit of ages in the table
  double rounding = 0;    ///< step to which ages are rounded [SI]; 0: not stated
  std::vector<DataColumn> columns = {};
  TableLayout layout = {};

  std::size_t failures() const;
  double first_start() const;  ///< the least age at which observation of a unit began
  double longest() const;      ///< the largest age at the end of observation
};

/// Reads [data]: one row an event of a unit, with its age, and whether it is a failure or the end of observation. Throws
/// InputError that names file, row and column: a negative age, an age below that of the row before, rows after the end, a
/// second end, a unit without an end (unless data.end = "last failure"), two failures at one age (unless data.rounding is
/// stated), a failure at age 0, a failure without its mode where a column has modes. With data.grouped a row counts the
/// failures since the row before of its unit, which is observed until its last row.
RecurrenceData read_recurrence_data(const TomlReader& root, const Source& source);

}  // namespace wearwell::recurrence
