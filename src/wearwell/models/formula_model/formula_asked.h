#pragma once

#include "wearwell/models/formula_model/formula_conditions.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::formula_model {

/// The parts of [predict] that all requests share.
struct Asked {
  const TomlReader& predict;
  std::shared_ptr<const FormulaModel> model;
  std::shared_ptr<const FormulaRows> rows;
  Conditions given, common;   ///< predict.given; with values that are the same in all rows
  std::string noun;           ///< "machine"
  std::vector<double> start;  ///< parameters at the start of searches

  Asked(const TomlReader& table, std::shared_ptr<const FormulaModel> formula_model,
        std::shared_ptr<const FormulaRows> own_rows);

  const NumberColumn& axis() const { return *model->data.number(*model->along); }
  /// "machine 5"; the noun alone in a study without units.
  std::string unit(std::size_t u) const;
  /// Position of the last row of a unit on the axis, SI.
  double last_place(std::size_t u) const;
};

/// "50 km"; "a, b", either of which may be empty.
std::string description(const Quantity& quantity);
std::string joined(const std::string& a, const std::string& b);

/// A request whose values a group computes.
QuantityRequest request(const std::string& name, const std::string& of, const std::string& at,
                        const Unit& unit);

}  // namespace wearwell::formula_model
