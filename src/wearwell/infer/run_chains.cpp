#include "wearwell/infer/run_chains.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/infer/diagnostics.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/independence_sampler.h"
#include "wearwell/infer/maxima_mixture.h"
#include "wearwell/infer/metropolis.h"
#include "wearwell/infer/nuts.h"
#include "wearwell/infer/warmup.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// As in Stan: uniform on (-2, 2) in every direction, until inside the support with a finite
// gradient.
Eigen::VectorXd random_start(const LogDensity& whitened, Rng& rng) {
  Eigen::VectorXd u(whitened.dimension()), slope(whitened.dimension());
  for (int attempt = 0; attempt < 100; ++attempt) {
    for (double& each : u) each = rng.uniform(-2, 2);
    if (std::isfinite(whitened.value(view(u))) &&
        std::isfinite(whitened.value_and_gradient(view(u), view(slope))))
      return u;
  }
  throw InputError(
      "no start with a positive posterior density and a finite gradient in 100 attempts; check the "
      "units of data and priors");
}

// Starts about the maximum of chain c, in the coordinates of `whitening`.
Eigen::VectorXd random_start(const Posterior& posterior, const Whitening& whitening,
                             std::span<const LocalMaximum> maxima, std::size_t c, Rng& rng) {
  if (maxima.size() < 2) return random_start(WhitenedDensity(posterior, whitening), rng);
  const Whitening own = whitening_at(maxima[c % maxima.size()].mode);
  const Eigen::VectorXd u = random_start(WhitenedDensity(posterior, own), rng);
  return whitening.scale.partialPivLu().solve(own(u) - whitening.center);
}

// Jumps between maxima: an independence sampler (Tierney 1994, section 2.3).
class MaximaJumps {
 public:
  MaximaJumps(const Whitening& whitening, std::span<const LocalMaximum> maxima)
      : mixture_(maxima, freedom, evenly), whitening_(whitening), to_u_(whitening.scale) {}

  // The accepted position from u with density `log_density`; empty if it stays.
  std::optional<Eigen::VectorXd> jump(const WhitenedDensity& density, const Eigen::VectorXd& u,
                                      double log_density, Rng& rng) const {
    std::optional<Eigen::VectorXd> moved;
    const Eigen::VectorXd from = whitening_(u);
    double here = log_density - mixture_.log_density(view(from));
    for (int i = 0; i < proposals; ++i) {
      const Eigen::VectorXd z = mixture_.draw(rng);
      const double proposed = mixture_.log_density(view(z)), least = here + std::log(rng.uniform());
      const Eigen::VectorXd there = to_u_.solve(z - whitening_.center);
      const double value = density.value_above(view(there), least + proposed) - proposed;
      if (!(value > least)) continue;
      here = value;
      moved = there;
    }
    return moved;
  }

 private:
  static constexpr double freedom = 5, evenly = 0.3;
  static constexpr int proposals = 2;
  MaximaMixture mixture_;
  const Whitening& whitening_;
  Eigen::PartialPivLU<Eigen::MatrixXd> to_u_;
};

template <class RunChain>
Draws run_chains(const RunSettings& settings, const RunChain& run_chain) {
  Draws draws(static_cast<std::size_t>(settings.chains));
  tbb::parallel_for(0, settings.chains, [&](int c) {
    Rng rng(settings.seed, settings.first_stream + static_cast<std::uint64_t>(c));
    draws[static_cast<std::size_t>(c)] = run_chain(rng, static_cast<std::size_t>(c));
  });
  return draws;
}

// A chain of NUTS.
template <int N>
class NutsChain {
 public:
  NutsChain(const Posterior& posterior, const Whitening& whitening, const NutsSettings& options,
            const RunSettings& settings, std::size_t c, std::span<const LocalMaximum> maxima)
      : posterior_(posterior),
        whitening_(whitening),
        settings_(settings),
        rng_(settings.seed, settings.first_stream + c),
        density_(posterior, whitening),
        nuts_(density_, options.dense_metric, options.max_treedepth),
        warmup_(settings.warmup, options.target_accept),
        steps_(settings.progress) {
    if (maxima.size() > 1) jumps_.emplace(whitening, maxima);
    nuts_.set_position(random_start(posterior, whitening, maxima, c, rng_));
    nuts_.find_reasonable_step_size(rng_);
  }

  // Runs iterations of the warm-up; optionally keeps the second half.
  void warm_up(int iterations, bool keeps) {
    const int first = keeps ? iterations / 2 : iterations;
    late_.values.resize(iterations - first, posterior_.dimension());
    for (int i = 0; i < iterations; ++i) {
      warmup_.adapt(warmed_++, transition(), nuts_, rng_);
      if (i >= first) late_.values.row(i - first) = natural();
      steps_.step();
    }
    if (warmed_ > 0 && warmed_ == settings_.warmup) warmup_.finish(nuts_);
  }
  const Chain& late() const { return late_; }

  Chain drawn() {
    Chain chain;
    chain.values.resize(settings_.draws, posterior_.dimension());
    chain.nuts.reserve(static_cast<std::size_t>(settings_.draws));
    chain.log_density.reserve(static_cast<std::size_t>(settings_.draws));
    double accept = 0;
    for (int i = 0; i < settings_.draws; ++i) {
      chain.nuts.push_back(transition());
      accept += chain.nuts.back().accept_stat;
      chain.values.row(i) = natural();
      chain.log_density.push_back(nuts_.point().log_density);
      steps_.step();
    }
    chain.accept_rate = accept / settings_.draws;
    chain.step_size = nuts_.step_size;
    return chain;
  }

 private:
  NutsStep transition() {
    if (jumps_) {
      const auto& point = nuts_.point();
      if (auto there = jumps_->jump(density_, point.position, point.log_density, rng_))
        nuts_.move_to(*there);
    }
    return nuts_.step(rng_);
  }

  Eigen::VectorXd natural() const {
    Eigen::VectorXd x(posterior_.dimension());
    posterior_.to_natural(view(whitening_(nuts_.point().position)), view(x));
    return x;
  }

  const Posterior& posterior_;
  const Whitening& whitening_;
  const RunSettings& settings_;
  Rng rng_;
  WhitenedDensity density_;
  Nuts<N> nuts_;
  WindowedWarmup<N> warmup_;
  ProgressSteps steps_;
  std::optional<MaximaJumps> jumps_;
  int warmed_ = 0;
  Chain late_;
};

// Whether the requested draws will probably suffice, judged from late warm-up.
bool promising(const Draws& late, int draws) {
  constexpr double most_rhat = 1.05, least = 125;  // effective draws per chain
  const auto length = static_cast<double>(late.front().values.rows());
  for (Eigen::Index i = 0; i < late.front().values.cols(); ++i) {
    const Diagnostics d = diagnose(chains_of(late, i));
    const double expected = std::min(d.ess_bulk, d.ess_tail) / length * draws;
    if (!(d.rhat <= most_rhat && expected >= least * static_cast<double>(late.size())))
      return false;
  }
  return true;
}

template <int N>
Draws nuts_chains(const Posterior& posterior, const Whitening& whitening,
                  const NutsSettings& options, const RunSettings& settings,
                  bool may_propose_independently, std::span<const LocalMaximum> maxima) {
  std::vector<std::unique_ptr<NutsChain<N>>> chains(static_cast<std::size_t>(settings.chains));
  // With a proposal mixture, transitions need fewer evaluations.
  const bool independence = may_propose_independently && posterior.likelihood()->is_slow();
  const int first = settings.warmup / (independence ? 4 : 2);
  for (const int iterations : {first, settings.warmup - first}) {
    tbb::parallel_for(std::size_t{0}, chains.size(), [&](std::size_t c) {
      if (!chains[c])
        chains[c] =
            std::make_unique<NutsChain<N>>(posterior, whitening, options, settings, c, maxima);
      chains[c]->warm_up(iterations, may_propose_independently);
    });
    if (!may_propose_independently) continue;
    Draws late;
    for (const auto& chain : chains) late.push_back(chain->late());
    if (independence || !promising(late, settings.draws))
      return run_independence(posterior, late, options, settings);
  }
  Draws draws(chains.size());
  tbb::parallel_for(std::size_t{0}, chains.size(),
                    [&](std::size_t c) { draws[c] = chains[c]->drawn(); });
  return draws;
}

Draws nuts_chains(const Posterior& posterior, const Whitening& whitening,
                  const NutsSettings& options, const RunSettings& settings,
                  bool may_propose_independently, std::span<const LocalMaximum> maxima = {}) {
  switch (posterior.dimension()) {
    case 1:
      return nuts_chains<1>(posterior, whitening, options, settings, may_propose_independently,
                            maxima);
    case 2:
      return nuts_chains<2>(posterior, whitening, options, settings, may_propose_independently,
                            maxima);
    case 3:
      return nuts_chains<3>(posterior, whitening, options, settings, may_propose_independently,
                            maxima);
    case 4:
      return nuts_chains<4>(posterior, whitening, options, settings, may_propose_independently,
                            maxima);
    default:
      return nuts_chains<Eigen::Dynamic>(posterior, whitening, options, settings,
                                         may_propose_independently, maxima);
  }
}

}  // namespace

Draws run_nuts(const Posterior& posterior, const Whitening& whitening, const NutsSettings& nuts,
               const RunSettings& settings, std::span<const LocalMaximum> maxima) {
  return nuts_chains(posterior, whitening, nuts, settings, false, maxima);
}

Draws run_nuts_or_independence(const Posterior& posterior, const Whitening& whitening,
                               const NutsSettings& nuts, const RunSettings& settings) {
  return nuts_chains(posterior, whitening, nuts, settings, true);
}

Draws run_metropolis(const Posterior& posterior, const Whitening& whitening,
                     const MetropolisSettings& metropolis, const RunSettings& settings,
                     std::span<const LocalMaximum> maxima) {
  return run_chains(settings, [&](Rng& rng, std::size_t c) {
    const Eigen::VectorXd u = random_start(posterior, whitening, maxima, c, rng);
    if (!metropolis.half_width) {
      return whitened_metropolis_chain(posterior, whitening, u, settings, rng);
    }
    Eigen::VectorXd start(posterior.dimension());
    posterior.to_natural(view(whitening(u)), view(start));
    return metropolis_chain(posterior, start, *metropolis.half_width, settings, rng);
  });
}

}  // namespace wearwell
