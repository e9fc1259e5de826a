#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/models/formula_model/formula_data.h"
#include "wearwell/models/formula_model/returns_triangle.h"
#include "wearwell/prob/reporting_delay.h"

namespace wearwell::formula_model {

/// A returns triangle with what turns its periods into ages: data.returns of a study
/// (docs/reference/warranty.md). Ages and delays in periods.
struct FieldReturns {
  ReturnsTriangle triangle;
  Unit period;         ///< "month"
  double start = 0.5;  ///< when in its period of sale a unit starts, 0 to 1
  bool whole = false;  ///< a return k periods after the sale is exactly of age k
  double delay = 0;    ///< from sale to start of use, and from failure to report, if both are fixed
  /// The delays if one of them varies, SI: then the ages below are ages at the report.
  std::optional<ReportingDelay> reporting = {};
  std::vector<std::string> delay_words = {};  ///< of those that vary
  double warranty =
      std::numeric_limits<double>::infinity();  ///< in use; later failures are not claimed
  int held_out = 0;                             ///< last periods that are not fitted

  int last() const { return triangle.last - held_out; }  ///< period that ends the fitted data
  /// Age of a unit at the end of period `after` its sale, of failures that are reported by then; from
  /// 0 to the end of the warranty. If delays vary, its age at the report, from the sale on.
  double age(int after) const;
  /// The greatest age in use of failures that are reported by then.
  double age_in_use(int after) const;
  double least_delay() const;
  /// Whether failures within the warranty can be reported in period `after` the sale.
  bool claimed(int after) const;
};

/// Reads data.returns and its table, with the words of [failure_modes]. Throws InputError.
std::shared_ptr<const FieldReturns> read_field_returns(const TomlReader& root,
                                                       const Source& source);

/// The failure modes that the table names without a return in the fitted periods.
std::vector<std::string> modes_without_returns(const FieldReturns& returns);
/// "in the fitted months (until 2024-12)".
std::string fitted_periods(const FieldReturns& returns);

/// The name of the column of failure modes in a study of returns, `[failure_modes] column`.
inline constexpr const char* mode_of_returns = "mode";

/// The lives that the fitted periods tell, as a table of intervals: columns `lower` and `upper` (in
/// periods; no lower end: a failure before the first look, no upper end: a survivor) and `count`. A
/// cell of the triangle is a row of failures (one for each failure mode), and the units of a period
/// of sale that did not come back a row of survivors. The column of failure modes is the last one,
/// with the heading and the rows of the file. Throws InputError that names the period of sale: a
/// return before the end of the delays.
FormulaData lives_of_returns(const FieldReturns& returns);

/// What a reader should know of the data, as sentences.
std::vector<std::string> notes_of_returns(const FieldReturns& returns);

}  // namespace wearwell::formula_model
