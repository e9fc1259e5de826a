// Simulation-based calibration (Talts et al. 2018) of lives in use with unknown uses: of failures the use is known, of most
// survivors the age alone. The place of each true parameter in its posterior is even between 0 and 1.
// WEARWELL_REPLICATIONS says how many.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "calibration/formula_design.h"
#include "wearwell/base/rng.h"

namespace wearwell::formula_model {
namespace {

const std::string study_of_rates = R"toml(
[data.columns]
use = { column = "use", unit = "1" }
age = { column = "age", unit = "h" }
status = "status"
[likelihood.use]
family = "weibull"
scale = "eta"
shape = "beta"
[use_rate]
age = "age"
family = "lognormal"
median = "rate"
log_sd = 0.6
[prior]
eta = { distribution = "lognormal", median = 100, log_sd = 0.5 }
beta = { distribution = "lognormal", median = 1.5, log_sd = 0.3 }
rate = { distribution = "lognormal", median = "2 h^-1", log_sd = 0.5 }
)toml";

constexpr std::size_t units = 24;

// One fleet at the parameters; its age is that of the day.
FormulaDesign fleet_at(const std::vector<double>& x, Rng& rng) {
  std::vector<double> use, age;
  std::vector<std::string> status;
  for (std::size_t i = 0; i < units; ++i) {
    const double life = x[0] * std::pow(-std::log(rng.uniform()), 1 / x[1]),
                 rate = 3600 * x[2] * std::exp(0.6 * rng.normal()), now = 60 * rng.uniform();
    const bool failed = life < rate * now;
    age.push_back(failed ? life / rate : now);
    // One unit in four is looked at, whatever its state.
    use.push_back(failed ? life : i % 4 == 0 ? rate * now : NAN);
    status.push_back(failed ? "failed" : "running");
  }
  return {study_of_rates, {numbers("use", use), numbers("age", age), texts("status", status)}};
}

TEST(UseRateCalibration, PlacesOfTruthAreEven) {
  constexpr int bins = 10;
  const char* wanted = std::getenv("WEARWELL_REPLICATIONS");
  std::vector<std::vector<double>> all(
      static_cast<std::size_t>(wanted ? std::max(100, std::atoi(wanted)) : 200));
  Rng first(20261126, 1u << 30);
  const FormulaDesign any = fleet_at({100, 1.5, 2 / 3600.0}, first);
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    Rng rng(20261126, i);
    const std::vector<double> x = any.from_priors(rng);
    const FormulaDesign design = fleet_at(x, rng);
    const auto rows = std::make_shared<const FormulaRows>(design.model, units);
    const ExactPosterior exact = exact_posterior(rows, 1e-3);
    for (std::size_t p = 0; p < x.size(); ++p)
      all[i].push_back(
          exact.failure.empty()
              ? QuantityDistribution(exact.nodes, [p](const double* at) { return at[p]; }).cdf(x[p])
              : NAN);
  });
  for (std::size_t p = 0; p < any.model->parameters.size(); ++p) {
    double bin[bins] = {}, chi_squared = 0;
    for (const auto& places : all) {
      ASSERT_FALSE(std::isnan(places[p]));
      bin[std::min(bins - 1, static_cast<int>(bins * places[p]))] += 1;
    }
    const double expected = static_cast<double>(all.size()) / bins;
    for (const double n : bin) chi_squared += std::pow(n - expected, 2) / expected;
    const double p_value = cdf(complement(boost::math::chi_squared(bins - 1), chi_squared));
    std::printf("%s: %zu replications, chi-squared %.1f, p %.3f\n",
                any.model->parameters[p].name.c_str(), all.size(), chi_squared, p_value);
    EXPECT_GT(p_value, 1e-3) << p;
  }
}

}  // namespace
}  // namespace wearwell::formula_model
