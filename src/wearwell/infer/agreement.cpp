#include "wearwell/infer/agreement.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace wearwell {

std::vector<Disagreement> distances_from_exact(const Fit& fit) {
  std::vector<std::vector<Disagreement>> each(fit.diagnostics.size());
  tbb::parallel_for(std::size_t{0}, each.size(), [&](std::size_t i) {
    const QuantityDistribution& exact = fit.marginals[i];
    const QuantityDistribution drawn(fit.pooled, [i](const double* x) { return x[i]; });
    const Diagnostics& d = fit.diagnostics[i];
    const double sd = fit.exact->sd[static_cast<Eigen::Index>(i)];
    // Without a variance the mean has no meaningful Monte Carlo standard error.
    const bool has_mean = std::isfinite(sd);
    constexpr double central = 3.29;  // width of the central 90 % of a normal distribution, in
                                      // standard deviations
    const double size = has_mean ? sd : (exact.quantile(0.95) - exact.quantile(0.05)) / central;
    const auto add = [&](const char* number, double difference, double error) {
      each[i].push_back({i, number, difference / error, difference / size});
    };
    add("5 % quantile", drawn.quantile(0.05) - exact.quantile(0.05), d.mcse_q05);
    add("median", drawn.quantile(0.5) - exact.quantile(0.5), d.mcse_q50);
    add("95 % quantile", drawn.quantile(0.95) - exact.quantile(0.95), d.mcse_q95);
    if (has_mean) add("mean", drawn.mean() - exact.mean(), d.mcse_mean);
  });
  std::vector<Disagreement> all;
  for (const auto& of_one : each) all.insert(all.end(), of_one.begin(), of_one.end());
  return all;
}

std::vector<Disagreement> disagreements(const Fit& fit, double level) {
  constexpr double negligible = 0.005;  // standard deviations
  std::vector<Disagreement> all = distances_from_exact(fit);
  const double alone = -std::expm1(std::log1p(-level) / static_cast<double>(all.size()));
  const double tolerated =
      boost::math::quantile(boost::math::complement(boost::math::normal(), 0.5 * alone));
  std::erase_if(all, [&](const Disagreement& each) {
    return std::abs(each.errors) <= tolerated || std::abs(each.deviations) <= negligible;
  });
  return all;
}

}  // namespace wearwell
