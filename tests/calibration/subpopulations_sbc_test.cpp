// Simulation-based calibration (Talts et al. 2018) of subpopulations of lives: a limited failure population by quadrature, and a mixture of
// two Weibull subpopulations by the ranks among the draws of NUTS. Exact lives, lives between two looks, run-outs, late entries.
// The place of each true parameter in its posterior is even between 0 and 1. WEARWELL_REPLICATIONS says how many.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "calibration/formula_design.h"
#include "calibration/inspected_lives.h"
#include "calibration/places_of_truth.h"
#include "calibration/shares.h"
#include "wearwell/base/rng.h"
#include "wearwell/infer/run_chains.h"
#include "wearwell/models/formula_model/formula_start.h"
#include "wearwell/models/formula_model/subpopulation_order.h"

namespace wearwell::formula_model {
namespace {

constexpr int bins = 20;
constexpr std::size_t parts = 40;

double weibull_life(double scale, double shape, Rng& rng) {
  return scale * std::pow(-std::log(rng.uniform()), 1 / shape);
}

const std::string columns_of_lives = R"toml(
[data.columns]
life = { column = "life", unit = "1" }
)toml";

TEST(SubpopulationsCalibration, LimitedFailurePopulation) {
  const FormulaDesign design(columns_of_lives + R"toml(
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
share_defective = "p"
[prior]
eta = { distribution = "lognormal", median = 300, log_sd = 0.5 }
beta = { distribution = "lognormal", median = 1.2, log_sd = 0.4 }
p = { distribution = "beta", alpha = 2, beta = 2 }
)toml",
                             {numbers("life", std::vector<double>(parts, 500))});
  std::vector<std::vector<double>> all(static_cast<std::size_t>(replications(400)));
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    Rng rng(20261126, i);
    const std::vector<double> x = design.from_priors(rng);
    const auto draw = [&] {
      return rng.uniform() < x[2] ? weibull_life(x[0], x[1], rng) : INFINITY;
    };
    const auto rows = std::make_shared<const FormulaRows>(
        design.with(inspected_lives(parts, draw, {500, 120, 60})), parts);
    const ExactPosterior exact = exact_posterior(rows, 1e-3);
    all[i] = places_of(x, exact);
  });
  expect_even("limited failure population", design.model->parameters, all, bins);
}

TEST(SubpopulationsCalibration, TwoWeibullSubpopulations) {
  const FormulaDesign design(columns_of_lives + R"toml(
[subpopulations]
names = ["early", "late"]
share = { early = "w" }
[likelihood.life]
family = "weibull"
scale = "eta[subpopulation]"
shape = "beta[subpopulation]"
[prior]
eta = { distribution = "lognormal", median = 300, log_sd = 1 }
beta = { distribution = "lognormal", median = 2, log_sd = 0.4 }
w = { distribution = "beta", alpha = 2, beta = 3 }
)toml",
                             {numbers("life", std::vector<double>(parts, 500))});
  ASSERT_TRUE(design.model->subpopulations->exchangeable);
  std::vector<std::vector<double>> all(static_cast<std::size_t>(replications(400)));
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    Rng rng(20261126, 2 * i);
    std::vector<double> x = design.from_priors(rng);
    // Names are given with the odds of their order.
    if (rng.uniform() > std::exp(SubpopulationOrder(*design.model).value(x))) {
      std::swap(x[0], x[1]);
      std::swap(x[2], x[3]);
    }
    const auto draw = [&] {
      const bool early = rng.uniform() < x[4];
      return weibull_life(x[early ? 0 : 1], x[early ? 2 : 3], rng);
    };
    const auto rows = std::make_shared<const FormulaRows>(
        design.with(inspected_lives(parts, draw, {1500, 150, 100})), parts);
    const auto likelihood = formula_likelihood(rows);
    std::vector<Parameter> parameters = design.model->parameters;
    find_starts(*likelihood, parameters);
    const Posterior posterior(parameters, likelihood);
    const Whitening whitening = whitening_at(find_mode(posterior, posterior.start()));
    constexpr int draws = 1980, thin = 20;  // 99 ranks and one more: five fall into each bin
    NutsSettings careful;
    careful.target_accept = 0.95;
    const Draws chains =
        run_nuts(posterior, whitening, careful, {1, 1000, draws, 20261126, 2 * i + 1});
    for (std::size_t p = 0; p < x.size(); ++p) {
      int rank = 0;
      for (int k = 0; k < draws; k += thin)
        rank += chains[0].values(k, static_cast<Eigen::Index>(p)) < x[p];
      all[i].push_back((rank + 0.5) / (draws / thin + 1));
    }
  });
  expect_even("two Weibull subpopulations", design.model->parameters, all, bins);
}

}  // namespace
}  // namespace wearwell::formula_model
