#pragma once

#include <tbb/parallel_for.h>

#include <vector>

#include "wearwell/bayes/weighted_draws.h"

namespace wearwell {

/// A posterior thinned to few of its points. In each of many regions they are chosen and weighted
/// to preserve means, variances and covariances (within some 1e-5 standard deviations), so sums of
/// smooth quantities are far more accurate than with as many equally weighted points. With too many
/// parameters, equally weighted points are used. The choice does not depend on rounding errors, so
/// it is the same on every processor.
struct ThinnedPosterior {
  ThinnedPosterior(const WeightedDraws& draws, std::size_t most);
  Points values;
  std::vector<double> weights;  ///< sum to 1
};

/// A parallel sum over all points. `make()` creates an accumulator for one part, used by one
/// thread: it has `add(const double* x, double weight)`, and `found`, which can add another
/// `found`. The parts do not depend on the number of threads, so the order of summation is fixed.
template <class Make>
auto sum_over(const ThinnedPosterior& few, const Make& make) {
  constexpr std::size_t parts = 16;
  std::vector<decltype(make().found)> each(parts);
  tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t p) {
    auto part = make();
    const std::size_t n = few.weights.size();
    for (std::size_t i = p * n / parts; i < (p + 1) * n / parts; ++i) {
      part.add(few.values.row(static_cast<Eigen::Index>(i)).data(), few.weights[i]);
    }
    each[p] = std::move(part.found);
  });
  auto all = std::move(each[0]);
  for (std::size_t p = 1; p < parts; ++p) {
    all.add(each[p]);
    each[p] = {};
  }
  return all;
}

}  // namespace wearwell
