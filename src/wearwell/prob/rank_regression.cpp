#include "wearwell/prob/rank_regression.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <numbers>

#include "wearwell/math/boost_policy.h"

namespace wearwell {
namespace {

double share_failed(double rank, double items, MedianRanks method) {
  return method == MedianRanks::benard
             ? (rank - 0.3) / (items + 0.4)
             : boost::math::ibeta_inv(rank, items - rank + 1, 0.5, QuietInDouble());
}

}  // namespace

std::vector<RankedFailure> ranked_failures(std::span<const Response> responses,
                                           std::span<const int> counts, MedianRanks method) {
  struct Item {
    double at;
    bool runout;
    int count;
  };
  std::vector<Item> items;
  double total = 0;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    items.push_back({responses[i].at, responses[i].seen == Censoring::right, counts[i]});
    total += counts[i];
  }
  std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return a.at < b.at || (a.at == b.at && a.runout < b.runout);
  });
  std::vector<RankedFailure> failures;
  double rank = 0, left = total;
  for (const Item& item : items) {
    for (int i = 0; i < item.count && !item.runout; ++i) {
      rank += (total + 1 - rank) / (1 + left);
      left -= 1;
      failures.push_back({item.at, rank, share_failed(rank, total, method)});
    }
    if (item.runout) left -= item.count;
  }
  return failures;
}

std::optional<RankRegression> rank_regression(std::span<const RankedFailure> failures,
                                              StandardDistribution distribution, bool logarithmic) {
  if (failures.empty() || failures.front().at == failures.back().at) return {};
  std::vector<double> x, z;
  double mean_x = 0, mean_z = 0;
  for (const RankedFailure& each : failures) {
    x.push_back(logarithmic ? std::log(each.at) : each.at);
    z.push_back(quantile(distribution, each.p));
    mean_x += x.back() / static_cast<double>(failures.size());
    mean_z += z.back() / static_cast<double>(failures.size());
  }
  double xx = 0, xz = 0, zz = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xz += (x[i] - mean_x) * (z[i] - mean_z);
    zz += (z[i] - mean_z) * (z[i] - mean_z);
  }
  const double scale = xz / zz;
  if (!std::isfinite(scale)) return {};  // a life of 0
  return RankRegression{mean_x - scale * mean_z, scale, xz / std::sqrt(xx * zz)};
}

std::optional<std::vector<double>> family_parameters_of(ResponseFamily family,
                                                        const RankRegression& line) {
  const double a = line.location, b = line.scale;
  switch (family) {
    case ResponseFamily::weibull:
    case ResponseFamily::loglogistic:
      return std::vector{std::exp(a), 1 / b};
    case ResponseFamily::lognormal:
      return std::vector{std::exp(a), b};
    case ResponseFamily::log10_normal:
      return std::vector{std::exp(a), b / std::numbers::ln10};
    case ResponseFamily::lognormal_by_moments: {
      const double mean = std::exp(a + 0.5 * b * b);
      return std::vector{mean, mean * std::sqrt(std::expm1(b * b))};
    }
    case ResponseFamily::normal:
    case ResponseFamily::smallest_extreme_value:
    case ResponseFamily::largest_extreme_value:
      return std::vector{a, b};
    default:
      return {};
  }
}

}  // namespace wearwell
