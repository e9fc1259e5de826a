#include "wearwell/models/formula_model/formula_asked.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace wearwell::formula_model {

Asked::Asked(const TomlReader& table, std::shared_ptr<const FormulaModel> formula_model,
             std::shared_ptr<const FormulaRows> own_rows)
    : predict(table), model(std::move(formula_model)), rows(std::move(own_rows)) {
  if (const auto conditions = predict.table("given")) given = read_conditions(*conditions, *model);
  common = common_conditions(*model, given);
  noun = model->label.value_or(model->symbols.labels.size() == 1 && !model->modes &&
                                       !model->subpopulations
                                   ? model->symbols.labels.front().name
                                   : std::string("unit"));
  for (const Parameter& each : model->parameters) start.push_back(each.start);
}

std::string Asked::unit(std::size_t u) const {
  return model->units[u].empty() ? noun : noun + " " + model->units[u];
}

double Asked::last_place(std::size_t u) const {
  double last = -std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < model->data.table.rows; ++row) {
    if (model->unit_of_row[row] == u) last = std::max(last, axis().values[row]);
  }
  return last;
}

std::string description(const Quantity& quantity) {
  return quantity.unit.text == "1" ? fmt::format("{:.6g}", quantity.value)
                                   : fmt::format("{:.6g} {}", quantity.value, quantity.unit.text);
}

std::string joined(const std::string& a, const std::string& b) {
  return a.empty() ? b : b.empty() ? a : a + ", " + b;
}

QuantityRequest request(const std::string& name, const std::string& of, const std::string& at,
                        const Unit& unit) {
  return {name, of, at, unit, true, false, {}, {}, {}};
}

}  // namespace wearwell::formula_model
