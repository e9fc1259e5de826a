#include "wearwell/infer/run_chains.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/infer/metropolis.h"
#include "wearwell/infer/nuts.h"
#include "wearwell/infer/warmup.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// As Stan does on its own scale: uniform on (-2, 2) in every direction, until inside the support.
Eigen::VectorXd random_start(const LogDensity& whitened, Rng& rng) {
  Eigen::VectorXd u(whitened.dimension());
  for (int attempt = 0; attempt < 100; ++attempt) {
    for (double& each : u) each = rng.uniform(-2, 2);
    if (std::isfinite(whitened.value(view(u)))) return u;
  }
  throw InputError("no start with a positive posterior density in 100 attempts");
}

template <class RunChain>
Draws run_chains(const RunSettings& settings, const RunChain& run_chain) {
  Draws draws(static_cast<std::size_t>(settings.chains));
  tbb::parallel_for(0, settings.chains, [&](int c) {
    Rng rng(settings.seed, settings.first_stream + static_cast<std::uint64_t>(c));
    draws[static_cast<std::size_t>(c)] = run_chain(rng);
  });
  return draws;
}

template <int N>
Chain nuts_chain(const Posterior& posterior, const Whitening& whitening,
                 const NutsSettings& options, const RunSettings& settings, Rng& rng) {
  const WhitenedDensity density(posterior, whitening);
  Nuts<N> nuts(density, options.dense_metric, options.max_treedepth);
  nuts.set_position(random_start(density, rng));

  nuts.find_reasonable_step_size(rng);
  WindowedWarmup<N> warmup(settings.warmup, options.target_accept);
  ProgressSteps steps(settings.progress);
  for (int i = 0; i < settings.warmup; ++i) {
    warmup.adapt(i, nuts.step(rng), nuts, rng);
    steps.step();
  }
  if (settings.warmup > 0) warmup.finish(nuts);

  Chain chain;
  chain.values.resize(settings.draws, posterior.dimension());
  chain.nuts.reserve(static_cast<std::size_t>(settings.draws));
  chain.log_density.reserve(static_cast<std::size_t>(settings.draws));
  Eigen::VectorXd x(posterior.dimension());
  double accept = 0;
  for (int i = 0; i < settings.draws; ++i) {
    chain.nuts.push_back(nuts.step(rng));
    accept += chain.nuts.back().accept_stat;
    posterior.to_natural(view(whitening(nuts.point().position)), view(x));
    chain.values.row(i) = x;
    chain.log_density.push_back(nuts.point().log_density);
    steps.step();
  }
  chain.accept_rate = accept / settings.draws;
  chain.step_size = nuts.step_size;
  return chain;
}

}  // namespace

Draws run_nuts(const Posterior& posterior, const Whitening& whitening, const NutsSettings& nuts,
               const RunSettings& settings) {
  return run_chains(settings, [&](Rng& rng) {
    switch (posterior.dimension()) {
      case 1:
        return nuts_chain<1>(posterior, whitening, nuts, settings, rng);
      case 2:
        return nuts_chain<2>(posterior, whitening, nuts, settings, rng);
      case 3:
        return nuts_chain<3>(posterior, whitening, nuts, settings, rng);
      case 4:
        return nuts_chain<4>(posterior, whitening, nuts, settings, rng);
      default:
        return nuts_chain<Eigen::Dynamic>(posterior, whitening, nuts, settings, rng);
    }
  });
}

Draws run_metropolis(const Posterior& posterior, const Whitening& whitening,
                     const MetropolisSettings& metropolis, const RunSettings& settings) {
  return run_chains(settings, [&](Rng& rng) {
    const WhitenedDensity density(posterior, whitening);
    const Eigen::VectorXd u = random_start(density, rng);
    if (!metropolis.half_width) {
      return whitened_metropolis_chain(posterior, whitening, u, settings, rng);
    }
    Eigen::VectorXd start(posterior.dimension());
    posterior.to_natural(view(whitening(u)), view(start));
    return metropolis_chain(posterior, start, *metropolis.half_width, settings, rng);
  });
}

}  // namespace wearwell
