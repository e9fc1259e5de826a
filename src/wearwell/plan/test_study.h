#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/contains.h"
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
  bool varies = false;  ///< has random effects: a test is at a level of the data, or at a new one

  bool is_new(const std::string& label) const { return !contains(labels, label); }
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
  bool counted = false;              ///< it is a count: a whole number
  std::string trials = {};           ///< heading of the numbers of trials of a binomial count
  std::optional<LifeStatus> status =
      {};                 ///< the column of outcomes; without one a run-out is a limit, ">1e6"
  std::string unit = {};  ///< heading of the label of units, whose rows may depend on each other
  std::vector<std::string> new_units = {};  ///< headings of labels of which each test is a new one
  std::vector<std::string> names = {};      ///< headings of labels that the likelihood does not use
  std::vector<std::string> ones = {};       ///< headings of counts of equal tests
  std::string factor_noun = "row";          ///< what one factor of the likelihood is of
  std::shared_ptr<const LogDensity> own = {};  ///< the likelihood of the study's own rows
  std::vector<std::string> parameters = {};    ///< names, in the order of the posterior's nodes
  double typical = 1, spread = 1;  ///< of the measured column: median; half of its range

  const Table& table() const { return source.tables.at(key); }
  /// The condition with this heading, or null.
  const ConditionColumn* condition(const std::string& heading) const;
};

/// `measure` is the study's name of the measured column where there are several; else empty. The
/// table is read if the source does not hold it. Throws InputError for a study whose tests are not
/// rows of one table with one measured value.
TestStudy test_study(const Source& source, const ReadStudy& read, const std::string& measure = "");

}  // namespace wearwell::plan
