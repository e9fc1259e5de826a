#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/models/formula_model/node_program.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::formula_model {

/// A row of one unit, as input of the likelihood.
struct UnitReading {
  NodeRow row;
  double place = 0;                                ///< along the axis, SI; 0 if there is none
  std::vector<std::optional<Response>> responses;  ///< by measured column
  int count = 1;
};

/// Makes rows of arriving readings.
class ReadingReader {
 public:
  explicit ReadingReader(std::shared_ptr<const FormulaModel> model);

  std::span<const prognosis::ReadingColumn> columns() const { return columns_; }
  /// The study's labels except the units' label.
  std::span<const std::string> labels() const { return labels_; }

  /// Fills `reading`, or returns why it is invalid: "force is missing".
  std::string read(const prognosis::Reading& from, UnitReading& reading) const;
  /// The rows of a unit of the study.
  std::vector<UnitReading> of_study(std::size_t unit) const;
  /// A reading in the study's order of columns, for messages and for storage.
  const FormulaModel& model() const { return *model_; }

 private:
  std::string read_special(const prognosis::Reading& from, UnitReading& reading) const;
  FormulaData one_row(const prognosis::Reading& from) const;
  int level_of(const LabelColumn& label, const std::string& text) const;

  std::shared_ptr<const FormulaModel> model_;
  std::vector<prognosis::ReadingColumn> columns_;
  std::vector<std::string> labels_;
  std::vector<std::size_t> label_of_;        // of each of `labels_`, among the data's
  std::vector<bool> needed_, needed_label_;  // by any measured column, as the symbols of rows
  std::vector<std::size_t> measured_;        // the number of each measured column
  bool special_ = false;                     // censored, truncated, counted, or of trials
};

/// Along the axis; at the same position by values, so that the order of arrival does not matter.
void sort_along(std::vector<UnitReading>& readings);

/// The same model with one unit that has these rows, so that the integration over effects of a
/// study's units applies to this one.
std::shared_ptr<const FormulaModel> model_of_unit(const FormulaModel& model,
                                                  const std::vector<UnitReading>& readings);

}  // namespace wearwell::formula_model
