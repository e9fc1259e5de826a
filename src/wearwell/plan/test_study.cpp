#include "wearwell/plan/test_study.h"
#include "wearwell/plan/no_mixtures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/contains.h"
#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/as_read.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/heading.h"
#include "wearwell/prob/family_form.h"
#include "wearwell/study/inference_data.h"

namespace wearwell::plan {
namespace {

using prognosis::DataRoles;

Unit unit_of_column(const Column& column, const std::string& stated) {
  const std::string text = !stated.empty()        ? stated
                           : !column.unit.empty() ? bare_unit(column.unit)
                                                  : read_heading(column.name, "").unit;
  const auto read = text.empty() ? std::nullopt : parse_unit(text);
  if (!read) return {"1", 1, 0};
  return {text, read->scale, read->offset};
}

// [predict] of an S-N study may name types of its data and does not change its likelihood.
TextFile without_predict(const TextFile& study) {
  TextFile rest = study;
  rest.text.clear();
  bool inside = false;
  for (std::size_t at = 0; at < study.text.size();) {
    const std::size_t end = std::min(study.text.find('\n', at), study.text.size() - 1) + 1;
    const std::string line = study.text.substr(at, end - at);
    const std::size_t first = line.find_first_not_of(" \t");
    if (first != line.npos && line[first] == '[')
      inside = line.compare(first, 9, "[predict]") == 0 || line.compare(first, 9, "[predict.") == 0;
    if (!inside) rest.text += line;
    at = end;
  }
  return rest;
}

const DataRoles::Named* used_as(const DataRoles& roles, const std::string& name) {
  for (const DataRoles::Named& each : roles.used)
    if (each.name == name) return &each;
  return nullptr;
}

// The column that a test measures; its family decides what values it can have.
void find_measured(const TomlReader& root, const std::string& measure, TestStudy& study) {
  const std::string model = root.required_text("model");
  if (root.has("failure_modes"))
    root.fail(
        "failure_modes",
        "is not possible with `wearwell plan next`: a test to come would have a probability for "
        "each mode; plan with a study of one mode, the others being run-outs");
  refuse_mixtures(root, "wearwell plan next");
  if (model == "staircase") {
    if (!measure.empty())
      throw InputError("--measure: a staircase test shows failure or run-out, not a number");
    return;
  }
  std::vector<std::string> names;
  for (const DataRoles::Named& each : study.roles.used)
    if (contains(study.roles.measured, each.column)) names.push_back(each.name);
  if (model == "sn") names = {"life"};
  if (names.empty() || (model == "archard-joint" && names.size() > 1))
    throw InputError(
        "plan: a test of this study is not one row with one measured value, so that its outcome "
        "cannot be predicted row by row");
  if (!measure.empty() && !contains(names, measure))
    throw InputError(fmt::format("--measure: there is no measured column '{}'; it is one of {}{}",
                                 printable(measure), fmt::join(names, ", "),
                                 did_you_mean(measure, names)));
  if (measure.empty() && names.size() > 1)
    throw InputError(
        fmt::format("--measure is missing: the study measures {}; which of them does "
                    "a test measure?",
                    fmt::join(names, ", ")));
  study.measured_name = measure.empty() ? names.front() : measure;
  const DataRoles::Named* const named = used_as(study.roles, study.measured_name);
  study.measured = named->column;
  study.measured_unit = unit_of_column(study.table().column(named->column), named->unit);
  study.positive = model == "sn";
  study.is_life = model == "sn";
  if (model != "formula") return;
  const auto predict = root.table("predict");
  const TomlReader likelihood =
      root.required_table("likelihood").required_table(study.measured_name);
  const std::string family = likelihood.required_text("family");
  const ResponseForm* const form = given_form(
      response_forms(), family, [&](std::string_view name) { return likelihood.has(name); });
  study.counted = form && form->counted;
  if (const auto trials = likelihood.text("trials"))
    if (const DataRoles::Named* const named_trials = used_as(study.roles, *trials))
      study.trials = named_trials->column;
  // Paths of these processes rise from 0; with errors of readings they may also be below it.
  const bool rising = family == "gamma-process" || family == "inverse-gaussian-process";
  study.positive = (form && form->positive) || (rising && !likelihood.has("noise"));
  study.is_life = study.positive && !(predict && predict->has("along"));
}

// What the study's own rows say of a test's conditions.
ConditionColumn condition_of(const Table& table, const DataRoles::Named& named, bool words) {
  const Column& column = table.column(named.column);
  ConditionColumn condition{named.name, named.column, unit_of_column(column, named.unit), words};
  if (words || !holds_numbers(column)) {
    condition.words = true;
    for (std::size_t i = 0; i < table.rows; ++i)
      if (const std::string word = cell_word(column, i); !contains(condition.labels, word))
        condition.labels.push_back(word);
    return condition;
  }
  condition.low = INFINITY, condition.high = -INFINITY;
  for (std::size_t i = 0; i < table.rows; ++i) {
    const double value = cell_value(table, column, i).number;
    if (std::isnan(value)) continue;
    condition.low = std::min(condition.low, value);
    condition.high = std::max(condition.high, value);
  }
  return condition;
}

void find_conditions(const TomlReader& root, TestStudy& study) {
  static const std::vector<std::string> of_outcomes = {"status", "lower",      "upper",
                                                       "entry",  "life_until", "count"};
  static const std::vector<std::string> of_specimens = {"label", "part"};
  std::vector<std::string> varying;
  if (const auto effects = root.table("random_effects")) varying = effects->keys();
  const bool sn = root.required_text("model") == "sn" || root.required_text("model") == "staircase";
  for (const DataRoles::Named& each : study.roles.used) {
    if (each.column == study.measured || contains(study.roles.measured, each.column)) continue;
    if (each.name == "count") study.ones.push_back(each.column);
    if (contains(of_outcomes, each.name)) continue;
    if (sn && contains(of_specimens, each.name)) {
      study.names.push_back(each.column);
    } else if (contains(varying, each.name) || each.column == study.unit) {
      study.conditions.push_back(condition_of(study.table(), each, true));
      study.conditions.back().varies = true;
    } else {
      study.conditions.push_back(
          condition_of(study.table(), each, contains(study.roles.words, each.column)));
    }
  }
}

// The label of units: the noun of the factors of the likelihood is its name if they are of units.
void find_unit(const PosteriorStudy& own, TestStudy& study) {
  study.factor_noun = own.observation;
  const DataRoles::Named* const named = used_as(study.roles, own.observation);
  if (named && named->unit.empty() && named->column != study.measured)
    study.unit = named->column;
  else
    study.unit = study.roles.unit.value_or("");
  // Drawn effects of units are parameters of each.
  for (const Parameter& each : own.parameters) {
    study.parameters.push_back(each.name);
    if (named && each.name.ends_with(fmt::format("[new {}]", own.observation)))
      throw InputError(fmt::format(
          "plan: each {} has more than two random effects, so that its readings have no "
          "distribution without a parameter for each {}; plan with at most two",
          own.observation, own.observation));
  }
}

void find_size(TestStudy& study) {
  if (study.measured.empty()) return;
  std::vector<double> values;
  const Table& table = study.table();
  for (std::size_t i = 0; i < table.rows; ++i) {
    const double value = cell_value(table, table.column(study.measured), i).number;
    if (std::isfinite(value) && (value > 0 || !study.positive)) values.push_back(value);
  }
  if (values.empty())
    throw InputError(fmt::format("plan: column '{}' of the study has no value", study.measured));
  std::sort(values.begin(), values.end());
  study.typical = values[values.size() / 2];
  study.spread = std::max(values.back() - values.front(), 1e-3 * std::abs(study.typical));
  if (!(study.spread > 0)) study.spread = 1;
}

}  // namespace

const ConditionColumn* TestStudy::condition(const std::string& heading) const {
  const auto at =
      std::find_if(conditions.begin(), conditions.end(),
                   [&](const ConditionColumn& each) { return each.heading == heading; });
  return at == conditions.end() ? nullptr : &*at;
}

TestStudy test_study(const Source& source, const ReadStudy& read, const std::string& measure) {
  TestStudy study{source, read};
  const TomlReader root = TomlReader::parse(source.study);
  const TomlReader data = root.required_table("data");
  study.key = as_read_name(data);
  if (!study.source.tables.contains(study.key))
    study.source.tables[study.key] = read_table(data, source);
  study.roles = prognosis::data_roles(root, study.table());
  find_measured(root, measure, study);
  const auto whole = read(study.source);
  const PosteriorStudy& own = require_posterior_study(*whole);
  find_unit(own, study);
  find_conditions(root, study);
  if (used_as(study.roles, "status"))
    study.status = read_life_status(data.required_table("columns"), study.table());
  find_size(study);
  for (const DataColumn& each : own.data_columns) {
    if (each.name != study.measured_name) continue;
    study.measured_unit = each.unit;
    study.measured_si = each.si;
  }
  if (root.required_text("model") == "sn") {
    study.source.study = without_predict(study.source.study);
    study.own = require_posterior_study(*read(study.source)).likelihood(own.data_rows);
  } else {
    study.own = own.likelihood(own.data_rows);
  }
  return study;
}

}  // namespace wearwell::plan
