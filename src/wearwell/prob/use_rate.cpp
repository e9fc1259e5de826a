#include "wearwell/prob/use_rate.h"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <vector>

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

constexpr std::size_t per_family = most_response_parameters;

// A step of log r and what the integrand is there.
struct RateNode {
  double log_rate = 0, value = 0;  // the log integrand
  double slope[2 * per_family] = {};
};

// The sd of log X, seen from the upper half of its distribution, which is the narrower one of these families.
double log_width(ResponseFamily family, const double* parameters) {
  constexpr double p = 0.95, score = 1.6448536269514722;
  return std::log(quantile(family, p, parameters) / quantile(family, 0.5, parameters)) / score;
}

RateNode node_at(const LifeAtRate& unit, Response age, double log_rate, bool sloped) {
  const double rate = std::exp(log_rate);
  const bool exact = age.seen == Censoring::none;
  age.entry = -infinity;
  age.at *= rate;
  age.until *= rate;
  RateNode node;
  node.log_rate = log_rate;
  // dr = r dlog r, and an exact age has the factor r of its density once more.
  const double jacobian = exact ? 2 * log_rate : log_rate;
  if (!sloped) {
    node.value = log_response_value(unit.life, age, unit.life_parameters) +
                 log_response_value(unit.rate, {.at = rate}, unit.rate_parameters) + jacobian;
    return node;
  }
  const ResponseTerm life = log_response(unit.life, age, unit.life_parameters),
                     use = log_response(unit.rate, {.at = rate}, unit.rate_parameters);
  node.value = life.value + use.value + jacobian;
  std::copy_n(life.slope, per_family, node.slope);
  std::copy_n(use.slope, per_family, node.slope + per_family);
  return node;
}

// From one node on, until the log-concave integrand has fallen by all digits.
void walk_rates(const LifeAtRate& unit, const Response& age, double first, double step, bool sloped,
                double& best, std::vector<RateNode>& nodes) {
  constexpr double all_digits = 32;
  constexpr int most = 4000;
  double before = -infinity;
  for (int i = 0; i < most; ++i) {
    RateNode node = node_at(unit, age, first + i * step, sloped);
    if (std::isnan(node.value)) node.value = -infinity;
    const bool falls = node.value < before || !(node.value > -infinity);
    if (falls && best > -infinity && node.value < best - all_digits) return;
    best = std::max(best, node.value);
    before = node.value;
    nodes.push_back(node);
  }
}

// The nodes of one step, ascending: `even` is the index of the first whose number is even.
struct RateSum {
  std::vector<RateNode> nodes;
  double best = -infinity, even = 0, odd = 0;  // sums relative to exp(best)

  RateSum(const LifeAtRate& unit, const Response& age, double middle, double step, bool sloped) {
    std::vector<RateNode> below;
    walk_rates(unit, age, middle, step, sloped, best, nodes);
    walk_rates(unit, age, middle - step, -step, sloped, best, below);
    for (std::size_t i = 0; i < nodes.size(); ++i) (i % 2 == 0 ? even : odd) += share(nodes[i]);
    for (std::size_t i = 0; i < below.size(); ++i) (i % 2 == 0 ? odd : even) += share(below[i]);
    std::reverse(below.begin(), below.end());
    nodes.insert(nodes.begin(), below.begin(), below.end());
  }
  double share(const RateNode& node) const { return std::exp(node.value - best); }
  double all() const { return even + odd; }
  bool settled() const { return std::abs(even - odd) <= 1e-4 * all(); }
};

// Parameters that the families refuse have no width.
double first_step(const LifeAtRate& unit) {
  constexpr double part = 0.55;
  const double width = std::min(log_width(unit.life, unit.life_parameters),
                                log_width(unit.rate, unit.rate_parameters));
  return std::isfinite(width) && width > 0 ? part * width : std::nan("");
}

bool has_valid_parameters(const LifeAtRate& unit) {
  const double life = quantile(unit.life, 0.5, unit.life_parameters),
               rate = quantile(unit.rate, 0.5, unit.rate_parameters);
  return life > 0 && rate > 0 && std::isfinite(life) && std::isfinite(rate) &&
         log_response_value(unit.life, {.at = life}, unit.life_parameters) > -infinity &&
         log_response_value(unit.rate, {.at = rate}, unit.rate_parameters) > -infinity &&
         std::isfinite(first_step(unit));
}

bool is_lognormal(ResponseFamily family) {
  return family == ResponseFamily::lognormal || family == ResponseFamily::lognormal_by_moments ||
         family == ResponseFamily::log10_normal;
}

RateSum rate_sum(const LifeAtRate& unit, const Response& age, bool sloped) {
  constexpr int most_halvings = 4;
  const double middle = std::log(quantile(unit.rate, 0.5, unit.rate_parameters));
  double step = first_step(unit);
  for (int i = 0;; ++i, step *= 0.5) {
    RateSum sum(unit, age, middle, step, sloped);
    // The step is a constant factor of the sum, so it goes into the largest term.
    sum.best += std::log(step);
    for (RateNode& each : sum.nodes) each.value += std::log(step);
    if (sum.settled() || i == most_halvings) return sum;
  }
}

}  // namespace

bool can_be_life_at_rate(ResponseFamily family) {
  return is_lognormal(family) || family == ResponseFamily::weibull ||
         family == ResponseFamily::exponential || family == ResponseFamily::loglogistic ||
         family == ResponseFamily::gamma;
}

bool can_be_rate(ResponseFamily family) {
  return is_lognormal(family) || family == ResponseFamily::weibull ||
         family == ResponseFamily::gamma;
}

double log_response(const LifeAtRate& unit, const Response& age, std::span<double> slope) {
  std::fill(slope.begin(), slope.end(), 0.0);
  if (!has_valid_parameters(unit)) return -infinity;
  if (age.at == infinity) return age.seen == Censoring::left ? 0 : -infinity;
  const RateSum sum = rate_sum(unit, age, !slope.empty());
  if (!(sum.all() > 0)) return -infinity;
  for (const RateNode& node : sum.nodes) {
    const double part = sum.share(node) / sum.all();
    for (std::size_t s = 0; s < slope.size() && part > 0; ++s) slope[s] += part * node.slope[s];
  }
  return sum.best + std::log(sum.all());
}

double failing_within(const LifeAtRate& unit, double age, double use) {
  if (!has_valid_parameters(unit)) return std::nan("");
  if (!(age > 0) || !(use > 0)) return 0;
  if (age == infinity) return std::exp(log_cdf(unit.life, use, unit.life_parameters));
  if (use == infinity) return std::exp(log_response(unit, {.seen = Censoring::left, .at = age}));
  // Units beyond this rate reach the use before the age.
  const double bound = std::log(use / age);
  constexpr double tail = 1e-14;
  const double low = std::log(quantile(unit.rate, tail, unit.rate_parameters)),
               high =
                   std::min(bound, std::log(quantile(unit.rate, 1 - tail, unit.rate_parameters)));
  const double fast = std::exp(log_survival(unit.rate, use / age, unit.rate_parameters) +
                               log_cdf(unit.life, use, unit.life_parameters));
  if (!(high > low)) return fast;
  const auto integrand = [&](double log_rate) {
    const double rate = std::exp(log_rate);
    return std::exp(log_cdf(unit.life, rate * age, unit.life_parameters) +
                    log_response_value(unit.rate, {.at = rate}, unit.rate_parameters) + log_rate);
  };
  using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
  return fast + Rule::integrate(integrand, low, high, 12, 1e-10);
}

double rate_given(const LifeAtRate& unit, const Response& age, double share) {
  if (!has_valid_parameters(unit)) return std::nan("");
  const RateSum sum = rate_sum(unit, age, false);
  if (!(sum.all() > 0)) return std::nan("");
  double left = share * sum.all();
  const double step = sum.nodes.size() > 1 ? sum.nodes[1].log_rate - sum.nodes[0].log_rate : 0;
  for (const RateNode& node : sum.nodes) {
    const double part = sum.share(node);
    if (left <= part && part > 0) return std::exp(node.log_rate + (left / part - 0.5) * step);
    left -= part;
  }
  return std::exp(sum.nodes.back().log_rate);
}

}  // namespace wearwell
