#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/formula_design.h"
#include "support/followed_unit.h"
#include "wearwell/models/formula_model/formula_limit.h"
#include "wearwell/models/formula_model/formula_lives.h"
#include "wearwell/models/formula_model/formula_process_lives.h"
#include "wearwell/models/formula_model/formula_tracker.h"

namespace wearwell::formula_model {

inline constexpr double um = 1e-6, h = 3600;

// A posterior of a few points, even in weight.
inline WeightedDraws points(const std::vector<std::vector<double>>& x) {
  WeightedDraws draws;
  const auto n = static_cast<Eigen::Index>(x.size()), d = static_cast<Eigen::Index>(x[0].size());
  draws.values.resize(n, d);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < d; ++j) {
      draws.values(i, j) = x[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  draws.weights = Eigen::VectorXd::Constant(n, 1.0 / static_cast<double>(n));
  return draws;
}

struct Watched {
  FormulaDesign design;
  std::unique_ptr<const prognosis::Tracker> tracker;

  Watched(const std::string& study, const std::vector<Column>& columns,
          const std::optional<WeightedDraws>& posterior = {})
      : design(study, columns) {
    prognosis::CarriedState state;
    state.source = design.source;
    for (const Parameter& each : design.model->parameters) state.parameters.push_back(each.name);
    state.posterior = posterior ? *posterior : fitted();
    tracker = track_units(state);
  }

  std::shared_ptr<const FormulaRows> rows() const {
    return std::make_shared<const FormulaRows>(design.model, design.model->data.table.rows);
  }
  WeightedDraws fitted() const { return exact_posterior(rows(), 1e-4).nodes; }
};

// What a fit says of its units, and of a new one; of `shares` of all units, too.
inline LimitedLives lives_of_fit(const Watched& watched, const WeightedDraws& posterior,
                                 bool of_new_unit = false, double share_of_points = 1,
                                 const std::vector<double>& shares = {}) {
  const TomlReader predict = watched.design.root.required_table("predict");
  const auto rows = watched.rows();
  const Asked asked(predict, watched.design.model, rows);
  const TomlReader limits = predict.required_table("limit");
  const std::string name = limits.keys().front();
  std::vector<formula::Wanted> wanted = {{"limit", name}};
  ProcessLimit limit;
  const bool process = watched.design.model->has_process();
  if (process) {
    const auto& family_parameters = watched.design.model->measured[0].wanted;
    wanted.assign(family_parameters.begin(), family_parameters.begin() + 2);
  }
  LimitedPath& path = limit.path;
  path.next = make_path(asked.model, limits, name, wanted, true, asked.common);
  set_reach(asked, path);
  path.limit = watched.tracker->limit().si();
  for (std::size_t u = 0; u < watched.design.model->units.size(); ++u) {
    path.seen.push_back(seen_unit(asked, limits, name, wanted, u));
    if (process) path.seen.back().behind.reset();
  }
  if (!of_new_unit) path.next.reset();
  path.shares = shares;
  path.survived = path.begin;
  if (process) return process_lives(*rows, limit, posterior, share_of_points);
  return limited_lives(*rows, path, posterior, share_of_points);
}

// The path ahead of the same nodes crosses the limit where lives end: of paths that only rise (or fall). Where
// increments go both ways it has been there before.
inline void expect_path_ahead(const prognosis::Tracker& tracker, const prognosis::TrackedUnit& unit,
                              bool both_ways, double tolerance = 0.03) {
  const prognosis::Forecast forecast = unit.forecast();
  const double limit = tracker.limit().si(), sign = tracker.rising() ? 1 : -1;
  for (const double share : {0.05, 0.5, 0.95}) {
    const double p = (share - forecast.passed) / (1 - forecast.passed);
    if (!(p > 0.01) || forecast.remaining.points().empty()) continue;
    const double life = forecast.remaining.quantile(p);
    if (!std::isfinite(life)) continue;
    const double place[] = {forecast.now + life};
    const prognosis::ForecastBand at = unit.ahead(place).front();
    const double level = share == 0.5                  ? at.level50
                         : (share < 0.5) == (sign > 0) ? at.level95
                                                       : at.level05;
    const double width = at.level95 - at.level05;
    EXPECT_GT(width, 0);
    if (both_ways) {
      EXPECT_LT(sign * (level - limit), tolerance * width) << share;
    } else {
      EXPECT_NEAR(level, limit, tolerance * width) << share;
    }
  }
  const std::vector<double> places = prognosis::places_ahead(forecast);
  if (places.empty()) return;
  EXPECT_EQ(places.front(), forecast.now);
  const std::vector<prognosis::ForecastBand> path = unit.ahead(places);
  ASSERT_EQ(path.size(), places.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_EQ(path[i].at, places[i]);
    EXPECT_LE(path[i].level05, path[i].level50);
    EXPECT_LE(path[i].level50, path[i].level95);
    if (i == 0) continue;
    EXPECT_GT(places[i], places[i - 1]);
    const double slack = 1e-3 * (path[i].level95 - path[i].level05);
    EXPECT_GE(sign * (path[i].level50 - path[i - 1].level50), -slack) << i;
    const double behind =
        sign > 0 ? path[i].level95 - path[i - 1].level95 : path[i - 1].level05 - path[i].level05;
    EXPECT_GE(behind, -slack) << i;
  }
  const double wide = std::max(forecast.level95 - forecast.level05, 1e-9 * std::abs(limit));
  EXPECT_NEAR(path.front().level05, forecast.level05, 1e-6 * wide);
  EXPECT_NEAR(path.front().level50, forecast.level50, 1e-6 * wide);
  EXPECT_NEAR(path.front().level95, forecast.level95, 1e-6 * wide);
}

// Populations, mixed by their weights and what the unit showed in each, are the forecast.
inline void expect_populations(const prognosis::Tracker& tracker, const FollowedUnit& followed,
                               double tolerance) {
  const auto apart = followed.unit->in_populations(
      [&](const std::function<void(const prognosis::Reading&)>& visit) {
        for (const prognosis::Reading& each : followed.taken) visit(each);
      });
  if (!apart) {  // by its readings it has left the populations behind that all have in common
    EXPECT_FALSE(followed.taken.empty());
    return;
  }
  const std::vector<double> weight = tracker.populations();
  ASSERT_EQ(apart->log_likelihood.size(), weight.size());
  ASSERT_EQ(apart->passed.size(), weight.size());
  ASSERT_EQ(apart->remaining.size(), weight.size());
  const prognosis::Forecast forecast = followed.unit->forecast();
  const double top = *std::max_element(apart->log_likelihood.begin(), apart->log_likelihood.end());
  for (const double p : {0.0, 0.05, 0.25, 0.5, 0.75, 0.95}) {
    const double after = p > 0 ? forecast.remaining.quantile(p) : 0;
    if (!std::isfinite(after)) continue;
    double sum = 0, mass = 0;
    for (std::size_t k = 0; k < weight.size(); ++k) {
      const double share = weight[k] * std::exp(apart->log_likelihood[k] - top);
      if (!(share > 0)) continue;
      mass += share;
      sum += share * (apart->passed[k] + (1 - apart->passed[k]) * apart->remaining[k].cdf(after));
    }
    const double expected = forecast.passed + (1 - forecast.passed) * forecast.remaining.cdf(after);
    EXPECT_NEAR(sum / mass, expected, tolerance) << "at " << p;
  }
}

// Where the fit's quantiles lie in the forecast.
inline void expect_alike(const prognosis::Forecast& forecast, const CellMixture& fit, double passed,
                         double tolerance) {
  EXPECT_NEAR(forecast.passed, passed, tolerance);
  if (passed > 0.95) return;
  for (const double p : {0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99}) {
    const double life = fit.quantile(p);
    if (std::isfinite(life)) {
      EXPECT_NEAR(forecast.remaining.cdf(life), p, tolerance) << p;
    }
  }
}

}  // namespace wearwell::formula_model
