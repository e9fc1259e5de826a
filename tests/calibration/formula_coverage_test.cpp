// How often 90 % intervals of the remaining useful life of a new unit hold the truth, where units differ: straight
// paths y = b t, 5 readings of each unit of a population and 3 of the new one. Beside it two ways that plug
// estimates of the population in. The truth is drawn from the priors, where the share is 90 % by the laws of
// probability if all is right, or held fixed, where nothing promises it. WEARWELL_REPLICATIONS says how many.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "calibration/formula_design.h"
#include "wearwell/base/rng.h"
#include "wearwell/math/minimizer.h"
#include "wearwell/models/formula_model/formula_lives.h"

namespace wearwell::formula_model {
namespace {

constexpr double um = 1e-6, h = 3600, limit = 12 * um, now = 3 * h;

// The new unit comes first.
struct Design {
  std::vector<double> time;
  std::vector<std::size_t> unit;
  FormulaDesign own;
  LimitedPath path;

  explicit Design(std::size_t population) : own(make(population)) {
    for (std::size_t u = 0; u <= population; ++u) {
      for (int i = 1; i <= (u == 0 ? 3 : 5); ++i) {
        time.push_back(i * h);
        unit.push_back(u);
      }
    }
    path.limit = limit;
    path.scale = 5 * h;
    LimitedPath::SeenUnit seen;
    seen.ahead = make_path(own.law, own.root.required_table("predict").required_table("limit"),
                           "wear", {{"limit", "wear"}}, true, {});
    seen.now = now;
    path.seen.push_back(seen);
  }

  static FormulaDesign make(std::size_t population) {
    std::vector<double> depth, time;
    std::vector<std::string> unit;
    for (std::size_t u = 0; u <= population; ++u) {
      for (int i = 1; i <= (u == 0 ? 3 : 5); ++i) {
        depth.push_back(i);
        time.push_back(i);
        unit.push_back("u" + std::to_string(u));
      }
    }
    return {straight, {numbers("depth", depth), numbers("time", time), texts("unit", unit)}};
  }
};

// One point as a posterior: what plugging in takes it for.
WeightedDraws point(const std::vector<double>& x) {
  WeightedDraws one;
  one.values.resize(1, 3);
  for (int i = 0; i < 3; ++i) one.values(0, i) = x[static_cast<std::size_t>(i)];
  one.weights = Eigen::VectorXd::Ones(1);
  return one;
}

// Slopes by least squares of the units of the population, mean and standard deviation of their
// logarithms, the scatter of readings about all lines.
std::vector<double> moments(const Design& design, const std::vector<double>& y, std::size_t units) {
  std::vector<double> ty(units + 1, 0), tt(units + 1, 0), log_b;
  for (std::size_t i = 0; i < y.size(); ++i) {
    ty[design.unit[i]] += design.time[i] * y[i];
    tt[design.unit[i]] += design.time[i] * design.time[i];
  }
  double rss = 0, mean = 0, square = 0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const std::size_t u = design.unit[i];
    rss += std::pow(y[i] - ty[u] / tt[u] * design.time[i], 2);
  }
  const auto n = static_cast<double>(units);
  for (std::size_t u = 1; u <= units; ++u) {
    log_b.push_back(std::log(std::max(ty[u] / tt[u], 0.01 * um / h)));
    mean += log_b.back() / n;
  }
  for (const double each : log_b) square += (each - mean) * (each - mean) / (n - 1);
  return {std::exp(mean), std::sqrt(square),
          std::sqrt(rss / (static_cast<double>(y.size()) - n - 1))};
}

// Maximum likelihood of the population, from the moments and from one that hardly differs.
std::vector<double> most_likely(const LogDensity& likelihood, const std::vector<double>& guess) {
  std::vector<double> best;
  double highest = -INFINITY;
  for (const double share : {1.0, 0.1}) {
    Eigen::VectorXd start(3);
    for (int i = 0; i < 3; ++i) {
      start[i] =
          std::log(std::max(guess[static_cast<std::size_t>(i)], 1e-9) * (i == 1 ? share : 1));
    }
    const Minimum found = minimize(
        [&](std::span<const double> z, std::span<double> gradient) {
          std::vector<double> x(3), by_x(3);
          for (std::size_t i = 0; i < 3; ++i) x[i] = std::exp(z[i]);
          if (x[1] < 1e-4 || x[1] > 20) return static_cast<double>(INFINITY);
          const double value = likelihood.value_and_gradient(x, by_x);
          for (std::size_t i = 0; i < gradient.size(); ++i) gradient[i] = -by_x[i] * x[i];
          return -value;
        },
        start);
    if (!(-found.value > highest)) continue;
    highest = -found.value;
    best = {std::exp(found.position[0]), std::exp(found.position[1]), std::exp(found.position[2])};
  }
  return best.empty() ? guess : best;
}

// Where the truth lies in what is said of the remaining useful life: P(remaining useful life <= truth).
struct Places {
  double exact = NAN, likely = NAN, moments = NAN;
};

Places replicate(const Design& design, std::size_t units, const std::vector<double>& fixed,
                 std::uint64_t stream) {
  Rng rng(20261122, stream);
  std::vector<double> x, y, rate;
  do {  // a unit that has reached the limit has no remaining useful life
    x = fixed.empty() ? design.own.from_priors(rng) : fixed;
    rate.clear();
    for (std::size_t u = 0; u <= units; ++u) rate.push_back(x[0] * std::exp(x[1] * rng.normal()));
  } while (rate[0] * now >= limit);
  std::vector<Response> responses;
  for (std::size_t i = 0; i < design.time.size(); ++i) {
    y.push_back(rate[design.unit[i]] * design.time[i] + x[2] * rng.normal());
    responses.push_back({.at = y.back()});
  }
  const auto rows =
      std::make_shared<const FormulaRows>(design.own.with(responses), design.time.size());
  const double truth = limit / rate[0] - now;
  const auto place = [&](const WeightedDraws& draws) {
    return limited_lives(*rows, design.path, draws).remaining.front().cdf(truth);
  };
  Places places;
  const ExactPosterior exact = exact_posterior(rows, 3e-3);
  if (exact.failure.empty()) places.exact = place(exact.nodes);
  const std::vector<double> guess = moments(design, y, units);
  places.moments = place(point(guess));
  places.likely = place(point(most_likely(*formula_likelihood(rows), guess)));
  return places;
}

struct Coverage {
  double share = 0, below = 0, above = 0;  // of intervals that hold the truth, or lie beyond it
  double chi_squared = 0;                  // of 20 bins
};

Coverage coverage(const std::vector<Places>& all, double Places::*way) {
  Coverage result;
  double bin[20] = {}, n = 0;
  for (const Places& each : all) {
    const double p = each.*way;
    if (std::isnan(p)) continue;
    ++n;
    (p < 0.05 ? result.above : p > 0.95 ? result.below : result.share) += 1;
    bin[std::min(19, static_cast<int>(20 * p))] += 1;
  }
  for (double* each : {&result.share, &result.below, &result.above}) *each /= n;
  for (const double each : bin) result.chi_squared += std::pow(each - n / 20, 2) / (n / 20);
  return result;
}

// Fewer where each takes longer.
int replications(std::size_t units, int otherwise) {
  const char* wanted = std::getenv("WEARWELL_REPLICATIONS");
  const int most = wanted ? std::max(20, std::atoi(wanted)) : otherwise;
  return units > 8 ? most * 2 / 5 : most;
}

struct Outcome {
  Coverage exact, likely, moments;
  double standard_error;
};

Outcome simulate(const char* name, std::size_t units, const std::vector<double>& fixed, int count) {
  const Design design(units);
  std::vector<Places> all(static_cast<std::size_t>(count));
  tbb::parallel_for(0, count, [&](int i) {
    all[static_cast<std::size_t>(i)] =
        replicate(design, units, fixed, static_cast<std::uint64_t>(i) * 64 + units);
  });
  int failed = 0;
  for (const Places& each : all) failed += std::isnan(each.exact);
  const Outcome outcome{coverage(all, &Places::exact), coverage(all, &Places::likely),
                        coverage(all, &Places::moments), std::sqrt(0.09 / count)};
  std::printf(
      "%s, %2zu units, %d replications: %.1f %% +- %.1f (too short %.1f, too long %.1f; "
      "chi-squared "
      "%.0f), maximum likelihood %.1f, moments %.1f; %d without quadrature\n",
      name, units, count, 100 * outcome.exact.share, 100 * outcome.standard_error,
      100 * outcome.exact.below, 100 * outcome.exact.above, outcome.exact.chi_squared,
      100 * outcome.likely.share, 100 * outcome.moments.share, failed);
  std::fflush(stdout);
  EXPECT_EQ(failed, 0);
  return outcome;
}

// WEARWELL_UNITS asks for one of them alone.
std::vector<std::size_t> sizes() {
  if (const char* one = std::getenv("WEARWELL_UNITS")) {
    return {static_cast<std::size_t>(std::max(2, std::atoi(one)))};
  }
  return {3, 4, 5, 8, 15, 30};
}

// Exact by the laws of probability: at any number of units.
TEST(FormulaCoverage, RemainingLivesOfTruthsFromThePriors) {
  for (const std::size_t units : sizes()) {
    const Outcome outcome = simulate("drawn", units, {}, replications(units, 150));
    EXPECT_NEAR(outcome.exact.share, 0.9, 3.5 * outcome.standard_error) << units;
    EXPECT_GT(cdf(complement(boost::math::chi_squared(19), outcome.exact.chi_squared)), 1e-3);
  }
}

// One truth, the same priors: readings of 0.3 um, rates that differ by 0.3.
TEST(FormulaCoverage, RemainingLivesWhereReadingsSayMuch) {
  for (const std::size_t units : sizes()) {
    const Outcome outcome =
        simulate("fine", units, {um / h, 0.3, 0.3 * um}, replications(units, 100));
    EXPECT_NEAR(outcome.exact.share, 0.9, 0.03 + 3 * outcome.standard_error) << units;
  }
}

// As much from the population as from the unit's own readings: 0.8 um, rates that differ by 0.2.
TEST(FormulaCoverage, RemainingLivesWhereReadingsAreNoisy) {
  for (const std::size_t units : sizes()) {
    const Outcome outcome =
        simulate("noisy", units, {um / h, 0.2, 0.8 * um}, replications(units, 100));
    EXPECT_NEAR(outcome.exact.share, 0.9, 0.03 + 3 * outcome.standard_error) << units;
    if (units <= 4) {
      EXPECT_LT(outcome.likely.share, outcome.exact.share);
    }
  }
}

}  // namespace
}  // namespace wearwell::formula_model
