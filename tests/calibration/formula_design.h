#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/exact.h"
#include "wearwell/infer/mode.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"

namespace wearwell::formula_model {

/// Units whose wear is a straight line through 0, each at a rate of its own.
inline const std::string straight = R"(
[data.columns]
depth = { column = "depth", unit = "um" }
time = { column = "time", unit = "h" }
unit = "unit"
[formula]
wear = "b * time"
[likelihood.depth]
family = "normal"
mean = "wear"
sd = "sigma"
[prior]
b = { distribution = "lognormal", median = "1 um/h", log_sd = 0.5 }
scatter = { distribution = "half-normal", scale = 0.5 }
sigma = { distribution = "half-normal", scale = "0.5 um" }
[random_effects.unit]
b = { distribution = "lognormal", log_sd = "scatter" }
[predict]
along = "time"
limit = { wear = "12 um" }
)";

/// A study of a law in memory, read once; its observations are replaced from replication to replication.
struct FormulaDesign {
  Source source;
  TomlReader root;
  std::shared_ptr<const FormulaModel> law;

  FormulaDesign(const std::string& study, const std::vector<Column>& columns)
      : source(in_memory(study, columns)),
        root(TomlReader::parse(source.study)),
        law(read_formula_model(root, source)) {}

  /// The same with other observations of its only measured column, row by row.
  std::shared_ptr<const FormulaModel> with(const std::vector<Response>& responses) const {
    auto changed = std::make_shared<FormulaModel>(*law);
    changed->measured.front().observed.responses = responses;
    return changed;
  }

  /// One number a parameter, drawn from its prior.
  std::vector<double> from_priors(Rng& rng) const {
    std::vector<double> x;
    for (const Parameter& each : law->parameters) x.push_back(quantile(each.prior, rng.uniform()));
    return x;
  }

 private:
  static Source in_memory(const std::string& study, const std::vector<Column>& columns) {
    Table table;
    table.source = "d.csv";
    table.columns = columns;
    table.rows =
        columns.front().is_number ? columns.front().numbers.size() : columns.front().text.size();
    return {{"study.toml", "model = \"formula\"\n[data]\nfile = \"d.csv\"\n" + study},
            {{"d.csv", table}}};
  }
};

inline Column numbers(const std::string& name, const std::vector<double>& values) {
  Column column;
  column.name = name;
  column.is_number = true;
  column.numbers = values;
  return column;
}

inline Column texts(const std::string& name, const std::vector<std::string>& values) {
  Column column;
  column.name = name;
  column.text = values;
  return column;
}

/// The posterior by quadrature, as a study has it, but for the digits: its mass to this tolerance.
inline ExactPosterior exact_posterior(const std::shared_ptr<const FormulaRows>& rows,
                                      double tolerance) {
  const auto likelihood = formula_likelihood(rows);
  const Posterior posterior(rows->law().parameters, likelihood);
  ExactSettings settings;
  settings.tolerance = tolerance;
  settings.second_moments = false;
  return integrate(posterior, whitening_at(find_mode(posterior, posterior.start())), settings);
}

}  // namespace wearwell::formula_model
