#include "wearwell/infer/natural_density.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/math/view.h"

namespace wearwell {

Eigen::VectorXd natural_widths(const Posterior& posterior, const Whitening& whitening) {
  const int d = posterior.dimension();
  Eigen::VectorXd center(d), x(d), squares = Eigen::VectorXd::Zero(d);
  posterior.to_natural(view(whitening.center), view(center));
  for (int a = 0; a < d; ++a) {
    const Eigen::VectorXd moved = whitening.center + 0.3 * whitening.scale.col(a);
    posterior.to_natural(view(moved), view(x));
    squares += ((x - center) / 0.3).cwiseAbs2();
  }
  return squares.cwiseSqrt();
}

Box natural_box(const Posterior& posterior, const Eigen::VectorXd& width) {
  // Closer to a scatter of zero, rounding dominates gradients (of an integral over fatigue limits).
  constexpr double inset = 1e-6;
  Box box{width, width};
  for (Eigen::Index i = 0; i < width.size(); ++i) {
    const Distribution& prior = posterior.parameters()[static_cast<std::size_t>(i)].prior;
    const double size = std::min(width[i], prior.upper - prior.lower);
    const auto gap = [&](double bound) {
      constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
      return std::isfinite(bound) ? inset * size + rounding * std::abs(bound) : 0;
    };
    box.lower[i] = prior.lower + gap(prior.lower);
    box.upper[i] = prior.upper - gap(prior.upper);
    if (!(box.lower[i] < box.upper[i])) {
      box.lower[i] = box.upper[i] = prior.lower + 0.5 * (prior.upper - prior.lower);
    }
  }
  return box;
}

}  // namespace wearwell
