// Simulation-based calibration (Talts et al. 2018) of lives in use with unknown uses: of failures the use is known, of most
// survivors the age alone. The place of each true parameter in its posterior is even between 0 and 1.
// WEARWELL_REPLICATIONS says how many.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "calibration/formula_design.h"
#include "calibration/places_of_truth.h"
#include "calibration/shares.h"
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
  std::vector<std::vector<double>> all(static_cast<std::size_t>(replications(200)));
  Rng first(20261126, 1u << 30);
  const FormulaDesign any = fleet_at({100, 1.5, 2 / 3600.0}, first);
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    Rng rng(20261126, i);
    const std::vector<double> x = any.from_priors(rng);
    const FormulaDesign design = fleet_at(x, rng);
    const auto rows = std::make_shared<const FormulaRows>(design.model, units);
    all[i] = places_of(x, exact_posterior(rows, 1e-3));
  });
  expect_even("lives in use", any.model->parameters, all, 10);
}

}  // namespace
}  // namespace wearwell::formula_model
