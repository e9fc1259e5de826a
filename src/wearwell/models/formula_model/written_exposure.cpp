#include "wearwell/models/formula_model/written_exposure.h"

#include <fmt/format.h>
#include <optional>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/exposure_parameters.h"
#include "wearwell/models/formula_model/fail_at_place.h"
#include "wearwell/models/formula_model/written_likelihood.h"

namespace wearwell::formula_model {
namespace {

// What changes between the steps of a specimen: the life itself excepted.
std::vector<ChangingStress> stresses_of_steps(const FormulaModel& model, const std::string& life) {
  std::vector<ChangingStress> all;
  const auto& symbols = model.row_symbols;
  for (std::size_t i = 0; i < symbols.columns.size(); ++i) {
    const std::string& name = symbols.columns[i].name;
    const NumberColumn* column = model.data.number(name);
    if (!column || name == life || name == model.steps->duration) continue;
    if (changes_between_steps(*model.steps, column->values, model.data))
      all.push_back({name, static_cast<int>(i)});
  }
  for (std::size_t i = 0; i < symbols.labels.size(); ++i) {
    const std::string& name = symbols.labels[i].name;
    const LabelColumn* label = model.data.label(name);
    if (!label || name == model.steps->label) continue;
    const std::vector<double> levels(label->at.begin(), label->at.end());
    if (changes_between_steps(*model.steps, levels, model.data))
      all.push_back({name, static_cast<int>(i), true});
  }
  return all;
}

}  // namespace

void read_exposure(const TomlReader& root, const WrittenStudy& study, FormulaModel& model) {
  if (!model.has_exposure()) return;
  const char* const key = model.steps ? "steps" : "ramp";
  const WrittenLikelihood& life = study.likelihoods.front();
  const TomlReader table = root.required_table("likelihood").required_table(life.column);
  for (const char* other : {"failure_modes", "random_effects", "subpopulations"})
    if (root.has(other)) table.fail(key, fmt::format("is not possible with [{}]", other));
  for (const char* share : {"share_defective", "share_dead_on_arrival"})
    if (table.has(share)) table.fail(share, fmt::format("is not possible with {}", key));
  if (study.likelihoods.size() > 1) table.fail(key, "needs one measured column, the life");
  if (special_columns(model.data).entry)
    table.fail(key, fmt::format("is not possible with data.columns.entry: a {} test begins at 0",
                                model.steps ? "step-stress" : "ramp"));
  if (const auto predict = root.table("predict"); predict && predict->has("along"))
    predict->fail("along", model.steps
                               ? "is not possible with steps, which are in the order of their ages"
                               : "is not possible with ramp");
  if (model.steps && !model.data.label(model.steps->label))
    table.fail("steps", "must name the column of the specimens under data.columns");
  if (!model.data.number(life.column)) fail_without_column(root, model.data, life);
  if (model.steps) add_durations(*model.steps, life.column, model.data);
  if (model.ramp) add_ramp(table, *model.ramp, life.column, model.data);
}

void add_ramp_exposure(const TomlReader& root, WrittenStudy& study, FormulaModel& model) {
  if (!model.ramp) return;
  WrittenLikelihood& life = study.likelihoods.front();
  const TomlReader table = table_of(root, life);
  Measured given;
  add_wanted(life, model.data.number(life.column)->unit.powers, given);
  std::size_t scale = 0;
  while (life.form->family_parameters[given.family_parameter[scale]].name != model.ramp->parameter)
    ++scale;
  try {
    life.family_parameters.back().second =
        threshold_of(table, *model.ramp, model.lines, given.wanted, scale, model.row_symbols);
  } catch (const InputError& error) {
    fail_at_place(root, table, error.what());
  }
}

void require_step_exposure(const TomlReader& root, const WrittenStudy& study,
                           const FormulaModel& model) {
  if (!model.steps) return;
  const WrittenLikelihood& life = study.likelihoods.front();
  const TomlReader table = table_of(root, life);
  Measured given;
  add_wanted(life, model.data.number(life.column)->unit.powers, given);
  const std::string scale = scale_parameter(table.required_text("family"));
  std::optional<formula::WrittenGraph> written;
  try {
    written = formula::written_graph(model.lines, given.wanted, model.row_symbols);
  } catch (const InputError& error) {
    fail_at_place(root, table, error.what());
  }
  std::set<std::size_t> may;
  for (std::size_t i = 0; i < given.family_parameter.size(); ++i) {
    const std::string_view name = life.form->family_parameters[given.family_parameter[i]].name;
    if (name == scale || name == "threshold") may.insert(i);
  }
  for (const ChangingStress& each : stresses_of_steps(model, life.column))
    require_scale_alone(table, "steps", scale, *written, given.wanted, may, each);
}

}  // namespace wearwell::formula_model
