#include "wearwell/models/formula_model/formula_reader.h"

#include <fmt/format.h>
#include <algorithm>
#include <regex>

#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/fail_at_place.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_order.h"
#include "wearwell/models/formula_model/linear_form.h"
#include "wearwell/models/formula_model/lines_by_level.h"
#include "wearwell/models/formula_model/unit_effects.h"
#include "wearwell/models/formula_model/use_rate_model.h"
#include "wearwell/models/formula_model/written_exposure.h"
#include "wearwell/models/formula_model/written_likelihood.h"
#include "wearwell/models/formula_model/written_modes.h"
#include "wearwell/models/formula_model/written_parameters.h"

namespace wearwell::formula_model {
namespace {

void read_use_rate(const TomlReader& root, WrittenStudy& study, FormulaModel& model) {
  if (!study.use_rate) return;
  if (!model.data.number(study.likelihoods.front().column))
    fail_without_column(root, model.data, study.likelihoods.front());
  add_use_rates(root, study.likelihoods.front().column, model.data);
  study.likelihoods.push_back(*study.use_rate);
}

// After the life in use and the rate.
void add_life_in_time(const TomlReader& root, FormulaModel& model) {
  model.use_rate = life_in_time(root, model.measured[0], model.measured[1], model.data);
  Measured& in_time = model.use_rate->in_time;
  if (model.measured[0].program.has_paths() || model.measured[1].program.has_paths())
    root.fail(UseRate::name,
              "is not possible with expressions that depend on earlier rows (cum, or a state)");
  in_time.program = formula::compile(model.lines, in_time.wanted, model.row_symbols);
  if (!in_time.observed.rows.empty()) model.measured.push_back(in_time);
}

// Replaces the likelihood by that of the mixture, and the lines that depend on the subpopulation by copies.
void read_mixture(const TomlReader& root, WrittenStudy& study, FormulaModel& model) {
  refuse_with_shares(root, study.likelihoods);
  if (!study.subpopulations) return;
  refuse_with_subpopulations(root, study.likelihoods, study.texts);
  const LinesByLevel lines(root, Subpopulations::label, model.subpopulations->names, model.lines);
  model.lines = lines.lines();
  study.likelihoods.front() = mixture_of(root, *model.subpopulations, study.likelihoods.front(),
                                         study.of_subpopulations, lines);
}

// A difference of temperatures has no zero in degrees Celsius: 100 degC would be 373 K.
void refuse_ranges_in_celsius(const TomlReader& root, const WrittenStudy& study,
                              const FormulaData& data) {
  static const std::regex call(R"((coffin_manson|norris_landzberg)\s*\(\s*(\w+)\s*,\s*(\w+))");
  for (const std::string& text : study.texts) {
    for (std::sregex_iterator it(text.begin(), text.end(), call), end; it != end; ++it) {
      for (const std::string& name : std::vector<std::string>{(*it)[2], (*it)[3]}) {
        const NumberColumn* column = data.number(name);
        if (column && column->unit.unit.offset != 0)
          root.required_table("data").required_table("columns").fail(
              name, fmt::format("is the range of {}, a difference of temperatures: give it in K, "
                                "not in {}",
                                (*it)[1].str(), column->unit.unit.text));
        const auto constants = root.table("constants");
        if (constants && constants->is_text(name) &&
            formula::read_any_quantity(constants->required_text(name)).quantity.unit.offset != 0)
          constants->fail(name, fmt::format("is the range of {}, a difference of temperatures: "
                                            "give it in K",
                                            (*it)[1].str()));
      }
    }
  }
}

// The axis of wear and life, along which the rows of a unit are sorted.
void read_along(const TomlReader& root, FormulaModel& model) {
  if (const auto predict = root.table("predict")) model.along = predict->text("along");
  if (model.along && !model.data.number(*model.along)) {
    root.required_table("predict").fail(
        "along", fmt::format("'{}' is not a numeric column under data.columns{}", *model.along,
                             nearest_column(model.data, *model.along)));
  }
  if (model.along) return;
  static const std::regex rate(R"(d\(\s*\w+\s*\)\s*/\s*d\(\s*(\w+)\s*\))");
  for (const formula::Line& line : model.lines) {
    std::smatch match;
    if (std::regex_match(line.name, match, rate) && model.data.number(match[1])) {
      model.along = match[1];
    }
  }
}

bool is_age(const TomlReader& root, const WrittenStudy& study, const std::string& name) {
  return study.use_rate && root.required_table(UseRate::name).required_text("age") == name;
}

void read_symbols(const TomlReader& root, const WrittenStudy& study, FormulaModel& model) {
  for (const NumberColumn& column : model.data.numbers) {
    const bool special = std::find(qualifying_columns.begin(), qualifying_columns.end(),
                                   column.name) != qualifying_columns.end();
    model.symbols.columns.push_back(
        {column.name, column.unit.powers,
         special || study.measures(column.name) || is_age(root, study, column.name)});
  }
  for (const LabelColumn& label : model.data.labels) {
    if (label.name != "status") model.symbols.labels.push_back({label.name, label.levels});
  }
  if (model.modes) model.symbols.labels.push_back({model.modes->name, model.modes->modes});
  if (study.subpopulations)
    model.symbols.labels.push_back({Subpopulations::label, model.subpopulations->names});
  if (const auto constants = root.table("constants")) {
    for (const std::string& name : constants->keys()) {
      if (!constants->is_text(name)) {
        model.symbols.constants.push_back({name, {}, constants->required_quantity(name, "1").si()});
        continue;
      }
      try {
        const formula::AnyQuantity q = formula::read_any_quantity(constants->required_text(name));
        model.symbols.constants.push_back({name, q.powers, q.quantity.si()});
      } catch (const InputError& error) {
        constants->fail(name, error.what());
      }
    }
  }
}

SpecialColumns allowed_special_columns(const TomlReader& root, const WrittenStudy& study,
                                       const FormulaModel& model) {
  const SpecialColumns special = special_columns(model.data);
  const auto process = std::find_if(study.likelihoods.begin(), study.likelihoods.end(),
                                    [](const auto& each) { return each.process != nullptr; });
  if (process != study.likelihoods.end()) {
    for (const auto& each :
         {special.status, special.lower, special.upper, special.entry, special.count}) {
      if (!each) continue;
      root.required_table("data").required_table("columns").fail(
          *each, fmt::format("is not possible for a {}: each of its readings is one exact number",
                             process->form->name));
    }
  }
  if (!model.modes && !study.use_rate && study.likelihoods.size() > 1 &&
      (special.status || special.lower || special.upper || special.entry)) {
    const TomlReader columns = root.required_table("data").required_table("columns");
    columns.fail(special.status  ? "status"
                 : special.lower ? "lower"
                 : special.upper ? "upper"
                                 : "entry",
                 "is ambiguous in a study of several measured columns");
  }
  return special;
}

// A parameter without effect on any output is a mistake: its posterior would be its prior.
void require_used_parameters(const TomlReader& root, const FormulaModel& model) {
  const TomlReader priors = root.required_table("prior");
  for (std::size_t s = 0; s < model.symbols.parameters.size(); ++s) {
    const bool measured =
        std::any_of(model.measured.begin(), model.measured.end(),
                    [&](const Measured& m) { return m.program.uses_parameter(s); });
    if (measured || (model.label && model.population.uses_parameter(s))) continue;
    const std::string& name = model.symbols.parameters[s].name;
    priors.fail(name, "is in no likelihood: the data would not inform it");
  }
}

// What is measured, without its observations.
Measured measured_of(const TomlReader& root, const WrittenLikelihood& written,
                     const FormulaModel& model) {
  const TomlReader table = table_of(root, written);
  const NumberColumn* column = measured_column(model.data, written);
  if (!column) fail_without_column(root, model.data, written);
  Measured measured{written.column,
                    written.mode,
                    column->unit.unit,
                    column->unit.powers,
                    written.form,
                    written.process,
                    written.trials,
                    {},
                    {},
                    {},
                    {},
                    written.life()};
  if (written.form->counted && !column->unit.powers.empty() && column->unit.unit.scale != 1) {
    table.fail("family", fmt::format("{} is for counts; '{}' is measured in {}", written.form->name,
                                     written.column, column->unit.unit.text));
  }
  if (written.trials && !model.data.number(*written.trials))
    table.fail("trials", "must name a numeric column under data.columns");
  add_wanted(written, column->unit.powers, measured);
  try {
    measured.program = formula::compile(model.lines, measured.wanted, model.row_symbols);
  } catch (const InputError& error) {
    fail_at_place(root, table, error.what());
  }
  if (written.process) model.data.require_values(*column);
  if (model.modes && measured.program.has_paths())
    table.fail(
        "", "depends on earlier rows (cum, or a state); that is not possible with [failure_modes]");
  if (!measured.life.plain() && measured.program.has_paths())
    table.fail("", "depends on earlier rows (cum, or a state); lives of subpopulations cannot");
  return measured;
}

// The observations of a likelihood, which follows the `earlier` ones.
Observed observed_of(const WrittenStudy& study, const WrittenLikelihood& written,
                     const SpecialColumns& special, const Measured& measured,
                     const FormulaModel& model) {
  const bool is_rate = study.use_rate && !model.measured.empty();
  if (is_rate) return observed_rates(model.data, model.measured[0].observed);
  const bool may_lack = study.likelihoods.size() > 1;
  Observed observed = read_observed(model.data, written.column, *written.form, special,
                                    written.trials, may_lack, measured.life.dead);
  if (model.steps) observed = last_steps(*model.steps, written.column, model.data, observed);
  if (model.ramp) require_exact_failures(model.data, written.column, observed);
  return observed;
}

// A column needs a value in every row, unless it is measured; in rows, if an expression uses it.
void require_values(const FormulaModel& model) {
  for (const NumberColumn& each : model.data.numbers) {
    const bool measured = std::any_of(model.measured.begin(), model.measured.end(),
                                      [&](const Measured& m) { return m.column == each.name; });
    if (!measured) model.data.require_values(each);
  }
  for (std::size_t c = 0; c < model.row_symbols.columns.size(); ++c) {
    const bool used = std::any_of(model.measured.begin(), model.measured.end(),
                                  [&](const Measured& m) { return m.program.uses_column(c); });
    if (used) model.data.require_complete(*model.data.number(model.row_symbols.columns[c].name));
  }
}

void add_measured(const TomlReader& root, const WrittenStudy& study, std::vector<Observed> of_modes,
                  FormulaModel& model) {
  const SpecialColumns special = allowed_special_columns(root, study, model);
  for (const WrittenLikelihood& written : study.likelihoods) {
    Measured measured = measured_of(root, written, model);
    measured.observed = model.modes ? std::move(of_modes[model.measured.size()])
                                    : observed_of(study, written, special, measured, model);
    measured.reporting = model.data.reporting;
    model.measured.push_back(std::move(measured));
  }
  if (study.use_rate) add_life_in_time(root, model);
  if (study.subpopulations)
    model.subpopulations->exchangeable = are_exchangeable(
        study.likelihoods.front(), *model.subpopulations, model.written, model.parameters);
}

// The `integrated` first effects of units with more than two are integrated out.
std::shared_ptr<FormulaModel> read_with_effects(const TomlReader& root, const Source& source,
                                                std::size_t integrated) {
  const auto model = std::make_shared<FormulaModel>();
  WrittenStudy study = read_written_study(root, source);
  model->written = model->lines = study.lines;
  model->subpopulations = study.subpopulations;
  model->steps = study.steps;
  model->ramp = study.ramp;
  if (study.use_rate) refuse_with_use_rate(root, study.likelihoods, *study.use_rate);
  model->data = read_own_data(root, source, label_names(root, study));
  read_use_rate(root, study, *model);
  read_exposure(root, study, *model);
  std::vector<Observed> of_modes = read_modes(root, study, *model);
  read_mixture(root, study, *model);
  const ChosenEffects effects = choose_effects(root, study, integrated, model->data);
  if (effects.units) model->label = effects.units->label;
  read_along(root, *model);
  read_symbols(root, study, *model);
  refuse_ranges_in_celsius(root, study, model->data);
  read_parameters(root, study, effects.drawn, *model);
  add_drawn_effects(root, effects.drawn, *model);
  add_unit_effects(root, effects, *model);
  compile_population(root, effects, *model);
  add_ramp_exposure(root, study, *model);
  require_step_exposure(root, study, *model);
  add_measured(root, study, std::move(of_modes), *model);
  require_values(*model);
  require_used_parameters(root, *model);
  order_rows(*model, root);
  require_rising(*model);
  require_status(*model, root);
  require_failures(*model);
  return model;
}

}  // namespace

std::string expression(const TomlReader& table, const std::string& key) {
  if (table.is_text(key)) return table.required_text(key);
  return fmt::format("{}", table.required_quantity(key, "1").si());
}

formula::Program compile_at(const TomlReader& table, const std::string& key,
                            const std::vector<formula::Line>& lines, const formula::Wanted& wanted,
                            const formula::Symbols& symbols) {
  try {
    return formula::compile(lines, {wanted}, symbols);
  } catch (const InputError& error) {
    table.fail(key, error.what());
  }
}

std::shared_ptr<FormulaModel> read_formula_model(const TomlReader& root, const Source& source) {
  std::shared_ptr<FormulaModel> model = read_with_effects(root, source, 2);
  // Two effects in which paths are linear cost no more than one; otherwise, of three, only one is
  // integrated out.
  const auto drawn = std::ranges::count_if(
      model->drawn, [&](const DrawnEffect& each) { return model->label == each.label; });
  if (drawn != 1 || model->effects.empty() ||
      is_linear(*model, bind_columns(*model, model->data.table.rows)))
    return model;
  return read_with_effects(root, source, 1);
}

}  // namespace wearwell::formula_model
