// Simulation-based calibration (Talts et al. 2018) of five laws written as users write them, two of them with
// units that differ: parameters from the priors, observations from the parameters (written out here, not by
// the expressions), and then the place of each true parameter in its posterior, which is even between 0
// and 1. By quadrature, and of three by the ranks among the draws of NUTS as well.
// WEARWELL_REPLICATIONS says how many.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "calibration/formula_design.h"
#include "wearwell/base/rng.h"
#include "wearwell/infer/run_chains.h"

namespace wearwell::formula_model {
namespace {

constexpr int bins = 20;

double weibull(double scale, double shape, Rng& rng) {
  return scale * std::pow(-std::log(rng.uniform()), 1 / shape);
}

// Observations, row by row, of parameters in the order of the priors.
using Simulate = std::vector<Response> (*)(const FormulaModel& model, const std::vector<double>& x,
                                           Rng& rng);

double number(const FormulaModel& model, const char* name, std::size_t row) {
  return model.data.number(name)->values[row];
}

// The places of the truth: by quadrature, then by NUTS.
std::vector<double> replicate(const FormulaDesign& design, Simulate simulate, bool sample,
                              std::uint64_t stream) {
  Rng rng(20261122, 2 * stream);
  const std::vector<double> truth = design.from_priors(rng);
  const auto rows = std::make_shared<const FormulaRows>(
      design.with(simulate(*design.model, truth, rng)), design.model->data.table.rows);
  const Posterior posterior(design.model->parameters, formula_likelihood(rows));
  const Whitening whitening = whitening_at(find_mode(posterior, posterior.start()));
  ExactSettings settings;
  settings.tolerance = 1e-3;
  settings.second_moments = false;
  const ExactPosterior exact = integrate(posterior, whitening, settings);
  std::vector<double> places;
  for (std::size_t p = 0; p < truth.size(); ++p) {
    places.push_back(
        exact.failure.empty()
            ? QuantityDistribution(exact.nodes, [&](const double* x) { return x[p]; }).cdf(truth[p])
            : NAN);
  }
  if (!sample) return places;
  constexpr int draws = 990, thin = 10;  // 99 ranks and one more: five fall into each bin
  NutsSettings careful;
  careful.target_accept = 0.95;
  const Draws chains =
      run_nuts(posterior, whitening, careful, {1, 500, draws, 20261122, 2 * stream + 1});
  for (std::size_t p = 0; p < truth.size(); ++p) {
    int rank = 0;
    for (int i = 0; i < draws; i += thin) {
      rank += chains[0].values(i, static_cast<Eigen::Index>(p)) < truth[p];
    }
    places.push_back((rank + 0.5) / (draws / thin + 1));
  }
  return places;
}

void calibrate(const char* name, const FormulaDesign& design, Simulate simulate, bool sample,
               int otherwise) {
  const char* wanted = std::getenv("WEARWELL_REPLICATIONS");
  const int count = wanted ? std::max(100, std::atoi(wanted)) : otherwise;
  std::vector<std::vector<double>> all(static_cast<std::size_t>(count));
  tbb::parallel_for(0, count, [&](int i) {
    all[static_cast<std::size_t>(i)] =
        replicate(design, simulate, sample, static_cast<std::uint64_t>(i));
  });
  const std::size_t parameters = design.model->parameters.size();
  for (std::size_t p = 0; p < all.front().size(); ++p) {
    double bin[bins] = {}, n = 0, chi_squared = 0;
    for (const auto& places : all) {
      if (std::isnan(places[p])) continue;
      ++n;
      bin[std::min(bins - 1, static_cast<int>(bins * places[p]))] += 1;
    }
    for (const double each : bin) chi_squared += std::pow(each - n / bins, 2) / (n / bins);
    const double p_value = cdf(complement(boost::math::chi_squared(bins - 1), chi_squared));
    std::printf("%s, %s by %s: %.0f of %d replications, chi-squared %.1f, p %.3f\n", name,
                design.model->parameters[p % parameters].name.c_str(),
                p < parameters ? "quadrature" : "NUTS", n, count, chi_squared, p_value);
    EXPECT_GT(p_value, 1e-3) << name << " " << p;
    EXPECT_EQ(n, count) << name;
  }
  std::fflush(stdout);
}

// Weibull lives that fall with stress by a power, stopped after 1000 h.
TEST(FormulaCalibration, WeibullLivesWithRunouts) {
  std::vector<double> stress;
  std::vector<std::string> status;
  for (const double level : {100., 140., 200.}) {
    for (int i = 0; i < 5; ++i) {
      stress.push_back(level);
      status.emplace_back(i < 2 ? "runout" : "failure");
    }
  }
  const FormulaDesign design(R"toml(
[data.columns]
life = { column = "life", unit = "h" }
stress = { column = "stress", unit = "MPa" }
status = "status"
[likelihood.life]
family = "weibull"
scale = "eta * (stress/140 [MPa])^-n"
shape = "beta"
[prior]
eta = { distribution = "lognormal", median = "600 h", log_sd = 0.5 }
n = { distribution = "normal", mean = 3, sd = 1 }
beta = { distribution = "lognormal", median = 2, log_sd = 0.4 }
)toml",
                             {numbers("life", std::vector<double>(15, 500)),
                              numbers("stress", stress), texts("status", status)});
  const Simulate simulate = [](const FormulaModel& model, const std::vector<double>& x, Rng& rng) {
    std::vector<Response> all;
    for (std::size_t i = 0; i < 15; ++i) {
      constexpr double longest = 1000 * 3600.;
      const double life =
          weibull(x[0] * std::pow(number(model, "stress", i) / 140e6, -x[1]), x[2], rng);
      all.push_back({.seen = life > longest ? Censoring::right : Censoring::none,
                     .at = std::min(life, longest)});
    }
    return all;
  };
  calibrate("Weibull, run-outs", design, simulate, true, 400);
}

// Lognormal lives by Arrhenius' law, known to the interval between two looks.
TEST(FormulaCalibration, LognormalLivesBetweenInspections) {
  std::vector<double> temperature, lower(18, 100), upper(18, 200);
  for (std::size_t i = 0; i < 18; ++i) temperature.push_back(i < 6 ? 60 : i < 12 ? 80 : 100);
  const FormulaDesign design(
      R"toml(
[data.columns]
lower = { column = "lower", unit = "h" }
upper = { column = "upper", unit = "h" }
temperature = { column = "temperature", unit = "degC" }
[constants]
boltzmann = "8.617333262e-5 eV/K"
[formula]
median = "life_80 * exp(energy/boltzmann * (1/temperature - 1/353.15 [K]))"
[likelihood.life]
family = "lognormal"
median = "median"
log_sd = "s"
[prior]
life_80 = { distribution = "lognormal", median = "500 h", log_sd = 1 }
energy = { distribution = "normal", mean = "0.7 eV", sd = "0.2 eV" }
s = { distribution = "half-normal", scale = 0.8 }
)toml",
      {numbers("lower", lower), numbers("upper", upper), numbers("temperature", temperature)});
  const Simulate simulate = [](const FormulaModel& model, const std::vector<double>& x, Rng& rng) {
    std::vector<Response> all;
    for (std::size_t i = 0; i < 18; ++i) {
      constexpr double look = 200 * 3600.;  // every 200 h, up to 2000 h
      const double k = 1.380649e-23;
      const double median =
          x[0] * std::exp(x[1] / k * (1 / number(model, "temperature", i) - 1 / 353.15));
      const double life = median * std::exp(x[2] * rng.normal());
      const double before = look * std::floor(life / look);
      if (before >= 10 * look) {
        all.push_back({.seen = Censoring::right, .at = 10 * look});
      } else if (before > 0) {
        all.push_back({.seen = Censoring::interval, .at = before, .until = before + look});
      } else {
        all.push_back({.seen = Censoring::left, .at = look});
      }
    }
    return all;
  };
  calibrate("lognormal, inspected", design, simulate, true, 400);
}

// Failures out of trials at five loads.
TEST(FormulaCalibration, BinomialGoNoGo) {
  const FormulaDesign design(
      R"toml(
[data.columns]
failed = "failed"
trials = "trials"
load = { column = "load", unit = "kN" }
[likelihood.failed]
family = "binomial"
probability = "1 / (1 + exp((strength - load)/width))"
trials = "trials"
[prior]
strength = { distribution = "normal", mean = "10 kN", sd = "2 kN" }
width = { distribution = "lognormal", median = "1 kN", log_sd = 0.5 }
)toml",
      {numbers("failed", {0, 1, 2, 3, 4}), numbers("trials", {6, 6, 6, 6, 6}),
       numbers("load", {7, 8.5, 10, 11.5, 13})});
  const Simulate simulate = [](const FormulaModel& model, const std::vector<double>& x, Rng& rng) {
    std::vector<Response> all;
    for (std::size_t i = 0; i < 5; ++i) {
      const double p = 1 / (1 + std::exp((x[0] - number(model, "load", i)) / x[1]));
      double failed = 0;
      for (int k = 0; k < 6; ++k) failed += rng.uniform() < p;
      all.push_back({.at = failed, .trials = 6});
    }
    return all;
  };
  calibrate("binomial", design, simulate, true, 400);
}

// Counts of failures of machines whose rates differ: effects by the general rule.
TEST(FormulaCalibration, PoissonCountsOfMachinesThatDiffer) {
  std::vector<double> count, hours;
  std::vector<std::string> machine;
  for (int m = 0; m < 6; ++m) {
    for (int i = 0; i < 2; ++i) {
      count.push_back(2);
      hours.push_back(100 * (i + 1));
      machine.push_back("m" + std::to_string(m));
    }
  }
  const FormulaDesign design(
      R"toml(
[data.columns]
failures = "failures"
hours = { column = "hours", unit = "h" }
machine = "machine"
[likelihood.failures]
family = "poisson"
mean = "rate * hours"
[prior]
rate = { distribution = "lognormal", median = "0.02 1/h", log_sd = 0.7 }
scatter = { distribution = "half-normal", scale = 0.8 }
[random_effects.machine]
rate = { distribution = "lognormal", log_sd = "scatter" }
)toml",
      {numbers("failures", count), numbers("hours", hours), texts("machine", machine)});
  const Simulate simulate = [](const FormulaModel& model, const std::vector<double>& x, Rng& rng) {
    std::vector<Response> all;
    double rate = 0;
    for (std::size_t i = 0; i < 12; ++i) {
      if (i % 2 == 0) rate = x[0] * std::exp(x[1] * rng.normal());
      const double mean = rate * number(model, "hours", i);
      double arrived = 0;  // until the time is over
      for (double t = -std::log(rng.uniform()); t < mean; t -= std::log(rng.uniform())) ++arrived;
      all.push_back({.at = arrived});
    }
    return all;
  };
  calibrate("Poisson, machines", design, simulate, false, 100);
}

// Straight paths of machines whose rates differ, readings with noise: each unit is a parabola.
TEST(FormulaCalibration, NormalPathsOfMachinesThatDiffer) {
  std::vector<double> depth, time;
  std::vector<std::string> machine;
  for (int m = 0; m < 5; ++m) {
    for (int i = 1; i <= 3; ++i) {
      depth.push_back(i);
      time.push_back(i);
      machine.push_back("m" + std::to_string(m));
    }
  }
  const FormulaDesign design(
      R"toml(
[data.columns]
depth = { column = "depth", unit = "um" }
time = { column = "time", unit = "h" }
machine = "machine"
[likelihood.depth]
family = "normal"
mean = "b * time"
sd = "sigma"
[prior]
b = { distribution = "lognormal", median = "1 um/h", log_sd = 0.5 }
scatter = { distribution = "half-normal", scale = 0.5 }
sigma = { distribution = "half-normal", scale = "0.5 um" }
[random_effects.machine]
b = { distribution = "lognormal", log_sd = "scatter" }
)toml",
      {numbers("depth", depth), numbers("time", time), texts("machine", machine)});
  const Simulate simulate = [](const FormulaModel& model, const std::vector<double>& x, Rng& rng) {
    std::vector<Response> all;
    double rate = 0;
    for (std::size_t i = 0; i < 15; ++i) {
      if (i % 3 == 0) rate = x[0] * std::exp(x[1] * rng.normal());
      all.push_back({.at = rate * number(model, "time", i) + x[2] * rng.normal()});
    }
    return all;
  };
  calibrate("normal paths, machines", design, simulate, false, 300);
}

}  // namespace
}  // namespace wearwell::formula_model
