#pragma once

#include <algorithm>
#include <vector>

namespace wearwell::prognosis {

struct Least {
  double at = 0, value = 0;
};

/// The minimum of a function over an interval, evaluated at `points` (ascending, not empty) and
/// refined by golden section around the best three of these; for functions with few extrema between
/// points.
template <typename Function>
Least least_of(const Function& function, const std::vector<double>& points) {
  std::vector<Least> tried;
  for (const double x : points) tried.push_back({x, function(x)});
  std::vector<std::size_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const std::size_t few = std::min<std::size_t>(3, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(few), order.end(),
                    [&](auto a, auto b) { return tried[a].value < tried[b].value; });
  Least best = tried[order[0]];
  constexpr double golden = 0.61803398874989485;
  for (std::size_t k = 0; k < few; ++k) {
    const std::size_t i = order[k];
    double low = points[i == 0 ? 0 : i - 1], high = points[std::min(i + 1, points.size() - 1)];
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = function(a), at_b = function(b);
    for (int step = 0; step < 60 && high - low > 1e-12 * high; ++step) {
      if (at_a <= at_b) {
        high = b;
        b = a;
        at_b = at_a;
        at_a = function(a = high - golden * (high - low));
      } else {
        low = a;
        a = b;
        at_a = at_b;
        at_b = function(b = low + golden * (high - low));
      }
    }
    if (at_a < best.value) best = {a, at_a};
    if (at_b < best.value) best = {b, at_b};
  }
  return best;
}

}  // namespace wearwell::prognosis
