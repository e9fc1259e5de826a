#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "wearwell/infer/fit.h"
#include "wearwell/models/registry.h"
#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/tracker.h"
#include "wearwell/prognosis/unit_life.h"
#include "wearwell/study/inference_data.h"

namespace wearwell {

// A table as it is written: a heading, then a row a line.
inline Table table_of(const std::string& file, const std::vector<std::string>& headings,
                      const std::vector<std::vector<std::string>>& rows) {
  Table table;
  table.source = file;
  table.rows = rows.size();
  for (std::size_t c = 0; c < headings.size(); ++c) {
    Column column;
    column.name = headings[c];
    column.is_number = true;
    for (const auto& row : rows)
      column.is_number &= row[c].find_first_not_of("0123456789.+-e") == std::string::npos;
    for (const auto& row : rows) {
      if (column.is_number) column.numbers.push_back(std::stod(row[c]));
      if (!column.is_number) column.text.push_back(row[c]);
    }
    table.columns.push_back(std::move(column));
  }
  return table;
}

// A trade's study in memory, fitted by quadrature, and what follows its units.
struct TrackedPreset {
  prognosis::CarriedState state;
  std::unique_ptr<const prognosis::Tracker> tracker;

  TrackedPreset(const std::string& study, const std::vector<std::string>& headings,
                const std::vector<std::vector<std::string>>& rows) {
    state.source.study = {"study.toml", study};
    state.source.tables["data.csv"] = table_of("data.csv", headings, rows);
    const auto read = read_study(state.source, all_models());
    const PosteriorStudy& known = require_posterior_study(*read);
    state.model = known.model;
    for (const Parameter& each : known.parameters) state.parameters.push_back(each.name);
    const Posterior posterior(known.parameters, known.likelihood(known.data_rows));
    FitSettings settings;
    settings.method = Method::exact;
    const Fit fitted = fit(posterior, settings);
    EXPECT_TRUE(fitted.exact) << fitted.no_exact;
    state.posterior = fitted.exact ? fitted.exact->nodes : fitted.pooled;
    for (const Model& model : all_models()) {
      if (model.key == state.model && model.track) tracker = model.track(state);
      if (tracker) break;
    }
  }

  prognosis::UnitLife life(const prognosis::LifeQuestion& question) const {
    return prognosis::unit_life(
        state.source, [](const Source& source) { return read_study(source, all_models()); },
        state.posterior, question);
  }
};

// Where the quantiles of a life, told in `scale` SI, lie in the forecast.
inline void expect_life(const prognosis::Forecast& forecast, const prognosis::UnitLife& life,
                        double scale, double tolerance) {
  for (const double p : {0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99})
    EXPECT_NEAR(forecast.remaining.cdf(scale * life.quantile(p)), p, tolerance) << p;
}

}  // namespace wearwell
