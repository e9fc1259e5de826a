#include "wearwell/infer/diagnostics.h"

#include <Eigen/Core>
#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "wearwell/math/quantile.h"

// Longer than others: all diagnostics start from the same pooled, split and ranked draws.
namespace wearwell {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Double is accurate enough and much faster than Boost's default promotion to long double.
using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

bool is_constant(std::span<const double> x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const double rounding = 8 * std::numeric_limits<double>::epsilon();
  return *high - *low <= rounding * std::max(std::abs(*low), std::abs(*high));
}

// Sums differences from the first value, so that the mean of a constant is exact.
double mean(std::span<const double> x) {
  double sum = 0;
  for (const double value : x) sum += value - x[0];
  return x[0] + sum / static_cast<double>(x.size());
}

double variance(std::span<const double> x) {
  const double centre = mean(x);
  double sum = 0;
  for (const double value : x) sum += (value - centre) * (value - centre);
  return sum / static_cast<double>(x.size() - 1);
}

/// The halves of the chains: consecutive series of equal length.
struct Halves {
  std::vector<double> values;
  std::size_t length = 0;

  std::size_t count() const { return values.size() / length; }
  std::span<const double> operator[](std::size_t i) const {
    return std::span(values).subspan(i * length, length);
  }
};

/// One value of the halves.
struct Ranked {
  double value;
  std::uint32_t place;  ///< in Halves::values
};

/// The common input of all diagnostics.
struct Pooled {
  bool usable = false;  ///< finite, not constant, long enough for R-hat; otherwise the rest is
                        ///< empty
  Halves halves;        ///< the middle draw of a chain of odd length is in neither half
  std::vector<Ranked> ranked;  ///< the draws in the halves, ascending
  std::vector<double> sorted;  ///< all draws, ascending
};

Pooled pool(const Chains& chains) {
  const std::size_t length = chains.draws.empty() ? 0 : chains.draws[0].size();
  for (const auto& chain : chains.draws) {
    if (chain.size() != length) throw std::invalid_argument("chains of different lengths");
  }
  Pooled pooled;
  if (length < 4) return pooled;
  for (const auto& chain : chains.draws) {
    if (!std::all_of(chain.begin(), chain.end(), [](double x) { return std::isfinite(x); })) {
      return pooled;
    }
  }

  const std::size_t half = length / 2;
  std::vector<double> middles;
  pooled.halves.length = half;
  for (const auto& chain : chains.draws) {
    auto& values = pooled.halves.values;
    values.insert(values.end(), chain.begin(), chain.begin() + half);
    values.insert(values.end(), chain.end() - half, chain.end());
    if (length % 2 == 1) middles.push_back(chain[half]);
  }
  const std::size_t count = pooled.halves.values.size();
  pooled.ranked.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    pooled.ranked[i] = {pooled.halves.values[i], static_cast<std::uint32_t>(i)};
  }
  std::sort(pooled.ranked.begin(), pooled.ranked.end(),
            [](const Ranked& a, const Ranked& b) { return a.value < b.value; });
  pooled.sorted.resize(count);
  std::transform(pooled.ranked.begin(), pooled.ranked.end(), pooled.sorted.begin(),
                 [](const Ranked& r) { return r.value; });
  for (const double middle : middles) {
    pooled.sorted.insert(std::upper_bound(pooled.sorted.begin(), pooled.sorted.end(), middle),
                         middle);
  }
  pooled.usable = !is_constant(pooled.sorted);
  return pooled;
}

/// Normal scores of the ranks 1 to `count` with Blom's offset: Phi^-1((r - 3/8)/(count + 1/4)).
class NormalScores {
 public:
  explicit NormalScores(std::size_t count) : whole_(count) {
    for (std::size_t i = 0; i < count - count / 2; ++i) {
      whole_[i] = score(static_cast<double>(i + 1));
      whole_[count - 1 - i] = -whole_[i];
    }
  }

  /// The normal score of the mean of the ranks `first` to `last`.
  double operator()(std::size_t first, std::size_t last) const {
    const std::size_t twice = first + last;
    return twice % 2 == 0 ? whole_[twice / 2 - 1] : score(0.5 * static_cast<double>(twice));
  }

 private:
  double score(double rank) const {
    const double p = (rank - 0.375) / (static_cast<double>(whole_.size()) + 0.25);
    return -std::sqrt(2.0) * boost::math::erfc_inv(2 * p, Policy());
  }

  std::vector<double> whole_;
};

/// The normal score of each value's rank; ties have their mean rank (section 4.1).
Halves rank_normalize(std::span<const Ranked> ranked, const NormalScores& scores,
                      std::size_t length) {
  Halves normal{std::vector<double>(ranked.size()), length};
  for (std::size_t first = 0, next = 0; first < ranked.size(); first = next) {
    while (next < ranked.size() && ranked[next].value == ranked[first].value) ++next;
    const double score = scores(first + 1, next);
    for (std::size_t i = first; i < next; ++i) normal.values[ranked[i].place] = score;
  }
  return normal;
}

/// The distances from the median, ascending. They decrease below it and increase above it, so a
/// merge replaces a second sort.
std::vector<Ranked> fold(std::span<const Ranked> ranked, double median) {
  auto above = std::lower_bound(ranked.begin(), ranked.end(), median,
                                [](const Ranked& r, double m) { return r.value < m; });
  auto below = std::make_reverse_iterator(above);
  std::vector<Ranked> folded;
  folded.reserve(ranked.size());
  while (folded.size() < ranked.size()) {
    const double fall = below == ranked.rend() ? HUGE_VAL : median - below->value;
    const double rise = above == ranked.end() ? HUGE_VAL : above->value - median;
    if (fall < rise) {
      folded.push_back({fall, (below++)->place});
    } else {
      folded.push_back({rise, (above++)->place});
    }
  }
  return folded;
}

/// Split R-hat (section 3.1).
double rhat(const Halves& halves) {
  if (is_constant(halves.values)) return nan;
  std::vector<double> means, variances;
  for (std::size_t i = 0; i < halves.count(); ++i) {
    means.push_back(mean(halves[i]));
    variances.push_back(variance(halves[i]));
  }
  const auto n = static_cast<double>(halves.length);
  return std::sqrt((n * variance(means) / mean(variances) + n - 1) / n);
}

/// Effective sample size (section 3.2). Computes autocovariances lag by lag until Geyer's criterion
/// stops, which is early for well-mixed chains.
double ess(const Halves& halves) {
  if (halves.length < 3 || is_constant(halves.values)) return nan;
  const std::size_t length = halves.length;
  const auto n = static_cast<double>(length);
  const auto size = static_cast<double>(halves.values.size());

  std::vector<double> means(halves.count());
  Eigen::ArrayXXd deviation(length, halves.count());
  for (std::size_t i = 0; i < halves.count(); ++i) {
    means[i] = mean(halves[i]);
    deviation.col(i) = Eigen::Map<const Eigen::ArrayXd>(halves[i].data(), length) - means[i];
  }
  const auto autocovariance = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t i = 0; i < halves.count(); ++i) {
      const auto series = deviation.col(i).matrix();
      sum += series.head(length - lag).dot(series.tail(length - lag));
    }
    return sum / size;
  };
  const double biased = autocovariance(0);
  const double within = biased * n / (n - 1);
  const double total = biased + variance(means);
  const auto rho = [&](std::size_t lag) { return 1 - (within - autocovariance(lag)) / total; };

  // Adds pairs of lags (t, t + 1) while their sums are positive, each limited by the previous one.
  std::size_t t = 0;
  double even = 1, pair = 1 + rho(1);
  double sum = 0, ceiling = HUGE_VAL;
  while (t + 5 < length && pair > 0) {
    ceiling = std::min(ceiling, pair);
    sum += ceiling;
    t += 2;
    even = rho(t);
    pair = even + rho(t + 1);
  }
  // The even lag of the terminating pair is still added, which improves antithetic chains.
  const double last = pair >= 0 || even > 0 ? even : 0;
  // Without any pair (halves of up to five draws, or perfect alternation) posterior adds lag 0 a
  // second time, which gives half the draws.
  if (t == 0) sum = 1;
  const double tau = -1 + 2 * sum + last;
  return size / std::max(tau, 1 / std::log10(size));
}

double rhat_bulk(const Pooled& pooled, const NormalScores& scores) {
  return rhat(rank_normalize(pooled.ranked, scores, pooled.halves.length));
}

double rhat_folded(const Pooled& pooled, const NormalScores& scores) {
  const auto folded = fold(pooled.ranked, quantile(pooled.sorted, 0.5));
  return rhat(rank_normalize(folded, scores, pooled.halves.length));
}

// The larger or smaller of two numbers; NaN if either is.
double larger(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? nan : std::max(a, b);
}
double smaller(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? nan : std::min(a, b);
}

double ess_quantile(const Pooled& pooled, double p) {
  const auto count = static_cast<double>(pooled.sorted.size());
  const double value = quantile(pooled.sorted, p == 1 ? (count - 0.5) / count : p);
  Halves not_above{std::vector<double>(pooled.ranked.size()), pooled.halves.length};
  for (const auto& [draw, place] : pooled.ranked) {
    if (draw > value) break;
    not_above.values[place] = 1;
  }
  return ess(not_above);
}

double mcse_mean(const Pooled& pooled) {
  return std::sqrt(variance(pooled.sorted) / ess(pooled.halves));
}

double mcse_sd(const Pooled& pooled) {
  const double centre = mean(pooled.sorted);
  Halves squares = pooled.halves;
  for (double& x : squares.values) x = (x - centre) * (x - centre);
  double second = 0, fourth = 0;
  for (const double x : pooled.sorted) {
    const double square = (x - centre) * (x - centre);
    second += square;
    fourth += square * square;
  }
  const auto count = static_cast<double>(pooled.sorted.size());
  second /= count;
  fourth /= count;
  return std::sqrt((fourth - second * second) / ess(squares) / second / 4);
}

double mcse_quantile(const Pooled& pooled, double p, double effective) {
  if (std::isnan(effective)) return nan;
  const auto rank = [&](double probability) {
    return static_cast<double>(pooled.sorted.size()) *
           boost::math::ibeta_inv(effective * p + 1, effective * (1 - p) + 1, probability,
                                  Policy());
  };
  // Phi(-1) and Phi(1), with the digits used by posterior.
  const double low = std::max(std::floor(rank(0.1586553)), 1.0);
  const double high =
      std::min(std::ceil(rank(0.8413447)), static_cast<double>(pooled.sorted.size()));
  return (pooled.sorted[static_cast<std::size_t>(high) - 1] -
          pooled.sorted[static_cast<std::size_t>(low) - 1]) /
         2;
}

}  // namespace

Diagnostics diagnose(const Chains& chains) {
  const Pooled pooled = pool(chains);
  if (!pooled.usable) return {nan, nan, nan, nan, nan, nan, nan, nan};
  const NormalScores scores(pooled.ranked.size());
  const Halves normal = rank_normalize(pooled.ranked, scores, pooled.halves.length);
  const double ess_q05 = ess_quantile(pooled, 0.05);
  const double ess_q95 = ess_quantile(pooled, 0.95);
  return {
      .rhat = larger(rhat(normal), rhat_folded(pooled, scores)),
      .ess_bulk = ess(normal),
      .ess_tail = smaller(ess_q05, ess_q95),
      .mcse_mean = mcse_mean(pooled),
      .mcse_sd = mcse_sd(pooled),
      .mcse_q05 = mcse_quantile(pooled, 0.05, ess_q05),
      .mcse_q50 = mcse_quantile(pooled, 0.5, ess_quantile(pooled, 0.5)),
      .mcse_q95 = mcse_quantile(pooled, 0.95, ess_q95),
  };
}

double rhat(const Chains& chains) {
  const Pooled pooled = pool(chains);
  if (!pooled.usable) return nan;
  const NormalScores scores(pooled.ranked.size());
  return larger(rhat_bulk(pooled, scores), rhat_folded(pooled, scores));
}

double rhat_bulk(const Chains& chains) {
  const Pooled pooled = pool(chains);
  return pooled.usable ? rhat_bulk(pooled, NormalScores(pooled.ranked.size())) : nan;
}

double rhat_folded(const Chains& chains) {
  const Pooled pooled = pool(chains);
  return pooled.usable ? rhat_folded(pooled, NormalScores(pooled.ranked.size())) : nan;
}

double ess_bulk(const Chains& chains) {
  const Pooled pooled = pool(chains);
  if (!pooled.usable) return nan;
  const NormalScores scores(pooled.ranked.size());
  return ess(rank_normalize(pooled.ranked, scores, pooled.halves.length));
}

double ess_tail(const Chains& chains) {
  const Pooled pooled = pool(chains);
  if (!pooled.usable) return nan;
  return smaller(ess_quantile(pooled, 0.05), ess_quantile(pooled, 0.95));
}

double ess_mean(const Chains& chains) {
  const Pooled pooled = pool(chains);
  return pooled.usable ? ess(pooled.halves) : nan;
}

double ess_sd(const Chains& chains) {
  const Pooled pooled = pool(chains);
  if (!pooled.usable) return nan;
  const double centre = mean(pooled.sorted);
  Halves distance = pooled.halves;
  for (double& x : distance.values) x = std::abs(x - centre);
  return ess(distance);
}

double ess_quantile(const Chains& chains, double p) {
  const Pooled pooled = pool(chains);
  return pooled.usable ? ess_quantile(pooled, p) : nan;
}

double mcse_mean(const Chains& chains) {
  const Pooled pooled = pool(chains);
  return pooled.usable ? mcse_mean(pooled) : nan;
}

double mcse_sd(const Chains& chains) {
  const Pooled pooled = pool(chains);
  return pooled.usable ? mcse_sd(pooled) : nan;
}

double mcse_quantile(const Chains& chains, double p) {
  const Pooled pooled = pool(chains);
  return pooled.usable ? mcse_quantile(pooled, p, ess_quantile(pooled, p)) : nan;
}

double e_bfmi(std::span<const double> energies) {
  if (energies.size() < 2) return nan;
  const double centre = mean(energies);
  double steps = 0, spread = 0;
  for (std::size_t n = 0; n < energies.size(); ++n) {
    if (n > 0) steps += (energies[n] - energies[n - 1]) * (energies[n] - energies[n - 1]);
    spread += (energies[n] - centre) * (energies[n] - centre);
  }
  return steps / spread;
}

}  // namespace wearwell
