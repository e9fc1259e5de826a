#include "wearwell/models/recurrence/projection.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "wearwell/base/gamma_variate.h"

namespace wearwell::recurrence {
namespace {

constexpr std::uint64_t seed_of_projection = 20261128;
constexpr std::size_t draws_of_projection = 40000;

// Sum of ln(end/age) over the ages.
double log_sum(const std::vector<double>& ages, double end) {
  double sum = 0;
  for (const double age : ages) sum += std::log(end / age);
  return sum;
}

std::vector<double> first_occurrences(const GrowthTest& test) {
  std::vector<double> ages;
  for (const FailureMode* each : test.of(FixClass::delayed)) ages.push_back(each->ages.front());
  return ages;
}

std::vector<double> ages_of(const GrowthTest& test, FixClass fix) {
  std::vector<double> ages;
  for (const FailureMode* each : test.of(fix))
    ages.insert(ages.end(), each->ages.begin(), each->ages.end());
  return ages;
}

// A gamma variate with this shape and rate between 0 and 1, kept off both ends by what no result shows.
double gamma_below_one(double shape, double rate, Rng& rng) {
  constexpr double end = 1e-9;
  const double u = rng.uniform(), most = boost::math::gamma_p(shape, rate);
  const double x = most > 1e-280 ? boost::math::gamma_p_inv(shape, u * most) / rate
                                 : std::pow(u, 1 / shape);  // exp(-rate x) is 1
  return std::clamp(x, end, 1 - end);
}

// What the draws need of the test.
struct Statistics {
  std::vector<const FailureMode*> delayed;
  double modes = 0, mode_logs = 0;           // of first occurrences
  double unfixed = 0;                        // failures of modes that are not fixed
  double fixed_during = 0, during_logs = 0;  // failures of modes fixed during the test
};

Statistics statistics_of(const GrowthTest& test) {
  Statistics found{test.of(FixClass::delayed)};
  found.modes = static_cast<double>(found.delayed.size());
  found.mode_logs = log_sum(first_occurrences(test), test.end);
  found.unfixed = static_cast<double>(test.failures(FixClass::none));
  const std::vector<double> during = ages_of(test, FixClass::during);
  found.fixed_during = static_cast<double>(during.size());
  found.during_logs = log_sum(during, test.end);
  return found;
}

// Rates are per time of the test. The rates of modes not yet seen have, given the expected number M of modes, a tempered
// stable sum with the Laplace transform exp(-M ((1 + s)^beta - 1)); over the gamma distribution of M that is the transform
// (1 + s)^(-m beta) of a gamma distribution.
void draw_projection(const Statistics& data, Rng& rng, std::size_t at, double time,
                     ProjectionDraws& draws) {
  const double beta = gamma_below_one(data.modes, data.mode_logs, rng);
  const double modes = gamma_variate(data.modes, rng);
  double seen = 0, remaining = 0, factors = 0;
  for (const FailureMode* mode : data.delayed) {
    const double rate = gamma_variate(static_cast<double>(mode->ages.size()) - beta, rng);
    const auto& all = mode->effectiveness;
    const double factor =
        all[static_cast<std::size_t>(rng.uniform() * static_cast<double>(all.size()))];
    seen += rate;
    remaining += (1 - factor) * rate;
    factors += factor / data.modes;
  }
  const double unseen = gamma_variate(data.modes * beta, rng);
  double others = data.unfixed > 0 ? gamma_variate(data.unfixed + 0.5, rng) : 0;
  if (data.fixed_during > 0)
    others += gamma_variate(data.fixed_during, rng) / data.during_logs *
              gamma_variate(data.fixed_during, rng);
  ProjectedIntensity& intensity = draws.intensity[at];
  intensity.demonstrated = (others + seen + unseen) / time;
  intensity.projected = (others + remaining + unseen) / time;
  intensity.potential = (others + remaining + (1 - factors) * unseen) / time;
  intensity.new_modes = modes * beta / time;
  draws.beta[at] = beta;
  draws.modes[at] = modes;
  draws.found[at] = seen / (seen + unseen);
}

}  // namespace

std::optional<CrowProjection> crow_projection(const GrowthTest& test) {
  const std::vector<double> firsts = first_occurrences(test);
  const double modes = static_cast<double>(firsts.size()), logs = log_sum(firsts, test.end),
               time = test.time();
  if (!(modes > 1 && logs > 0)) return {};
  CrowProjection crow;
  crow.beta = (modes - 1) / logs;
  double delayed = 0, remaining = 0;
  for (const FailureMode* each : test.of(FixClass::delayed)) {
    const double rate = static_cast<double>(each->ages.size()) / time;
    delayed += rate;
    remaining += (1 - each->mean_effectiveness()) * rate;
  }
  std::vector<double> all;
  for (const FixClass fix : {FixClass::none, FixClass::during, FixClass::delayed}) {
    const std::vector<double> ages = ages_of(test, fix);
    all.insert(all.end(), ages.begin(), ages.end());
  }
  const double failures = static_cast<double>(all.size());
  double demonstrated = failures / time;
  if (test.failures(FixClass::during) > 0) {
    const double all_logs = log_sum(all, test.end);
    if (!(all_logs > 0)) return {};
    demonstrated *= (failures - 1) / all_logs;
  }
  crow.intensity.demonstrated = demonstrated;
  crow.intensity.new_modes = modes * crow.beta / time;
  crow.intensity.potential = demonstrated - delayed + remaining;
  crow.intensity.projected =
      crow.intensity.potential + test.mean_effectiveness() * crow.intensity.new_modes;
  return crow;
}

double probability_of_rising_discovery(const GrowthTest& test) {
  const std::vector<double> firsts = first_occurrences(test);
  return boost::math::gamma_q(static_cast<double>(firsts.size()), log_sum(firsts, test.end));
}

ProjectionDraws projection_draws(const GrowthTest& test) {
  const Statistics data = statistics_of(test);
  ProjectionDraws draws;
  draws.intensity.resize(draws_of_projection);
  for (std::vector<double>* each : {&draws.beta, &draws.modes, &draws.found})
    each->resize(draws_of_projection);
  tbb::parallel_for(std::size_t{0}, draws_of_projection, [&](std::size_t s) {
    Rng rng(seed_of_projection, s);
    draw_projection(data, rng, s, test.time(), draws);
  });
  return draws;
}

}  // namespace wearwell::recurrence
