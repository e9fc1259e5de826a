#include "wearwell/prob/use_rate.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <unordered_map>
#include <vector>

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

// Longer than others: one integral over rates, alone and shared between ages.
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

ResponseTerm response_term(ResponseFamily family, const Response& response,
                           const double* parameters, bool sloped) {
  if (sloped) return log_response(family, response, parameters);
  return {log_response_value(family, response, parameters)};
}

// dr = r dlog r, and an exact age has the factor r of its density once more.
RateNode joined(Censoring seen, double log_rate, const ResponseTerm& life,
                const ResponseTerm& use) {
  RateNode node;
  node.log_rate = log_rate;
  node.value = life.value + use.value + (seen == Censoring::none ? 2 * log_rate : log_rate);
  std::copy_n(life.slope, per_family, node.slope);
  std::copy_n(use.slope, per_family, node.slope + per_family);
  return node;
}

RateNode node_at(const LifeAtRate& unit, Response age, double log_rate, bool sloped) {
  const double rate = std::exp(log_rate);
  age.entry = -infinity;
  age.at *= rate;
  age.until *= rate;
  return joined(age.seen, log_rate, response_term(unit.life, age, unit.life_parameters, sloped),
                response_term(unit.rate, {.at = rate}, unit.rate_parameters, sloped));
}

// From one node on, until the log-concave integrand has fallen by all digits; false if it does not.
template <class NodeAt>
bool walk_rates(const NodeAt& node_of, int first, int direction, double& best,
                std::vector<RateNode>& nodes) {
  constexpr double all_digits = 32;
  constexpr int most = 4000;
  double before = -infinity;
  for (int i = 0; i < most; ++i) {
    RateNode node = node_of(first + i * direction);
    if (std::isnan(node.value)) node.value = -infinity;
    const bool falls = node.value < before || !(node.value > -infinity);
    if (falls && best > -infinity && node.value < best - all_digits) return true;
    best = std::max(best, node.value);
    before = node.value;
    nodes.push_back(node);
  }
  return false;
}

// The nodes of one step, ascending; `node_of` has them by their number, which is 0 at the median rate.
struct RateSum {
  std::vector<RateNode> nodes;
  double best = -infinity, even = 0, odd = 0;  // sums relative to exp(best)
  bool whole = false;                          // no part of the integrand is left out

  template <class NodeAt>
  explicit RateSum(const NodeAt& node_of) {
    std::vector<RateNode> below;
    whole = walk_rates(node_of, 0, 1, best, nodes) && walk_rates(node_of, -1, -1, best, below);
    for (std::size_t i = 0; i < nodes.size(); ++i) (i % 2 == 0 ? even : odd) += share(nodes[i]);
    for (std::size_t i = 0; i < below.size(); ++i) (i % 2 == 0 ? odd : even) += share(below[i]);
    std::reverse(below.begin(), below.end());
    nodes.insert(nodes.begin(), below.begin(), below.end());
  }
  double share(const RateNode& node) const { return std::exp(node.value - best); }
  double all() const { return even + odd; }
  bool settled() const { return whole && std::abs(even - odd) <= 1e-4 * all(); }
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

constexpr int most_halvings = 4;

// `nodes_of(halvings)` is a function from a number to its node, at the first step halved so often.
template <class NodesOf>
RateSum settled_sum(double step, const NodesOf& nodes_of) {
  for (int i = 0;; ++i, step *= 0.5) {
    RateSum sum(nodes_of(i));
    // The step is a constant factor of the sum, so it goes into the largest term.
    sum.best += std::log(step);
    for (RateNode& each : sum.nodes) each.value += std::log(step);
    if (sum.settled()) return sum;
    if (i < most_halvings) continue;
    sum.even = sum.odd = 0;  // no such parameters
    return sum;
  }
}

double log_median_rate(const LifeAtRate& unit) {
  return std::log(quantile(unit.rate, 0.5, unit.rate_parameters));
}

RateSum rate_sum(const LifeAtRate& unit, const Response& age, bool sloped) {
  const double middle = log_median_rate(unit), step = first_step(unit);
  return settled_sum(step, [&](int halvings) {
    return [&unit, &age, sloped, middle, width = std::ldexp(step, -halvings)](int i) {
      return node_at(unit, age, middle + i * width, sloped);
    };
  });
}

// The log of an integral with its derivatives by all parameters.
struct LogIntegral {
  double value = -infinity;
  std::array<double, 2 * per_family> slope{};
};

LogIntegral log_integral(const RateSum& sum, bool sloped) {
  LogIntegral found;
  if (!(sum.all() > 0)) return found;
  found.value = sum.best + std::log(sum.all());
  for (const RateNode& node : sum.nodes) {
    const double part = sloped ? sum.share(node) / sum.all() : 0;
    for (std::size_t s = 0; s < 2 * per_family && part > 0; ++s)
      found.slope[s] += part * node.slope[s];
  }
  return found;
}

LogIntegral log_integral(const LifeAtRate& unit, const Response& age, bool sloped) {
  return log_integral(rate_sum(unit, age, sloped), sloped);
}

// Integrals at ages whose logarithms are multiples of a step, each computed when it is first needed: all units under the same
// parameters share them. Steps of log rates are binary multiples of that step, so the integrals share the lives in use, too,
// and all have one row of rates. In between, the polynomial of degree 5 through six of them, whose error is below 1e-6 of the
// logarithm as the step is at most a fifth of the width of the narrower distribution. Steps are powers of two, so that small
// changes of the parameters keep them.
class AgeTable {
 public:
  AgeTable(const LifeAtRate& unit, Censoring seen, bool sloped)
      : life_(unit.life), rate_(unit.rate), seen_(seen), sloped_(sloped) {
    std::copy_n(unit.life_parameters, per_family, parameters_.begin());
    std::copy_n(unit.rate_parameters, per_family, parameters_.begin() + per_family);
    valid_ = has_valid_parameters(unit);
    if (!valid_) return;
    constexpr double of_width = 0.2 / 0.55;  // of first_step
    const double widest = first_step(unit);
    step_ = std::exp2(std::floor(std::log2(of_width * widest)));
    while (ages_of_a_rate_ * 2 * step_ <= widest) ages_of_a_rate_ *= 2;
    middle_ = log_median_rate(unit);
  }

  bool is_like(const LifeAtRate& unit, Censoring seen, bool sloped) const {
    return life_ == unit.life && rate_ == unit.rate && seen_ == seen && sloped_ == sloped;
  }
  bool has_parameters(const LifeAtRate& unit) const {
    return std::equal(unit.life_parameters, unit.life_parameters + per_family,
                      parameters_.begin()) &&
           std::equal(unit.rate_parameters, unit.rate_parameters + per_family,
                      parameters_.begin() + per_family);
  }

  bool valid() const { return valid_; }

  LogIntegral at(const LifeAtRate& unit, const Response& age) {
    const double place = std::log(age.at) / step_;
    const double before = std::floor(place), u = place - before;
    if (!(std::abs(before) < 1e6)) return log_integral(unit, age, sloped_);
    // Lagrange's weights of the nodes -2 to 3.
    double weight[6];
    for (int k = 0; k < 6; ++k) {
      weight[k] = 1;
      for (int j = 0; j < 6; ++j)
        if (j != k) weight[k] *= (u - (j - 2)) / (k - j);
    }
    LogIntegral sum;
    sum.value = 0;
    for (int k = 0; k < 6; ++k) {
      const LogIntegral& node = node_at(unit, static_cast<int>(before) + k - 2);
      if (!std::isfinite(node.value)) return log_integral(unit, age, sloped_);
      sum.value += weight[k] * node.value;
      for (std::size_t s = 0; s < node.slope.size(); ++s) sum.slope[s] += weight[k] * node.slope[s];
    }
    return sum;
  }

 private:
  const LogIntegral& node_at(const LifeAtRate& unit, int k) {
    const auto [node, fresh] = nodes_.try_emplace(k);
    if (fresh) node->second = log_integral(sum_at(unit, k), sloped_);
    return node->second;
  }

  // Places are in the finest step of a rate; a life stands at the sum of those of its age and its rate.
  static constexpr int finest = 1 << most_halvings;

  RateSum sum_at(const LifeAtRate& unit, int k) {
    return settled_sum(ages_of_a_rate_ * step_, [&, k](int halvings) {
      return [&, k, stride = ages_of_a_rate_ * (finest >> halvings)](int i) {
        const int rate = i * stride;
        return joined(seen_, log_rate(rate), life_at(unit, k * finest + rate), use_at(unit, rate));
      };
    });
  }
  double log_rate(int place) const { return middle_ + place * (step_ / finest); }
  const ResponseTerm& life_at(const LifeAtRate& unit, int place) {
    const auto [at, fresh] = lives_.try_emplace(place);
    if (fresh)
      at->second = response_term(unit.life, {.seen = seen_, .at = std::exp(log_rate(place))},
                                 unit.life_parameters, sloped_);
    return at->second;
  }
  const ResponseTerm& use_at(const LifeAtRate& unit, int place) {
    const auto [at, fresh] = uses_.try_emplace(place);
    if (fresh)
      at->second = response_term(unit.rate, {.at = std::exp(log_rate(place))}, unit.rate_parameters,
                                 sloped_);
    return at->second;
  }

  ResponseFamily life_, rate_;
  Censoring seen_;
  bool sloped_, valid_ = false;
  std::array<double, 2 * per_family> parameters_{};
  double step_ = 1, middle_ = 0;
  int ages_of_a_rate_ = 1;  // the first step of a rate in steps of an age
  std::unordered_map<int, LogIntegral> nodes_;
  std::unordered_map<int, ResponseTerm> lives_, uses_;
};

// Of the last parameters in a thread, for each kind of ages. Values do not depend on what was asked
// before, so they may outlive their scope.
struct AgeTables {
  int scopes = 0;
  std::vector<AgeTable> all = {};

  AgeTable& of(const LifeAtRate& unit, Censoring seen, bool sloped) {
    for (AgeTable& each : all) {
      if (!each.is_like(unit, seen, sloped)) continue;
      if (!each.has_parameters(unit)) each = AgeTable(unit, seen, sloped);
      return each;
    }
    return all.emplace_back(unit, seen, sloped);
  }
};
thread_local AgeTables age_tables;

bool is_lognormal(ResponseFamily family) {
  return family == ResponseFamily::lognormal || family == ResponseFamily::lognormal_by_moments ||
         family == ResponseFamily::log10_normal;
}

}  // namespace

SharedAges::SharedAges() {
  ++age_tables.scopes;
}

SharedAges::~SharedAges() {
  --age_tables.scopes;
}

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
  const bool sloped = !slope.empty();
  const bool one_age = age.at > 0 && (age.seen == Censoring::none || age.seen == Censoring::right);
  AgeTable* const table =
      one_age && age_tables.scopes > 0 ? &age_tables.of(unit, age.seen, sloped) : nullptr;
  if (table ? !table->valid() : !has_valid_parameters(unit)) return -infinity;
  if (age.at == infinity) return age.seen == Censoring::left ? 0 : -infinity;
  const LogIntegral found = table ? table->at(unit, age) : log_integral(unit, age, sloped);
  if (found.value > -infinity) std::copy_n(found.slope.begin(), slope.size(), slope.begin());
  return found.value;
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
