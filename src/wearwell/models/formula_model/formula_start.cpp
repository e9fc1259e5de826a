#include "wearwell/models/formula_model/formula_start.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/maximize.h"
#include "wearwell/infer/mode.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/view.h"

namespace wearwell::formula_model {
namespace {

// A non-owning view of the likelihood.
std::shared_ptr<const LogDensity> borrowed(const LogDensity& density) {
  return {std::shared_ptr<const LogDensity>(), &density};
}

// Values of one parameter from u in (0, 1): quantiles of its prior, or if that is improper, orders
// of magnitude around one of its unit.
class Spread {
 public:
  explicit Spread(const Parameter& parameter)
      : model_(parameter.prior), unit_(parameter.unit.scale) {
    if (!model_.proper) return;
    for (int i = 0; i < levels; ++i) table_.push_back(quantile(model_, (i + 0.5) / levels));
  }

  double operator()(double u) const {
    if (model_.proper) return table_[static_cast<std::size_t>(u * levels)];
    const bool low = std::isfinite(model_.lower), high = std::isfinite(model_.upper);
    if (low && high) return model_.lower + u * (model_.upper - model_.lower);
    constexpr double decades = 12;
    const double size = unit_ * std::pow(10, decades * (u - 0.5));
    if (low) return model_.lower + size;
    if (high) return model_.upper - size;
    const double v = 2 * u - 1;
    return std::copysign(unit_ * std::pow(10, decades * (std::abs(v) - 0.5)), v);
  }

 private:
  static constexpr int levels = 21;
  const Distribution& model_;
  double unit_;
  std::vector<double> table_;
};

struct Candidate {
  std::vector<double> x;
  double log_density = 0;
};

double log_density_at(const LogDensity& likelihood, const std::vector<Parameter>& parameters,
                      const std::vector<double>& x) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(parameters[i].prior.lower < x[i] && x[i] < parameters[i].prior.upper)) return -infinity;
    sum += log_density(parameters[i].prior, x[i]).value;
  }
  const double all = sum + likelihood.value(x);
  return all < infinity ? all : -infinity;
}

std::vector<Candidate> candidates(const LogDensity& likelihood,
                                  const std::vector<Parameter>& parameters) {
  const std::size_t d = parameters.size();
  std::vector<Candidate> all(1);
  for (const Parameter& each : parameters) all[0].x.push_back(each.start);
  std::vector<Spread> spreads(parameters.begin(), parameters.end());
  // The additive sequence of Roberts: powers of the root of t^(d+1) = t + 1.
  double root = 1.5;
  for (int i = 0; i < 60; ++i) root = std::pow(1 + root, 1 / (static_cast<double>(d) + 1));
  const std::size_t count = std::min<std::size_t>(60 * d, 400);
  for (std::size_t n = 1; n <= count; ++n) {
    Candidate next;
    double alpha = 1;
    for (std::size_t i = 0; i < d; ++i) {
      alpha /= root;
      double whole = 0;
      next.x.push_back(spreads[i](std::modf(0.5 + static_cast<double>(n) * alpha, &whole)));
    }
    all.push_back(std::move(next));
  }
  for (Candidate& each : all) each.log_density = log_density_at(likelihood, parameters, each.x);
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    return a.log_density > b.log_density;
  });
  return all;
}

// Where the prior is improper, the size comes from the current value.
std::vector<Parameter> started_at(std::vector<Parameter> parameters, const std::vector<double>& x) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    Parameter& each = parameters[i];
    each.start = x[i];
    if (each.prior.proper) continue;
    const double bound = std::isfinite(each.prior.lower)   ? each.prior.lower
                         : std::isfinite(each.prior.upper) ? each.prior.upper
                                                           : 0;
    const double size = std::abs(x[i] - bound);
    each.scale = size > 0 ? size : each.unit.scale;
  }
  return parameters;
}

// Prior times likelihood on the real line, without the Jacobian: under flat priors the likelihood,
// which has a maximum even if the density on the real line grows without bound (an improper
// posterior).
class WithoutJacobian final : public LogDensity {
 public:
  explicit WithoutJacobian(const Posterior& posterior) : posterior_(posterior) {}
  int dimension() const override { return posterior_.dimension(); }
  double value(std::span<const double> z) const override {
    std::vector<double> x(z.size());
    posterior_.to_natural(z, x);
    return posterior_.natural_value(x);
  }
  double value_and_gradient(std::span<const double> z, std::span<double> gradient) const override {
    std::vector<double> x(z.size());
    posterior_.to_natural(z, x);
    const double value = posterior_.natural_value_and_gradient(x, gradient);
    for (std::size_t i = 0; i < z.size(); ++i)
      gradient[i] *= posterior_.transforms()[i].from_real(z[i]).slope;
    return value;
  }

 private:
  const Posterior& posterior_;
};

// From the best candidates to a maximum of the likelihood; empty if no climb converges.
std::optional<std::vector<double>> likeliest(const LogDensity& likelihood,
                                             const std::vector<Parameter>& parameters,
                                             const std::vector<Candidate>& from) {
  constexpr std::size_t climbs = 6;
  const auto n = static_cast<Eigen::Index>(parameters.size());
  const Box everywhere{Eigen::VectorXd::Constant(n, -infinity),
                       Eigen::VectorXd::Constant(n, infinity)};
  std::optional<std::vector<double>> best;
  double highest = -infinity;
  for (std::size_t c = 0; c < std::min(climbs, from.size()); ++c) {
    if (!(from[c].log_density > -infinity)) break;
    const Posterior posterior(started_at(parameters, from[c].x), borrowed(likelihood));
    const Maximum summit = maximize(WithoutJacobian(posterior), posterior.start(),
                                    Eigen::VectorXd::Ones(n), everywhere, 1e-6);
    if (!summit.converged || !(summit.value > highest)) continue;
    std::vector<double> x(parameters.size());
    posterior.to_natural(view(summit.x), x);
    if (!(log_density_at(likelihood, parameters, x) > -infinity)) continue;
    highest = summit.value;
    best = std::move(x);
  }
  return best;
}

}  // namespace

void start_at(const std::map<std::string, double>& known, std::vector<Parameter>& parameters) {
  std::vector<double> x;
  for (const Parameter& each : parameters) {
    const auto value = known.find(each.name);
    x.push_back(value == known.end() ? each.start : value->second);
  }
  parameters = started_at(std::move(parameters), x);
}

void find_starts(const LogDensity& likelihood, std::vector<Parameter>& parameters) {
  constexpr std::size_t climbs = 4;
  const std::vector<Candidate> from = candidates(likelihood, parameters);
  if (!(from.front().log_density > -infinity)) return;  // the posterior decides
  std::vector<Parameter> best = started_at(parameters, from.front().x);
  double highest = -infinity;
  const auto n = static_cast<Eigen::Index>(parameters.size());
  const Box everywhere{Eigen::VectorXd::Constant(n, -infinity),
                       Eigen::VectorXd::Constant(n, infinity)};
  for (std::size_t c = 0; c < std::min(climbs, from.size()); ++c) {
    if (!(from[c].log_density > -infinity)) break;
    const std::vector<Parameter> here = started_at(parameters, from[c].x);
    const Posterior posterior(here, borrowed(likelihood));
    const Maximum summit =
        maximize(posterior, posterior.start(), Eigen::VectorXd::Ones(n), everywhere, 1e-6);
    if (!std::isfinite(summit.value) || !(summit.value > highest + 1e-3)) continue;
    std::vector<double> x(parameters.size());
    posterior.to_natural(view(summit.x), x);
    if (!(log_density_at(likelihood, parameters, x) > -infinity)) continue;
    highest = summit.value;
    best = started_at(here, x);
    // On the whole line a width is a better size than a distance from 0.
    for (Eigen::Index i = 0; i < n; ++i) {
      Parameter& each = best[static_cast<std::size_t>(i)];
      const bool free = std::isinf(each.prior.lower) && std::isinf(each.prior.upper);
      const double bend = summit.curvature(i, i);
      if (each.prior.proper || !free || !(bend > 0)) continue;
      const double width = here[static_cast<std::size_t>(i)].scale / std::sqrt(bend);
      if (std::isfinite(width) && width > 0) each.scale = width;
    }
  }
  // Under flat priors the density on the real line may grow without bound; a climb that follows it
  // ends at overflow, where the likelihood is low.
  constexpr double far_below = 5;
  const bool flat = std::any_of(parameters.begin(), parameters.end(),
                                [](const Parameter& each) { return !each.prior.proper; });
  if (flat) {
    std::vector<double> x;
    for (const Parameter& each : best) x.push_back(each.start);
    const double here = log_density_at(likelihood, parameters, x);
    const auto there = likeliest(likelihood, parameters, from);
    if (there && !(here > log_density_at(likelihood, parameters, *there) - far_below))
      best = started_at(parameters, *there);
  }
  parameters = std::move(best);
}

}  // namespace wearwell::formula_model
