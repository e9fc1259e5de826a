#include "wearwell/prob/life_mixture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/math/root.h"
#include "wearwell/prob/use_rate.h"

namespace wearwell {
namespace {

using Slopes = std::array<double, LifeMixture::most_parameters>;

// Adds `weight` times each slope.
void add_slopes(std::span<const double> from, double weight, std::span<double> to) {
  for (std::size_t s = 0; s < to.size(); ++s) to[s] += weight * from[s];
}

LifeAtRate at_rate(const LifeMixture& mixture, std::size_t k, const double* x) {
  return {mixture.families[k], *mixture.rate, x + k * most_response_parameters,
          x + mixture.of_rate()};
}

// One observation of subpopulation k, with derivatives by its parameters and then by those of the rate.
struct SubpopulationTerm {
  double value = 0;
  std::array<double, 2 * most_response_parameters> slope = {};
};

SubpopulationTerm term_of(const LifeMixture& mixture, std::size_t k, const Response& y,
                          const double* x, bool sloped) {
  SubpopulationTerm term;
  if (mixture.rate) {
    term.value = log_response(at_rate(mixture, k, x), y,
                              sloped ? std::span<double>(term.slope) : std::span<double>());
    return term;
  }
  const double* const own = x + k * most_response_parameters;
  if (!sloped) {
    term.value = log_response_value(mixture.families[k], y, own);
    return term;
  }
  const ResponseTerm plain = log_response(mixture.families[k], y, own);
  term.value = plain.value;
  std::copy(std::begin(plain.slope), std::end(plain.slope), term.slope.begin());
  return term;
}

// log of the sum over subpopulations of share times term, without p, d and entry.
double log_of_subpopulations(const LifeMixture& mixture, Response y, const double* x,
                             std::span<double> slope) {
  y.entry = -infinity;
  const std::size_t count = mixture.families.size();
  std::array<SubpopulationTerm, LifeMixture::most> term;
  double most = -infinity;
  for (std::size_t k = 0; k < count; ++k) {
    term[k] = term_of(mixture, k, y, x, !slope.empty());
    if (mixture.share_of(k, x) > 0) most = std::max(most, term[k].value);
  }
  std::fill(slope.begin(), slope.end(), 0.0);
  if (!(most > -infinity)) return -infinity;
  double sum = 0;
  for (std::size_t k = 0; k < count; ++k)
    sum += mixture.share_of(k, x) * std::exp(term[k].value - most);
  if (slope.empty()) return most + std::log(sum);
  for (std::size_t k = 0; k < count; ++k) {
    const double relative = std::exp(term[k].value - most) / sum;
    const double part = mixture.share_of(k, x) * relative;
    for (std::size_t s = 0; s < most_response_parameters && part > 0; ++s)
      slope[k * most_response_parameters + s] = part * term[k].slope[s];
    for (std::size_t s = 0; mixture.rate && s < most_response_parameters && part > 0; ++s)
      slope[mixture.of_rate() + s] += part * term[k].slope[most_response_parameters + s];
    if (count == 1) break;
    for (std::size_t j = 0; j < count; ++j) {
      if (j == mixture.rest) continue;
      if (k == j) slope[mixture.share(j)] += relative;
      if (k == mixture.rest) slope[mixture.share(j)] -= relative;
    }
  }
  return most + std::log(sum);
}

// p and d.
struct Shares {
  double defective, dead;

  Shares(const LifeMixture& mixture, const double* x)
      : defective(mixture.limited ? x[mixture.share_defective()] : 1),
        dead(mixture.dead_share(x)) {}
};

void add_to(const LifeMixture& mixture, double by_defective, double by_dead,
            std::span<double> slope) {
  if (slope.empty()) return;
  if (mixture.limited) slope[mixture.share_defective()] += by_defective;
  if (mixture.dead) slope[mixture.share_dead()] += by_dead;
}

// log P(T > life); `slope` is overwritten.
double log_surviving(const LifeMixture& mixture, double life, const double* x,
                     std::span<double> slope) {
  const Shares share(mixture, x);
  std::fill(slope.begin(), slope.end(), 0.0);
  const double works = std::log1p(-share.dead);
  if (!(life > 0)) {
    add_to(mixture, 0, -1 / (1 - share.dead), slope);
    return works;
  }
  const double log_left =
      log_of_subpopulations(mixture, {.seen = Censoring::right, .at = life}, x, slope);
  if (!mixture.limited) {
    add_to(mixture, 0, -1 / (1 - share.dead), slope);
    return works + log_left;
  }
  const double left = std::exp(log_left), failing = share.defective * left;
  const double all = 1 - share.defective + failing;
  if (!(all > 0)) return -infinity;
  for (double& each : slope) each *= failing / all;
  add_to(mixture, std::expm1(log_left) / all, -1 / (1 - share.dead), slope);
  return works + std::log(all);
}

// log P(T <= life).
double log_failed(const LifeMixture& mixture, double life, const double* x,
                  std::span<double> slope) {
  const Shares share(mixture, x);
  const double log_part =
      life > 0 ? log_of_subpopulations(mixture, {.seen = Censoring::left, .at = life}, x, slope)
               : -infinity;
  if (!(life > 0)) std::fill(slope.begin(), slope.end(), 0.0);
  const double part = std::exp(log_part), failing = (1 - share.dead) * share.defective * part;
  if (!mixture.dead) {
    add_to(mixture, 1 / share.defective, 0, slope);
    return std::log(share.defective) + log_part;
  }
  const double all = share.dead + failing;
  for (double& each : slope) each *= failing / all;
  add_to(mixture, (1 - share.dead) * part / all, (1 - share.defective * part) / all, slope);
  return std::log(all);
}

}  // namespace

bool LifeMixture::allowed(const double* x) const {
  if (plain()) return true;
  for (std::size_t k = 0; k < families.size(); ++k) {
    const double share = share_of(k, x);
    if (!(share >= 0 && share <= 1)) return false;
  }
  const Shares shares(*this, x);
  return shares.defective > 0 && shares.defective <= 1 && shares.dead >= 0 && shares.dead < 1;
}

double LifeMixture::share_of(std::size_t k, const double* x) const {
  if (families.size() == 1) return 1;
  if (k != rest) return x[share(k)];
  double left = 1;
  for (std::size_t j = 0; j < families.size(); ++j) left -= j == rest ? 0 : x[share(j)];
  return left;
}

double LifeMixture::failing(const double* x) const {
  const Shares share(*this, x);
  return share.dead + (1 - share.dead) * share.defective;
}

double LifeMixture::log_response(const Response& y, const double* x,
                                 std::span<double> slope) const {
  if (!allowed(x)) return -infinity;
  const Shares share(*this, x);
  double value = -infinity;
  if (y.seen == Censoring::right) {
    value = log_surviving(*this, y.at, x, slope);
  } else if (y.seen == Censoring::left) {
    value = log_failed(*this, y.at, x, slope);
  } else if (dead && y.seen == Censoring::none && y.at == 0) {
    std::fill(slope.begin(), slope.end(), 0.0);
    value = std::log(share.dead);
    add_to(*this, 0, 1 / share.dead, slope);
  } else {
    value = std::log1p(-share.dead) + std::log(share.defective) +
            log_of_subpopulations(*this, y, x, slope);
    add_to(*this, 1 / share.defective, -1 / (1 - share.dead), slope);
  }
  if (y.entry > 0) {
    Slopes entered{};
    const std::span<double> by_entry =
        slope.empty() ? std::span<double>() : std::span(entered).first(parameters());
    value -= log_surviving(*this, y.entry, x, by_entry);
    add_slopes(by_entry, -1, slope);
  }
  return std::isnan(value) ? -infinity : value;
}

double LifeMixture::log_cdf(double life, const double* x) const {
  if (plain()) return wearwell::log_cdf(families.front(), life, x);
  if (!allowed(x)) return std::nan("");
  return log_failed(*this, life, x, {});
}

double LifeMixture::log_survival(double life, const double* x) const {
  if (plain()) return wearwell::log_survival(families.front(), life, x);
  if (!allowed(x)) return std::nan("");
  return log_surviving(*this, life, x, {});
}

double LifeMixture::log_density(double life, const double* x) const {
  if (plain()) return log_response_value(families.front(), {.at = life}, x);
  return log_response({.at = life}, x);
}

double LifeMixture::quantile(double p, const double* x) const {
  if (plain()) return wearwell::quantile(families.front(), p, x);
  if (!allowed(x)) return std::nan("");
  const Shares shares(*this, x);
  const double among = (p - shares.dead) / ((1 - shares.dead) * shares.defective);
  if (among <= 0) return 0;
  if (among >= 1) return infinity;
  if (families.size() == 1 && !rate) return wearwell::quantile(families.front(), among, x);
  // The root lies between the quantiles of the subpopulations. An age T = U/R has failed with a probability of at most
  // `among` where U is below a quantile of half of it and R above that of the other half; the same beyond.
  double low = infinity, high = 0;
  for (std::size_t k = 0; k < families.size(); ++k) {
    if (!(share_of(k, x) > 0)) continue;
    const double* const own = x + k * most_response_parameters;
    double least = wearwell::quantile(families[k], rate ? 0.5 * among : among, own),
           greatest = least;
    if (rate) {
      const double* const of = x + of_rate();
      greatest = wearwell::quantile(families[k], 0.5 * (1 + among), own) /
                 wearwell::quantile(*rate, 0.5 * (1 - among), of);
      least /= wearwell::quantile(*rate, 1 - 0.5 * among, of);
    }
    if (std::isnan(least) || std::isnan(greatest)) return std::nan("");
    low = std::min(low, least);
    high = std::max(high, greatest);
  }
  if (!(low > 0) || !std::isfinite(high)) return std::nan("");
  // From the smaller tail, to keep all digits.
  const auto beyond = [&](double log_life) {
    const double life = std::exp(log_life);
    if (among < 0.5) {
      return std::exp(log_of_subpopulations(*this, {.seen = Censoring::left, .at = life}, x, {})) -
             among;
    }
    return (1 - among) -
           std::exp(log_of_subpopulations(*this, {.seen = Censoring::right, .at = life}, x, {}));
  };
  const double middle = 0.5 * (std::log(low) + std::log(high));
  return std::exp(solve_increasing(beyond, middle, 0.5 * std::log(high / low) + 1e-9,
                                   {.absolute = 1e-12}, -700, 700));
}

double LifeMixture::middle(const double* x) const {
  if (plain()) return wearwell::quantile(families.front(), 0.5, x);
  const double dead_now = dead_share(x);
  return quantile(dead_now + 0.5 * (failing(x) - dead_now), x);
}

double LifeMixture::failing_within(double age, double use, const double* x) const {
  if (!allowed(x)) return std::nan("");
  const Shares shares(*this, x);
  double sum = 0;
  for (std::size_t k = 0; k < families.size(); ++k)
    sum += share_of(k, x) * wearwell::failing_within(at_rate(*this, k, x), age, use);
  return shares.dead + (1 - shares.dead) * shares.defective * sum;
}

double LifeMixture::share_among_survivors(std::size_t k, double life, const double* x) const {
  const Response lasts{.seen = Censoring::right, .at = life};
  const auto left = [&](std::size_t j) { return term_of(*this, j, lasts, x, false).value; };
  double most = -infinity, sum = 0;
  for (std::size_t j = 0; j < families.size(); ++j)
    if (share_of(j, x) > 0) most = std::max(most, left(j));
  if (!(most > -infinity)) return std::nan("");
  for (std::size_t j = 0; j < families.size(); ++j)
    sum += share_of(j, x) * std::exp(left(j) - most);
  const double among = share_of(k, x) * std::exp(left(k) - most) / sum;
  if (!limited) return among;
  const double failing = x[share_defective()] * sum * std::exp(most);
  return among * failing / (1 - x[share_defective()] + failing);
}

namespace {

// Whether all rows have the same parameters.
bool are_equal(std::span<const ParameterValues> parameters, std::size_t rows) {
  for (const ParameterValues& each : parameters)
    for (std::size_t i = 1; i < rows; ++i)
      if (!(each[i] == each[0])) return false;
  return true;
}

}  // namespace

void log_responses(const LifeMixture& mixture, const ResponseColumn& column, std::size_t begin,
                   std::span<const ParameterValues> family_parameters, std::span<double> value,
                   std::span<double> slope) {
  if (mixture.plain())
    return log_responses(mixture.families.front(), column, begin, family_parameters, value, slope);
  const std::size_t n = value.size(), count = mixture.parameters();
  Slopes x{}, own{};
  const std::span<double> wanted =
      slope.empty() ? std::span<double>() : std::span(own).first(count);
  std::optional<SharedAges> ages;
  if (mixture.rate && are_equal(family_parameters.first(count), n)) ages.emplace();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t s = 0; s < count; ++s) x[s] = family_parameters[s][i];
    value[i] = mixture.log_response(column.rows[begin + i], x.data(), wanted);
    const bool known = value[i] > -infinity;
    for (std::size_t s = 0; s < wanted.size(); ++s) slope[s * n + i] = known ? own[s] : 0;
  }
}

}  // namespace wearwell
