// Simulation-based calibration (Talts et al. 2018) of two competing failure modes: exact lives, lives known to an interval between two
// inspections, run-outs, late entries; known modes, and modes that are not known for a share of the failures. The place of each true
// parameter in its posterior by quadrature is even between 0 and 1. WEARWELL_REPLICATIONS says how many.
#include <fmt/format.h>
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

constexpr int bins = 20;
constexpr std::size_t parts = 24;

constexpr const char* study = R"toml(
[data.columns]
life = {{ column = "life", unit = "1" }}
mode = "mode"
[failure_modes]
column = "mode"
[likelihood.life]
family = "weibull"
scale = "eta[mode]"
shape = "{}"
[prior]
eta = {{ distribution = "lognormal", median = 600, log_sd = 0.5 }}
beta = {{ distribution = "lognormal", median = 1.5, log_sd = 0.4 }}
)toml";

// What is seen of the parts.
struct Observation {
  std::string name;
  bool own_shapes = false;   // of each mode
  bool inspections = false;  // of two of three parts; else lives are exact
  double unknown = 0;        // share of failures without a mode
};

double weibull(double scale, double shape, Rng& rng) {
  return scale * std::pow(-std::log(rng.uniform()), 1 / shape);
}

// Lives in the order of the rows, and the modes that may have ended each.
std::pair<Observed, std::vector<std::uint32_t>> simulate(const Observation& observation,
                                                         const std::vector<double>& x, Rng& rng) {
  Observed all;
  std::vector<std::uint32_t> possible;
  while (all.rows.size() < parts) {
    const std::size_t i = all.rows.size();
    const double entry = i % 4 == 3 ? 200 : -INFINITY;
    const double a = weibull(x[0], x[2], rng), b = weibull(x[1], x.back(), rng),
                 life = std::min(a, b);
    if (life <= entry) continue;  // it was never seen
    constexpr double longest = 900, apart = 250;
    Response y{.at = std::min(life, longest), .entry = entry};
    std::uint32_t modes = a < b ? 1 : 2;
    if (life > longest) {
      y.seen = Censoring::right;
      modes = 0;
    } else {
      if (rng.uniform() < observation.unknown) modes = 3;
      if (observation.inspections && i % 3 != 2) {
        const double before = apart * std::floor(life / apart);
        y.seen = before > 0 ? Censoring::interval : Censoring::left;
        y.at = before > 0 ? std::max(before, entry) : apart;
        y.until = before + apart;
        if (before <= 0 && entry > 0) {
          y.seen = Censoring::interval;
          y.at = entry;
        }
      }
    }
    all.rows.push_back(i);
    all.responses.push_back(y);
    all.counts.push_back(1);
    possible.push_back(modes);
  }
  return {all, possible};
}

std::vector<double> replicate(const FormulaDesign& design, const Observation& observation,
                              std::uint64_t stream) {
  Rng rng(20261125, stream);
  const std::vector<double> truth = design.from_priors(rng);
  auto changed = std::make_shared<FormulaModel>(*design.model);
  auto [lives, possible] = simulate(observation, truth, rng);
  changed->modes->possible = possible;
  changed->lives = lives;
  ObservedModes by_mode = observed_by_mode(*changed->modes, lives);
  for (std::size_t k = 0; k < 2; ++k) changed->measured[k].observed = std::move(by_mode.of[k]);
  changed->joint = std::move(by_mode.joint);
  const auto rows = std::make_shared<const FormulaRows>(changed, parts);
  const Posterior posterior(design.model->parameters, formula_likelihood(rows));
  ExactSettings settings;
  settings.tolerance = 1e-3;
  settings.second_moments = false;
  const ExactPosterior exact =
      integrate(posterior, whitening_at(find_mode(posterior, posterior.start())), settings);
  std::vector<double> places;
  for (std::size_t p = 0; p < truth.size(); ++p)
    places.push_back(
        exact.failure.empty()
            ? QuantityDistribution(exact.nodes, [p](const double* x) { return x[p]; }).cdf(truth[p])
            : NAN);
  return places;
}

void calibrate(const Observation& observation) {
  std::vector<std::string> modes(parts, "a");
  modes.back() = "b";
  const FormulaDesign design(
      fmt::format(study, observation.own_shapes ? "beta[mode]" : "beta"),
      {numbers("life", std::vector<double>(parts, 500)), texts("mode", modes)});
  const char* wanted = std::getenv("WEARWELL_REPLICATIONS");
  const int count = wanted ? std::max(100, std::atoi(wanted)) : 200;
  std::vector<std::vector<double>> all(static_cast<std::size_t>(count));
  tbb::parallel_for(0, count, [&](int i) {
    all[static_cast<std::size_t>(i)] =
        replicate(design, observation, static_cast<std::uint64_t>(i));
  });
  for (std::size_t p = 0; p < all.front().size(); ++p) {
    double bin[bins] = {}, chi_squared = 0;
    for (const auto& places : all) {
      ASSERT_FALSE(std::isnan(places[p]));
      bin[std::min(bins - 1, static_cast<int>(bins * places[p]))] += 1;
    }
    const double each = static_cast<double>(count) / bins;
    for (const double n : bin) chi_squared += (n - each) * (n - each) / each;
    const double p_value = cdf(complement(boost::math::chi_squared(bins - 1), chi_squared));
    std::printf("%s, %s: %d replications, chi-squared %.1f, p %.3f\n", observation.name.c_str(),
                design.model->parameters[p].name.c_str(), count, chi_squared, p_value);
    EXPECT_GT(p_value, 1e-3) << p;
  }
  std::fflush(stdout);
}

constexpr double third = 1 / 3.0;

TEST(FailureModesCalibration, MaskedAndIntervalLives) {
  calibrate({"modes of one shape, between inspections, a third unknown", false, true, third});
}

TEST(FailureModesCalibration, CompetingRisks) {
  calibrate({"two Weibull modes", true, false, 0});
}

TEST(FailureModesCalibration, MaskedModes) {
  calibrate({"two Weibull modes, 30 % unknown", true, false, 0.3});
}

}  // namespace
}  // namespace wearwell::formula_model
