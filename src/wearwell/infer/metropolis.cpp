#include "wearwell/infer/metropolis.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/math/view.h"

namespace wearwell {

Chain metropolis_chain(const Posterior& posterior, const Eigen::VectorXd& start,
                       const Eigen::VectorXd& half_width, bool tune, const RunSettings& settings,
                       Rng& rng) {
  constexpr double target = 0.35;
  const Eigen::Index d = start.size();
  Eigen::VectorXd x = start, proposal(d);
  double log_density = posterior.natural_value(view(x));
  double log_factor = 0, log_factor_sum = 0;
  const int averaged = settings.warmup / 2;
  long accepted = 0;

  Chain chain;
  chain.values.resize(settings.draws, d);
  chain.log_density.reserve(static_cast<std::size_t>(settings.draws));
  ProgressSteps steps(settings.progress);
  for (int i = -settings.warmup; i < settings.draws; ++i) {
    steps.step();
    const double factor = std::exp(log_factor);
    for (Eigen::Index j = 0; j < d; ++j) {
      proposal[j] = x[j] + factor * half_width[j] * rng.uniform(-1, 1);
    }
    const double proposed = posterior.natural_value(view(proposal));
    const bool accept = std::log(rng.uniform()) < proposed - log_density;
    if (accept) {
      x = proposal;
      log_density = proposed;
    }
    if (i < 0) {
      // Robbins-Monro with steps that fade; the factor kept is the average over the second half of
      // warm-up.
      if (!tune) continue;
      log_factor += (accept - target) / std::sqrt(i + settings.warmup + 1.0);
      if (i >= -averaged) log_factor_sum += log_factor;
      if (i == -1 && averaged > 0) log_factor = log_factor_sum / averaged;
      continue;
    }
    accepted += accept;
    chain.values.row(i) = x;
    chain.log_density.push_back(log_density);
  }
  chain.accept_rate = static_cast<double>(accepted) / settings.draws;
  for (Eigen::Index j = 0; j < d; ++j) {
    const Parameter& parameter = posterior.parameters()[static_cast<std::size_t>(j)];
    chain.notes.push_back(fmt::format("Half width of {} = {:.6g} {}", parameter.name,
                                      std::exp(log_factor) * half_width[j] / parameter.unit.scale,
                                      parameter.unit.text));
  }
  return chain;
}

}  // namespace wearwell
