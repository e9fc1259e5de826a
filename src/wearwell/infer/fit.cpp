#include "wearwell/infer/fit.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/infer/mode.h"

namespace wearwell {
namespace {

WeightedDraws pool(const Draws& draws) {
  Eigen::Index rows = 0;
  for (const Chain& chain : draws) rows += chain.values.rows();
  WeightedDraws pooled;
  pooled.values.resize(rows, draws.front().values.cols());
  pooled.weights = Eigen::VectorXd::Constant(rows, 1.0 / static_cast<double>(rows));
  Eigen::Index row = 0;
  for (const Chain& chain : draws) {
    pooled.values.middleRows(row, chain.values.rows()) = chain.values;
    row += chain.values.rows();
  }
  return pooled;
}

Draws draw(const Posterior& posterior, const Fit& fit, const FitSettings& settings) {
  switch (fit.method) {
    case Method::exact:
      return independent_draws(posterior, *fit.exact, settings.run.chains, settings.run.draws,
                               settings.run.seed, settings.run.first_stream);
    case Method::metropolis:
      return run_metropolis(posterior, fit.whitening, settings.metropolis, settings.run);
    case Method::nuts:
      break;
  }
  return run_nuts(posterior, fit.whitening, settings.nuts, settings.run);
}

}  // namespace

Chains chains_of(const Draws& draws, Eigen::Index parameter) {
  Chains chains;
  for (const Chain& chain : draws) {
    chains.draws.emplace_back(chain.values.col(parameter).data(),
                              static_cast<std::size_t>(chain.values.rows()));
  }
  return chains;
}

Fit fit(const Posterior& posterior, const FitSettings& settings) {
  const Mode mode = find_mode(posterior, posterior.start());
  Fit fit{settings.method,
          whitening_at(mode),
          tails(posterior, mode),
          {},
          {},
          {},
          {},
          {},
          settings.nuts.max_treedepth};

  const auto all = [&](auto property) {
    return std::all_of(fit.tails.begin(), fit.tails.end(), property);
  };
  if (posterior.dimension() > max_exact_dimension) {
    fit.no_exact = fmt::format("{} parameters are more than quadrature reaches ({})",
                               posterior.dimension(), max_exact_dimension);
  } else if (!all([](const Tail& t) { return t.integrable(); })) {
    fit.no_exact = "the posterior is improper";
  } else {
    ExactSettings exact = settings.exact;
    exact.second_moments = all([](const Tail& t) { return t.has_moment(2); });
    ExactPosterior integral = integrate(posterior, fit.whitening, exact);
    if (integral.failure.empty()) {
      fit.exact = std::move(integral);
    } else {
      fit.no_exact = integral.failure;
    }
  }
  if (fit.method == Method::exact && !fit.exact) fit.method = Method::nuts;
  fit.draws = draw(posterior, fit, settings);
  fit.pooled = pool(fit.draws);
  for (int i = 0; i < posterior.dimension(); ++i) {
    fit.diagnostics.push_back(diagnose(chains_of(fit.draws, i)));
  }
  return fit;
}

}  // namespace wearwell
