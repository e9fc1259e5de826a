#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/mode.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_start.h"

namespace wearwell {

/// The place of each true parameter in its marginal posterior, 0 to 1; NaN without a posterior by quadrature.
inline std::vector<double> places_of(const std::vector<double>& truth,
                                     const ExactPosterior& exact) {
  std::vector<double> places;
  for (std::size_t p = 0; p < truth.size(); ++p)
    places.push_back(
        exact.failure.empty()
            ? QuantityDistribution(exact.nodes, [p](const double* x) { return x[p]; }).cdf(truth[p])
            : NAN);
  return places;
}

/// The same as a study has it: its search for starts, then quadrature; draws of its fit where quadrature fails.
inline std::vector<double> places_of_study(
    const std::vector<double>& truth, const std::shared_ptr<const formula_model::FormulaRows>& rows,
    std::uint64_t seed) {
  const auto likelihood = formula_model::formula_likelihood(rows);
  std::vector<Parameter> parameters = rows->model().parameters;
  formula_model::find_starts(*likelihood, parameters);
  const Posterior posterior(parameters, likelihood);
  ExactSettings settings;
  settings.tolerance = 1e-3;
  settings.second_moments = false;
  const ExactPosterior exact =
      integrate(posterior, whitening_at(find_mode(posterior, posterior.start())), settings);
  if (exact.failure.empty()) return places_of(truth, exact);
  FitSettings by_draws;
  by_draws.method = Method::nuts;
  by_draws.run = {4, 1000, 1000, seed, 1};
  by_draws.extend = true;
  const Fit fitted = fit(posterior, by_draws);
  std::vector<double> places;
  for (std::size_t p = 0; p < truth.size(); ++p)
    places.push_back(mixed(fitted) ? fitted.marginals[p].cdf(truth[p]) : NAN);
  return places;
}

/// Prints and tests that places are even between 0 and 1, by Pearson's chi-squared over bins. A right posterior fails one time in a
/// thousand for each parameter, and seeds are fixed.
inline void expect_even(const std::string& name, const std::vector<Parameter>& parameters,
                        const std::vector<std::vector<double>>& all, int bins) {
  const auto count = static_cast<double>(all.size());
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    std::vector<double> bin(static_cast<std::size_t>(bins));
    int without = 0;
    for (const std::vector<double>& places : all) {
      if (std::isnan(places[p])) {
        ++without;
      } else {
        bin[static_cast<std::size_t>(std::min(bins - 1, static_cast<int>(bins * places[p])))] += 1;
      }
    }
    EXPECT_EQ(without, 0) << name << ": replications without a posterior";
    double chi_squared = 0;
    for (const double n : bin) chi_squared += std::pow(n - count / bins, 2) / (count / bins);
    const double p_value = cdf(complement(boost::math::chi_squared(bins - 1), chi_squared));
    std::printf("%s, %s: %.0f replications, chi-squared %.1f, p %.3f\n", name.c_str(),
                parameters[p].name.c_str(), count, chi_squared, p_value);
    EXPECT_GT(p_value, 1e-3) << name << ", " << parameters[p].name;
  }
  std::fflush(stdout);
}

}  // namespace wearwell
