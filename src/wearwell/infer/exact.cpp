#include "wearwell/infer/exact.h"

#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/infer/box_integrator.h"
#include "wearwell/infer/lattice.h"
#include "wearwell/infer/parted_posterior.h"
#include "wearwell/math/view.h"

namespace wearwell {

namespace {

constexpr int most_tries = 10'000;  // maximum number of attempts per draw

bool within(const Posterior& posterior, const Eigen::VectorXd& x) {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Distribution& prior = posterior.parameters()[static_cast<std::size_t>(i)].prior;
    if (!(prior.lower < x[i] && x[i] < prior.upper)) return false;
  }
  return true;
}

// Along the ridge if the walk met every maximum; otherwise, or without convergence, with the affine
// map.
ExactPosterior integrate_by_boxes(const Posterior& posterior, const Whitening& whitening,
                                  const ExactSettings& settings, const Posterior& shape) {
  BoxIntegrator along(posterior, whitening, settings, shape, true);
  if (settings.maxima.empty() || along.straight()) return along.run();
  if (along.reaches_maxima()) {
    ExactPosterior exact = along.run();
    if (exact.failure.empty()) return exact;
  }
  return BoxIntegrator(posterior, whitening, settings, shape, false).run();
}

}  // namespace

ExactPosterior integrate(const Posterior& posterior, const Whitening& whitening,
                         const ExactSettings& settings) {
  return integrate(posterior, whitening, settings, posterior);
}

ExactPosterior integrate(const Posterior& posterior, const Whitening& whitening,
                         const ExactSettings& settings, const Posterior& shape) {
  if (posterior.dimension() > max_exact_dimension) {
    throw std::logic_error("integrate: too many parameters");
  }
  // Boxes are too expensive in four dimensions; they are tried only if a lattice does not converge.
  if (posterior.dimension() == 4) {
    const auto on_lattice = settings.maxima.empty() ? integrate_on_lattice : integrate_by_parts;
    ExactPosterior exact = on_lattice(posterior, whitening, settings);
    if (!exact.failure.empty() && settings.along_ridge) {
      ExactSettings open = settings;
      open.along_ridge.reset();
      exact = on_lattice(posterior, whitening, open);
    }
    if (exact.failure.empty()) return exact;
  }
  return integrate_by_boxes(posterior, whitening, settings, shape);
}

Draws independent_draws(const Posterior& posterior, const ExactPosterior& exact, int chains,
                        int draws, std::uint64_t seed, std::uint64_t first_stream) {
  const WeightedSampler sample(exact.nodes);
  Draws all;
  for (int c = 0; c < chains; ++c) {
    Rng rng(seed, first_stream + static_cast<std::uint64_t>(c));
    Chain chain;
    chain.values.resize(draws, posterior.dimension());
    for (int i = 0; i < draws; ++i) {
      Eigen::VectorXd x;
      double log_density = -INFINITY;
      // A cell near the boundary of the support may extend beyond it.
      for (int tried = 0; tried < most_tries && !std::isfinite(log_density); ++tried) {
        x = sample(rng);
        if (within(posterior, x)) log_density = posterior.value(view(posterior.to_real(view(x))));
      }
      if (!std::isfinite(log_density)) {
        throw MachineError(
            "independent draws: the cells of the quadrature lie outside the support");
      }
      chain.values.row(i) = x;
      chain.log_density.push_back(log_density);
    }
    all.push_back(std::move(chain));
  }
  return all;
}

}  // namespace wearwell
