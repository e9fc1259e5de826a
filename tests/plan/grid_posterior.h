#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/input/as_read.h"
#include "wearwell/models/registry.h"
#include "wearwell/plan/next_question.h"
#include "wearwell/prognosis/carried_state.h"
#include "wearwell/study/inference_data.h"

namespace wearwell::plan {

inline ReadStudy reading() {
  return [](const Source& source) { return read_study(source, all_models()); };
}

inline Column numbers_column(const std::string& name, const std::vector<double>& numbers) {
  return {name, true, numbers, {}};
}

inline Table table_of(const std::string& source, const std::vector<Column>& columns) {
  Table table{source, columns};
  table.rows = columns[0].is_number ? columns[0].numbers.size() : columns[0].text.size();
  return table;
}

inline Posterior posterior_of(const Source& source) {
  const auto study = reading()(source);
  const PosteriorStudy& own = require_posterior_study(*study);
  return {own.parameters, own.likelihood(own.data_rows)};
}

/// The posterior of two parameters on an even grid between these bounds, natural parameters.
struct Grid {
  double low0, high0, low1, high1;
  int count = 40;
};
inline WeightedDraws on_grid(const Posterior& posterior, const Grid& grid) {
  WeightedDraws draws;
  const Eigen::Index n = grid.count;
  draws.values.resize(n * n, 2);
  Eigen::VectorXd log_weight(n * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::Index k = i * n + j;
      draws.values(k, 0) = grid.low0 + (grid.high0 - grid.low0) * (static_cast<double>(i) + 0.5) /
                                           static_cast<double>(n);
      draws.values(k, 1) = grid.low1 + (grid.high1 - grid.low1) * (static_cast<double>(j) + 0.5) /
                                           static_cast<double>(n);
      log_weight[k] = posterior.natural_value({draws.values.row(k).data(), 2});
    }
  }
  draws.weights = (log_weight.array() - log_weight.maxCoeff()).exp();
  draws.weights /= draws.weights.sum();
  return draws;
}

inline prognosis::CarriedState state_of(const Source& source, const WeightedDraws& draws) {
  const auto study = reading()(source);
  prognosis::CarriedState state{"formula", true, source, {}, draws};
  for (const Parameter& each : require_posterior_study(*study).parameters)
    state.parameters.push_back(each.name);
  // As a fit saves it.
  const TomlReader data = TomlReader::parse(source.study).required_table("data");
  state.source.tables[as_read_name(data)] = read_table(data, source);
  return state;
}

}  // namespace wearwell::plan
