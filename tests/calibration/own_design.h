#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/exact.h"
#include "wearwell/infer/mode.h"
#include "wearwell/models/ownlaw/own_likelihood.h"
#include "wearwell/models/ownlaw/own_reader.h"

namespace wearwell::ownlaw {

/// Units whose wear is a straight line through 0, each at a rate of its own.
inline const std::string straight = R"(
[data.columns]
depth = { column = "depth", unit = "um" }
time = { column = "time", unit = "h" }
unit = "unit"
[law]
wear = "b * time"
[likelihood.depth]
family = "normal"
mean = "wear"
sd = "sigma"
[prior]
b = { law = "lognormal", median = "1 um/h", log_sd = 0.5 }
scatter = { law = "half-normal", scale = 0.5 }
sigma = { law = "half-normal", scale = "0.5 um" }
[varies.unit]
b = { law = "lognormal", log_sd = "scatter" }
[predict]
along = "time"
limit = { wear = "12 um" }
)";

/// A study of a law in memory, read once; its observations are replaced from replication to replication.
struct OwnDesign {
  Source source;
  TomlReader root;
  std::shared_ptr<const OwnLaw> law;

  OwnDesign(const std::string& study, const std::vector<Column>& columns)
      : source(in_memory(study, columns)),
        root(TomlReader::parse(source.study)),
        law(read_own_law(root, source)) {}

  /// The same with other observations of its only measured column, row by row.
  std::shared_ptr<const OwnLaw> with(const std::vector<Response>& responses) const {
    auto changed = std::make_shared<OwnLaw>(*law);
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
    return {{"study.toml", "model = \"law\"\n[data]\nfile = \"d.csv\"\n" + study},
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
inline ExactPosterior exact_posterior(const std::shared_ptr<const OwnRows>& rows,
                                      double tolerance) {
  const auto likelihood = own_likelihood(rows);
  const Posterior posterior(rows->law().parameters, likelihood);
  ExactSettings settings;
  settings.tolerance = tolerance;
  settings.second_moments = false;
  return integrate(posterior, whitening_at(find_mode(posterior, posterior.start())), settings);
}

}  // namespace wearwell::ownlaw
