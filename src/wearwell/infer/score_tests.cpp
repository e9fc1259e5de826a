#include "wearwell/infer/score_tests.h"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <numeric>

#include "wearwell/base/stop_scope.h"
#include "wearwell/bayes/normal_score.h"
#include "wearwell/math/normality.h"

namespace wearwell {
namespace {

constexpr double farthest = 35;  // bound that keeps means of scores finite

// The z with Phi(z) = below, given both tails.
double score_of(double below, double above) {
  return std::clamp(normal_score(std::log(below), std::log(above)), -farthest, farthest);
}

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// `values` without their component along `direction`.
std::vector<double> without(std::span<const double> values, std::span<const double> direction) {
  const double square =
      std::inner_product(direction.begin(), direction.end(), direction.begin(), 0.0);
  const double part =
      square > 0 ? std::inner_product(values.begin(), values.end(), direction.begin(), 0.0) / square
                 : 0;
  std::vector<double> rest;
  for (std::size_t i = 0; i < values.size(); ++i) rest.push_back(values[i] - part * direction[i]);
  return rest;
}

// Student's t of the cosine between residuals and a direction, as a standard normal number.
double cosine_score(std::span<const double> a, std::span<const double> b, double freedom) {
  const double squares = std::inner_product(a.begin(), a.end(), a.begin(), 0.0) *
                         std::inner_product(b.begin(), b.end(), b.begin(), 0.0);
  if (!(freedom >= 1) || !(squares > 0)) return 0;
  const double r = std::inner_product(a.begin(), a.end(), b.begin(), 0.0) / std::sqrt(squares);
  const double rest = 1 - r * r;
  if (!(rest > 0)) return r > 0 ? farthest : -farthest;
  const boost::math::students_t distribution(freedom);
  const double t = r * std::sqrt(freedom / rest);
  return score_of(cdf(distribution, t), cdf(complement(distribution, t)));
}

}  // namespace

double shape_score(std::span<const double> z) {
  check_stop();
  if (z.size() <= most_shapiro_wilk) {
    return std::clamp(-shapiro_wilk_test({z.begin(), z.end()}).score, -farthest, farthest);
  }
  const double p = anderson_darling_test({z.begin(), z.end()}).p;
  return p < 1 ? score_of(p, 1 - p) : 0;
}

std::vector<double> sizes(std::span<const double> z) {
  std::vector<double> all;
  all.reserve(z.size());
  for (const double each : z) {
    const double outside = std::erfc(std::abs(each) / std::sqrt(2.0));
    all.push_back(score_of(1 - outside, outside));
  }
  return all;
}

double scatter_trend_score(std::span<const double> size, std::span<const double> along) {
  const std::vector<double> ones(size.size(), 1.0);
  return cosine_score(without(size, ones), without(along, ones),
                      static_cast<double>(size.size()) - 2);
}

double scatter_between_score(std::span<const double> size, std::span<const std::size_t> level) {
  struct Sums {
    double n = 0, sum = 0;
  };
  std::map<std::size_t, Sums> levels;
  for (std::size_t i = 0; i < size.size(); ++i) {
    ++levels[level[i]].n;
    levels[level[i]].sum += size[i];
  }
  const double n = static_cast<double>(size.size()), between_freedom = std::ssize(levels) - 1.0;
  const double within_freedom = n - between_freedom - 1;
  if (between_freedom < 1 || within_freedom < 1) return 0;
  const double middle = mean(size);
  double between = 0, within = 0;
  for (const auto& [at, each] : levels) {
    between += each.n * std::pow(each.sum / each.n - middle, 2);
  }
  for (std::size_t i = 0; i < size.size(); ++i) {
    const Sums& own = levels[level[i]];
    within += std::pow(size[i] - own.sum / own.n, 2);
  }
  if (!(within > 0)) return 0;
  const boost::math::fisher_f distribution(between_freedom, within_freedom);
  const double f = between / between_freedom / (within / within_freedom);
  return -score_of(cdf(distribution, f), cdf(complement(distribution, f)));
}

double offset_score(std::span<const double> z, std::span<const double> driver) {
  const std::vector<double> ones(z.size(), 1.0);
  return cosine_score(without(z, driver), without(ones, driver), static_cast<double>(z.size()) - 2);
}

std::vector<double> centered_ranks(std::span<const double> values,
                                   std::span<const std::size_t> group) {
  const auto of = [&](std::size_t i) { return group.empty() ? 0 : group[i]; };
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::make_pair(of(a), values[a]) < std::make_pair(of(b), values[b]);
  });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && of(order[end]) == of(order[begin])) ++end;
    const double middle = 0.5 * static_cast<double>(begin + end - 1);
    for (std::size_t i = begin; i < end;) {
      std::size_t same = i;
      while (same < end && values[order[same]] == values[order[i]]) ++same;
      for (std::size_t j = i; j < same; ++j) {
        ranks[order[j]] = 0.5 * static_cast<double>(i + same - 1) - middle;
      }
      i = same;
    }
    begin = end;
  }
  return ranks;
}

double combined_p(std::span<const double> scores, bool two_sided, double credited) {
  const double n = static_cast<double>(scores.size()), middle = mean(scores);
  double between = 0;
  for (const double each : scores) between += std::pow(each - middle, 2);
  between /= std::max(n - 1, 1.0);
  constexpr double least = 0.5;
  const double z = middle / std::sqrt(std::max(1 - credited * between, least) + between / n);
  return two_sided ? 2 * normal_cdf(-std::abs(z)) : normal_cdf(z);
}

}  // namespace wearwell
