#include "wearwell/models/formula_model/step_stress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"

namespace wearwell::formula_model {
namespace {

// The rows of each specimen in the order of their ages.
std::vector<std::vector<std::size_t>> steps_of(const LabelColumn& label, const NumberColumn& life) {
  std::vector<std::vector<std::size_t>> all(label.levels.size());
  for (std::size_t row = 0; row < label.at.size(); ++row)
    all[static_cast<std::size_t>(label.at[row])].push_back(row);
  for (std::vector<std::size_t>& rows : all)
    std::stable_sort(rows.begin(), rows.end(),
                     [&](std::size_t a, std::size_t b) { return life.values[a] < life.values[b]; });
  return all;
}

}  // namespace

std::string scale_parameter(const std::string& family) {
  static const std::map<std::string, std::string> scales = {{"weibull", "scale"},
                                                            {"lognormal", "median"},
                                                            {"log10-normal", "median"},
                                                            {"exponential", "mean"},
                                                            {"gamma", "scale"},
                                                            {"loglogistic", "scale"},
                                                            {"generalized-gamma", "scale"},
                                                            {"birnbaum-saunders", "scale"},
                                                            {"exponentiated-weibull", "scale"},
                                                            {"frechet", "scale"}};
  const auto found = scales.find(family);
  return found == scales.end() ? "" : found->second;
}

std::string scale_of_exposure(const TomlReader& likelihood, const std::string& key,
                              const std::string& family, const std::string& scale) {
  std::string parameter = scale_parameter(family);
  if (parameter.empty())
    likelihood.fail(key, fmt::format("needs a family of lives with a scale; {} has none "
                                     "(weibull, lognormal, loglogistic, exponential, gamma)",
                                     family));
  if (scale.empty()) likelihood.fail(key, fmt::format("needs {} by its {}", family, parameter));
  if (likelihood.has("threshold"))
    likelihood.fail("threshold",
                    fmt::format("is not possible with {}, whose ages begin at 0", key));
  return parameter;
}

StepStress read_step_stress(const TomlReader& likelihood, const std::string& family,
                            const std::string& scale) {
  scale_of_exposure(likelihood, "steps", family, scale);
  return {likelihood.required_text("steps"), scale, "duration_of_step"};
}

std::string threshold_of(const StepStress& steps) {
  // cum counts its own row, too.
  return fmt::format("-({0})*(cum({1}/({0})) - {1}/({0}))", steps.scale, steps.duration);
}

void add_durations(const StepStress& steps, const std::string& life, FormulaData& data) {
  const NumberColumn* ages = data.number(life);
  const LabelColumn& label = *data.label(steps.label);
  if (data.number(steps.duration) || data.label(steps.duration))
    throw InputError(
        fmt::format("data.columns.{}: this name has a meaning in a study of steps; "
                    "give the column another one",
                    steps.duration));
  data.require_complete(*ages);
  std::vector<double> durations(data.table.rows);
  for (const std::vector<std::size_t>& rows : steps_of(label, *ages)) {
    double before = 0;
    for (const std::size_t row : rows) {
      durations[row] = ages->values[row] - before;
      if (!(durations[row] > 0))
        throw InputError(fmt::format(
            "{}: {:.10g} {} must be greater than {}; steps of one specimen have the age at their "
            "end",
            place(data.table, ages->column, row), from_si(ages->unit.unit, ages->values[row]),
            ages->unit.unit.text, before > 0 ? "the end of the step before" : "0"));
      before = ages->values[row];
    }
  }
  NumberColumn column{steps.duration, ages->column, ages->unit, std::move(durations)};
  data.numbers.push_back(std::move(column));
}

bool changes_between_steps(const StepStress& steps, std::span<const double> values,
                           const FormulaData& data) {
  const LabelColumn& label = *data.label(steps.label);
  std::vector<double> first(label.levels.size(), std::nan(""));
  for (std::size_t row = 0; row < values.size(); ++row) {
    double& of_specimen = first[static_cast<std::size_t>(label.at[row])];
    if (std::isnan(of_specimen)) of_specimen = values[row];
    if (values[row] != of_specimen) return true;
  }
  return false;
}

Observed last_steps(const StepStress& steps, const std::string& life, const FormulaData& data,
                    const Observed& all) {
  const NumberColumn& ages = *data.number(life);
  const std::vector<double>& durations = data.number(steps.duration)->values;
  Observed last;
  for (const std::vector<std::size_t>& rows : steps_of(*data.label(steps.label), ages)) {
    for (const std::size_t row : rows) {
      Response response = all.responses[row];
      const double before = ages.values[row] - durations[row];
      const auto refuse = [&](const std::string& what) {
        throw InputError(fmt::format("{}: {}", place(data.table, ages.column, row), what));
      };
      if (all.counts[row] != all.counts[rows.back()])
        refuse("the steps of one specimen have one count");
      if (row != rows.back()) {
        if (response.seen != Censoring::right)
          refuse(
              "a failure, but the specimen has a later step; steps that were survived are "
              "run-outs");
        continue;
      }
      const bool from_start = response.seen == Censoring::left && before == 0;
      if ((response.seen == Censoring::left && !from_start) ||
          (response.seen == Censoring::interval && response.at < before))
        refuse("this interval begins before the last step; the stress at failure must be known");
      response.at -= before;
      if (response.seen == Censoring::interval) response.until -= before;
      last.rows.push_back(row);
      last.responses.push_back(response);
      last.counts.push_back(all.counts[row]);
      last.failures += response.seen != Censoring::right;
    }
  }
  return last;
}

}  // namespace wearwell::formula_model
