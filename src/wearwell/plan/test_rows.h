#pragma once

#include <span>
#include <string>
#include <vector>

#include "wearwell/plan/test_study.h"

namespace wearwell::plan {

/// Cells of a finished test: its value, in the unit of the table, or a run-out at that value.
struct TestOutcome {
  double value = 0;
  bool runout = false;
};

/// Rows of the study's table for tests with these outcomes: test i has the conditions of row
/// `rows[i]` of `conditions`, a table with at least the headings of `study.conditions` in the units
/// of the study's table (candidates.h). Labels whose effects vary are as in the conditions, or new
/// ones where these are empty: "PREFIX 1", "PREFIX 2", ...; columns that the study does not use are
/// empty.
Table rows_with_outcomes(const TestStudy& study, const Table& conditions,
                         std::span<const std::size_t> rows, std::span<const TestOutcome> outcomes,
                         const std::string& prefix);

/// Tests of units that the study has, as rows of new units that begin with a copy of the unit's own
/// rows. So each test has its own factors of the likelihood, whatever the others show, and the
/// density of its outcome is their product over that of the copy alone.
struct Histories {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  Table rows;                       ///< a unit for each test, then one for each of `units`
  std::vector<std::size_t> unit;    ///< of each test: index into `units`, or `none` for a new unit
  std::vector<std::string> units;   ///< that the study has
  std::vector<std::size_t> blocks;  ///< numbers of rows of the units of `rows`

  std::size_t index_of(const std::string& name);  ///< adds it to `units` if it is not there
};

/// Of `rows_with_outcomes`. Levels of other labels that the study does not have become one level:
/// given the effects of that level the tests are independent.
Histories with_histories(const TestStudy& study, const Table& rows);

/// The study's source with these rows after its own; messages name the rows of `rows.source`.
Source with_rows(const TestStudy& study, const Table& rows);

}  // namespace wearwell::plan
