#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/formula/dimension.h"
#include "wearwell/input/life_status.h"
#include "wearwell/input/source.h"
#include "wearwell/input/table.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/prob/reporting_delay.h"
#include "wearwell/prob/response.h"

namespace wearwell::formula_model {

/// A numeric column by its name in the study.
struct NumberColumn {
  std::string name;    ///< in expressions: "force"
  std::string column;  ///< in the file: "F"
  formula::AnyUnit unit;
  std::vector<double> values;        ///< SI; NaN for an empty cell; for "<0.5" the limit
  std::vector<Censoring> seen = {};  ///< of each row, if any cell is a limit
};

/// A column of labels.
struct LabelColumn {
  std::string name, column;
  std::vector<std::string> levels;  ///< in the order of their first occurrence
  std::vector<int> at;              ///< per row, index into `levels`
};

/// The columns that the study names under [data.columns], row by row.
struct FormulaData {
  Table table;
  std::vector<NumberColumn> numbers;
  std::vector<LabelColumn> labels;
  std::optional<LifeStatus> status;
  /// Of a returns triangle whose delays vary: its lives are ages at the report.
  std::optional<ReportingDelay> reporting = {};

  const NumberColumn* number(const std::string& name) const;
  const LabelColumn* label(const std::string& name) const;
  /// Throws InputError that names file, row and column if a cell is empty or a limit.
  void require_complete(const NumberColumn& column) const;
  /// The same for limits only.
  void require_values(const NumberColumn& column) const;
};

/// Reads [data.columns]. Text columns are labels, and so are numeric columns that the study uses as
/// such: `label_names`. The column of failure modes is read elsewhere (failure_modes.h). Throws InputError.
FormulaData read_own_data(const TomlReader& root, const Source& source,
                          const std::vector<std::string>& label_names);

/// Names under [data.columns] that qualify an observation.
struct SpecialColumns {
  std::optional<std::string> status, lower, upper, entry, count;
};
/// Those that exist.
SpecialColumns special_columns(const FormulaData& data);

/// The observations of one measured column, from the rows that have one.
struct Observed {
  std::vector<std::size_t> rows;  ///< of the table
  std::vector<Response> responses;
  std::vector<int> counts;
  std::size_t failures = 0;  ///< exact, or known to have ended
};

/// `trials` is the name of the column with the number of trials, for the binomial family. If
/// `may_lack`, an empty cell is a row without this observation. If `dead_on_arrival`, a life of 0 is a part
/// that was dead on arrival. Throws InputError.
Observed read_observed(const FormulaData& data, const std::string& name, const ResponseForm& form,
                       const SpecialColumns& special, const std::optional<std::string>& trials,
                       bool may_lack, bool dead_on_arrival = false);

}  // namespace wearwell::formula_model
