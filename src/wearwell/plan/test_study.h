#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/bayes/log_density.h"
#include "wearwell/input/life_status.h"
#include "wearwell/input/source.h"
#include "wearwell/prognosis/data_roles.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::plan {

/// Reads a study; `read_study` with the models of the program.
using ReadStudy = std::function<std::unique_ptr<const Study>(const Source& source)>;

/// A column of the study's table that a test fixes before it starts: a stress, a temperature, the
/// unit that is measured.
struct ConditionColumn {
  std::string name;          ///< in the study: "alternating_stress"
  std::string heading;       ///< in the table: "alternating_stress_MPa"
  Unit unit;                 ///< of the table; the text is empty if it is not known (words)
  bool words = false;        ///< a label
  double low = 0, high = 0;  ///< tested range, in the unit of the table
  std::vector<std::string> labels = {};  ///< of words: those in the data
};

/// A study to which rows of tests not yet done are added. Values are in the units of its table.
struct TestStudy {
  Source source;  ///< of an S-N study without [predict], which does not change the likelihood
  ReadStudy read;
  std::string key = {};  ///< of the table in `source.tables`
  prognosis::DataRoles roles = {};
  std::vector<ConditionColumn> conditions = {};
  std::string measured = {};  ///< heading of the column that a test measures; empty for a staircase
  std::string measured_name = {};    ///< in the study: "life"
  Unit measured_unit = {"1", 1, 0};  ///< of that column
  std::string measured_si = "1";     ///< its dimension
  bool is_life = false;              ///< the measured column is a life: tests can be stopped
  bool positive = false;             ///< its distribution has positive values only
  std::optional<LifeStatus> status =
      {};  ///< the column of outcomes; without one a run-out is a limit, ">1e6"
  std::vector<std::string> new_units =
      {};  ///< headings of labels whose units vary; each test is of a new one
  std::vector<std::string> names = {};  ///< headings of labels that the likelihood does not use
  std::vector<std::string> ones = {};   ///< headings of counts of equal tests
  std::string factor_noun = "row";      ///< what one factor of the likelihood is of
  std::shared_ptr<const LogDensity> own = {};  ///< the likelihood of the study's own rows
  double typical = 1, spread = 1;  ///< of the measured column: median; half of its range

  const Table& table() const { return source.tables.at(key); }
};

/// `measure` is the study's name of the measured column where there are several; else empty. The
/// table is read if the source does not hold it. Throws InputError for a study whose tests are not
/// rows of one table with one measured value.
TestStudy test_study(const Source& source, const ReadStudy& read, const std::string& measure = "");

/// Cells of a finished test: its value, in the unit of the table, or a run-out at that value.
struct TestOutcome {
  double value = 0;
  bool runout = false;
};

/// Rows of the study's table for tests with these outcomes: test i has the conditions of row
/// `rows[i]` of `conditions`, a table with at least the headings of `study.conditions` in the units
/// of the study's table (candidates.h). Units that vary are new ones, "PREFIX 1", "PREFIX 2", ...;
/// columns that the study does not use are empty.
Table rows_with_outcomes(const TestStudy& study, const Table& conditions,
                         std::span<const std::size_t> rows, std::span<const TestOutcome> outcomes,
                         const std::string& prefix);

/// The study's source with these rows after its own; messages name the rows of `rows.source`.
Source with_rows(const TestStudy& study, const Table& rows);

}  // namespace wearwell::plan
