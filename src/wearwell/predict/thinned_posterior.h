#pragma once

#include <tbb/parallel_for.h>

#include <vector>

#include "wearwell/bayes/weighted_draws.h"

namespace wearwell {

/// A posterior as few of its own points. In each of many regions they are chosen, and weighted, so that means,
/// variances and covariances are those of all points there: what changes smoothly over the posterior is summed
/// far better by them than by as many points of even weights. Where there are too many parameters for that
/// these are taken.
struct ThinnedPosterior {
  ThinnedPosterior(const WeightedDraws& draws, std::size_t most);
  Points values;
  std::vector<double> weights;  ///< sum to 1
};

/// What all points come to. `make()` gives what adds up a part of them, on one thread: it has
/// `add(const double* x, double weight)`, and `found`, which adds another `found` to itself. The parts
/// are always the same, whatever the number of threads: sums keep their order.
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
  for (std::size_t p = 1; p < parts; ++p) all.add(each[p]);
  return all;
}

}  // namespace wearwell
