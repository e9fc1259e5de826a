#include "wearwell/models/formula_model/classical_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/models/formula_model/classical_figure.h"
#include "wearwell/models/formula_model/formula_asked.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"
#include "wearwell/prob/standard_distribution.h"
#include "wearwell/study/long_tables.h"
#include "wearwell/study/terminal_rows.h"

namespace wearwell::formula_model {
namespace {

using present::Cell;
using Json = nlohmann::ordered_json;

constexpr const char* survival_table_id = "nonparametric-survival";

std::string full_name(const AskedOfClassics& asked, const ClassicalEstimate& each) {
  const bool alone = each.of.empty() || asked.lives.size() == 1;
  return joined(each.name + (alone ? "" : " of " + each.of), each.at);
}

const char* name_of(MedianRanks ranks) {
  return ranks == MedianRanks::exact ? "exact" : "Benard";
}

const char* name_of(SurvivalMethod method) {
  return method == SurvivalMethod::turnbull ? "Turnbull" : "Kaplan-Meier";
}

// The unit of a family's parameter: that of life, or none.
Unit unit_of(const ParameterForm& place, const Unit& life) {
  const bool of_life = place.kind == ParameterKind::scale || place.kind == ParameterKind::location;
  return of_life
             ? Unit{life.text, life.scale, place.kind == ParameterKind::location ? life.offset : 0}
             : Unit{"1", 1, 0};
}

// Of parameters and quantities together.
std::vector<ClassicalEstimate> named_estimates(const AskedOfClassics& asked,
                                               const ClassicalEstimates& found) {
  std::vector<ClassicalEstimate> all = found.parameters;
  all.insert(all.end(), found.quantities.begin(), found.quantities.end());
  for (ClassicalEstimate& each : all) each.name = full_name(asked, each);
  return all;
}

present::Table line_table(const AskedOfClassics& asked, const ClassicalEstimates& found) {
  const Measured& measured = asked.model->measured.front();
  present::Table table{"rank-regression",
                       "Median rank regression, lives on ranks (X on Y)",
                       {{"Condition"}, {"Median ranks"}}};
  for (const ParameterForm& place : measured.form->family_parameters)
    table.columns.push_back({std::string(place.name), unit_of(place, measured.unit).text});
  for (const double percent : asked.percents)
    table.columns.push_back({fmt::format("B{:.6g}", percent), measured.unit.text});
  table.columns.push_back({"r"});
  table.columns.push_back({"r^2"});
  for (const ClassicalGroup& group : found.groups) {
    for (const ClassicalGroup::Line& line : group.lines) {
      table.rows.push_back({group.words.empty() ? "all" : group.words, name_of(line.ranks)});
      std::vector<Cell>& row = table.rows.back();
      for (std::size_t i = 0; i < line.family_parameters.size(); ++i)
        row.emplace_back(from_si(unit_of(measured.form->family_parameters[i], measured.unit),
                                 line.family_parameters[i]));
      for (const double life : line.b_lives) row.emplace_back(from_si(measured.unit, life));
      row.emplace_back(line.fit.r);
      row.emplace_back(line.fit.r * line.fit.r);
    }
  }
  return table;
}

present::Table survival_table(const AskedOfClassics& asked, const ClassicalEstimates& found) {
  const Unit& unit = asked.model->measured.front().unit;
  present::Table table{survival_table_id,
                       "Nonparametric survival, " + confidence_text(asked.level),
                       {{"Condition"},
                        {"Method"},
                        {"Failed after", unit.text, present::given},
                        {"Failed by", unit.text, present::given},
                        {"At risk", "1", present::given},
                        {"Failed", "1", present::given},
                        {"Survival", "%"},
                        {"Standard error", "%", present::digits(3)},
                        {"Lower", "%"},
                        {"Upper", "%"}}};
  for (const ClassicalGroup& group : found.groups) {
    const bool risk_sets = group.survival.method == SurvivalMethod::kaplan_meier;
    for (const SurvivalStep& step : group.survival.steps) {
      const SurvivalBand band = log_log_band(step, asked.level.deviate());
      const auto percent = [](double x) { return std::isnan(x) ? Cell() : Cell(100 * x); };
      const bool from = step.from > -infinity && step.from < step.at;
      table.rows.push_back(
          {group.words.empty() ? "all" : group.words, name_of(group.survival.method),
           from ? Cell(from_si(unit, step.from)) : Cell(), from_si(unit, step.at),
           risk_sets ? Cell(step.at_risk) : Cell(), risk_sets ? Cell(step.failed) : Cell(),
           100 * step.survival, percent(step.error), percent(band.lower), percent(band.upper)});
    }
  }
  return table;
}

std::vector<std::string> explanations(const ClassicalEstimates& found) {
  std::vector<std::string> all;
  if (!found.problem.empty()) {
    all.push_back("No maximum likelihood estimate: " + found.problem + ".");
  } else {
    all.push_back(
        "Maximum likelihood uses the data alone, not the priors. Normal bounds (Fisher, Wald) hold "
        "on the scale that the report names; likelihood-ratio bounds do not depend on a scale. "
        "Both "
        "rest on large samples: with few failures they are too narrow. The posterior has its "
        "quantiles at the same level.");
  }
  const auto has = [&](SurvivalMethod method) {
    return std::any_of(found.groups.begin(), found.groups.end(), [&](const ClassicalGroup& each) {
      return each.survival.method == method && !each.survival.steps.empty();
    });
  };
  const std::string bounds = "; bounds are pointwise, normal for log(-log survival).";
  if (has(SurvivalMethod::kaplan_meier))
    all.push_back("Kaplan-Meier: standard errors by Greenwood's formula" + bounds);
  if (has(SurvivalMethod::turnbull))
    all.push_back("Turnbull: standard errors from the observed information" + bounds);
  all.insert(all.end(), found.notes.begin(), found.notes.end());
  return all;
}

// Condition and method together, and r^2 without r: a terminal is narrow.
std::string line_text(const present::Table& table) {
  if (table.rows.empty()) return "";
  std::vector<std::vector<std::string>> rows = {{""}};
  const std::size_t r = table.columns.size() - 2;
  for (std::size_t c = 2; c < table.columns.size(); ++c) {
    if (c != r) rows[0].push_back(printable_heading(table.columns[c].name, table.columns[c].unit));
  }
  for (const std::vector<Cell>& row : table.rows) {
    const std::string& condition = std::get<std::string>(row[0]);
    rows.push_back({fmt::format("  {}{} median ranks", condition == "all" ? "" : condition + ", ",
                                std::get<std::string>(row[1]))});
    for (std::size_t c = 2; c < row.size(); ++c) {
      if (c != r) rows.back().push_back(plain_number(std::get<double>(row[c])));
    }
  }
  return "\n" + table.caption + "\n" + text_table(rows);
}

std::string classical_text(const AskedOfClassics& asked, const ClassicalEstimates& found,
                           const present::Table& lines, std::size_t steps) {
  std::string text = fmt::format("Classical estimates ({})\n", confidence_text(asked.level)) +
                     (found.problem.empty() ? estimate_text(named_estimates(asked, found)) : "");
  for (const std::string& each : explanations(found)) text += wrapped(each, 2, 4);
  text += line_text(lines);
  if (steps > 0)
    text += "\n" + wrapped(fmt::format("Nonparametric survival with bounds, {} step{}: "
                                       "tables/{}.csv, and in the report.",
                                       steps, steps == 1 ? "" : "s", survival_table_id),
                           0, 2);
  return text;
}

Json likelihood_json(const ClassicalEstimates& found, const DensityUnit& density) {
  if (!found.problem.empty()) return {{"problem", found.problem}};
  Json json = {{"log_likelihood", found.log_likelihood + density.total},
               {"density_unit", density.text},
               {"parameters", Json::array()},
               {"quantities", Json::array()}};
  for (const ClassicalEstimate& each : found.parameters)
    json["parameters"].push_back(estimate_json(each));
  for (const ClassicalEstimate& each : found.quantities)
    json["quantities"].push_back(estimate_json(each));
  return json;
}

Json group_json(const AskedOfClassics& asked, const ClassicalGroup& group) {
  const Measured& measured = asked.model->measured.front();
  Json json = {{"condition", group.words}};
  Json lines = Json::array();
  for (const ClassicalGroup::Line& line : group.lines) {
    Json each = {{"median_ranks", line.ranks == MedianRanks::exact ? "exact" : "benard"}};
    for (std::size_t i = 0; i < line.family_parameters.size(); ++i) {
      const ParameterForm& place = measured.form->family_parameters[i];
      each["parameters"][std::string(place.name)] =
          from_si(unit_of(place, measured.unit), line.family_parameters[i]);
    }
    each["b_lives"] = Json::array();
    for (std::size_t i = 0; i < line.b_lives.size(); ++i)
      each["b_lives"].push_back(
          {{"percent", asked.percents[i]}, {"life", from_si(measured.unit, line.b_lives[i])}});
    each["r"] = line.fit.r;
    lines.push_back(std::move(each));
  }
  json["rank_regression"] = std::move(lines);
  if (group.survival.method == SurvivalMethod::none) return json;
  json["survival"]["method"] =
      group.survival.method == SurvivalMethod::turnbull ? "turnbull" : "kaplan_meier";
  if (group.survival.steps.size() > most_rows_inline) {
    json["survival"]["table"] = fmt::format("tables/{}.csv", survival_table_id);
    return json;
  }
  Json steps = Json::array();
  for (const SurvivalStep& step : group.survival.steps) {
    const SurvivalBand band = log_log_band(step, asked.level.deviate());
    steps.push_back({{"after", step.from > -infinity ? from_si(measured.unit, step.from) : 0.0},
                     {"by", from_si(measured.unit, step.at)}});
    if (group.survival.method == SurvivalMethod::kaplan_meier)
      steps.back().update({{"at_risk", step.at_risk}, {"failed", step.failed}});
    steps.back().update({{"survival", step.survival},
                         {"standard_error", step.error},
                         {"lower", band.lower},
                         {"upper", band.upper}});
  }
  json["survival"]["steps"] = std::move(steps);
  return json;
}

}  // namespace

PresetAddition classical_addition(const AskedOfClassics& asked, const DensityUnit& density,
                                  const Fit& fit) {
  const ClassicalEstimates found = classical_estimates(asked, fit);
  const present::Table lines = line_table(asked, found), steps = survival_table(asked, found);
  PresetAddition added;
  Json& json = added.body["classical"];
  json = {{"level", asked.level.level},
          {"sides", asked.level.two_sided ? "two" : "one"},
          {"life_unit", asked.model->measured.front().unit.text},
          {"maximum_likelihood", likelihood_json(found, density)},
          {"groups", Json::array()},
          {"notes", found.notes}};
  for (const ClassicalGroup& each : found.groups) json["groups"].push_back(group_json(asked, each));
  std::vector<present::Block>& blocks = added.blocks["predictions"];
  std::string words = "Classical estimates, to lay beside other programs.";
  for (const std::string& each : explanations(found)) words += " " + each;
  blocks.push_back({present::Prose{words}});
  if (found.problem.empty())
    blocks.push_back({estimate_table(named_estimates(asked, found), asked.level)});
  if (!lines.rows.empty()) blocks.push_back({lines});
  if (!steps.rows.empty()) {
    blocks.push_back({present::Figures{{survival_figure(asked, found, asked.level.deviate())}}});
    blocks.push_back({steps});
  }
  added.text = classical_text(asked, found, lines, steps.rows.size());
  return added;
}

}  // namespace wearwell::formula_model
