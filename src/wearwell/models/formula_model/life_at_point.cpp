#include "wearwell/models/formula_model/life_at_point.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "wearwell/math/constants.h"
#include "wearwell/math/mean_beyond.h"

namespace wearwell::formula_model {
namespace {

using LifeRule = boost::math::quadrature::gauss_kronrod<double, 31>;
constexpr unsigned deepest_cut = 12;

}  // namespace

double log_survival_of(std::span<const Risk> risks, double life, const double* family_parameters) {
  double sum = 0;
  for (std::size_t r = 0; r < risks.size(); ++r)
    sum += risks[r].life.log_survival(life, family_parameters + r * most_response_parameters);
  return sum;
}

// Several risks are plain families.
std::size_t parameters_of(std::span<const Risk> risks) {
  return risks.size() == 1 ? risks.front().life.parameters()
                           : risks.size() * most_response_parameters;
}

LifeAtPoint::LifeAtPoint(std::span<const Risk> risks)
    : risks_(risks),
      positive_(risks.front().positive),
      model_(*risks.front().family_parameters->model),
      nodes_(model_.effects.size(), 6.5),
      new_units_(model_),
      stride_(parameters_of(risks)) {
  for (const Risk& each : risks) paths_.emplace_back(*each.family_parameters);
  family_parameters_.resize(stride_ * size());
}

void LifeAtPoint::move_to(const double* x) {
  const std::size_t d = model_.effects.size(), count = nodes_.weight.size();
  for (std::size_t k = 0; k < new_units_.count(); ++k) {
    const double* const there = new_units_.at(k, x, model_.parameters.size());
    for (std::size_t r = 0; r < risks_.size(); ++r) {
      paths_[r].move_to(there);
      for (std::size_t at = 0; at < count; at += Path::most) {
        const std::size_t n = std::min(Path::most, count - at);
        paths_[r].evaluate(n, d ? &nodes_.z[at * d] : nullptr, nullptr);
        for (std::size_t i = 0; i < n; ++i) {
          double* const own =
              &family_parameters_[(k * count + at + i) * stride_ + r * most_response_parameters];
          for (std::size_t o = 0; o < risks_[r].places.size(); ++o)
            own[risks_[r].places[o]] = paths_[r].output(o, i);
        }
      }
    }
  }
}

double LifeAtPoint::weight(std::size_t i) const {
  const std::size_t count = nodes_.weight.size();
  return nodes_.weight[i % count] * new_units_.share(i / count);
}

double LifeAtPoint::log_survival(std::size_t component, double life) const {
  return log_survival_of(risks_, life, slots(component));
}

double LifeAtPoint::log_density(std::size_t component, double life) const {
  if (risks_.size() == 1) return risks_.front().life.log_density(life, slots(component));
  double hazard = 0;
  for (std::size_t r = 0; r < risks_.size(); ++r) {
    const double* const own = slots(component, r);
    hazard +=
        std::exp(risks_[r].life.log_density(life, own) - risks_[r].life.log_survival(life, own));
  }
  return std::log(hazard) + log_survival(component, life);
}

double LifeAtPoint::cdf(double life) const {
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    sum += weight(i) * (risks_.size() == 1 ? std::exp(risks_.front().life.log_cdf(life, slots(i)))
                                           : -std::expm1(log_survival(i, life)));
  }
  return sum;
}

double LifeAtPoint::log_survival(double life) const {
  double most = -infinity, sum = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const double term = log_survival(i, life);
    if (size() == 1) return term;
    if (term > most) {
      sum = sum * std::exp(most - term) + weight(i);
      most = term;
    } else if (term != -infinity) {
      sum += weight(i) * std::exp(term - most);
    }
  }
  return most + std::log(sum);
}

double LifeAtPoint::log_density(double life) const {
  double density = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const double term = log_density(i, life);
    if (size() == 1) return term;
    density += weight(i) * std::exp(term);
  }
  return std::log(density);
}

double LifeAtPoint::hazard(double life) const {
  return std::exp(log_density(life) - log_survival(life));
}

double LifeAtPoint::quantile(double p) const {
  if (single()) return risks_.front().life.quantile(p, slots(0));
  const auto earliest = [&](double share) {
    double least = infinity;
    for (std::size_t r = 0; r < risks_.size(); ++r)
      least = std::min(least, risks_[r].life.quantile(share, slots(size() / 2, r)));
    return least;
  };
  const auto failed = [&](double life) { return cdf(life); };
  if (risks_.size() == 1) return quantile_of_cdf(failed, p, earliest(0.5), positive_);
  // Before `least` each of m risks leaves at least the m-th root of 1 - p; at `most` one has ended p alone.
  const double root = -std::expm1(std::log1p(-p) / static_cast<double>(risks_.size()));
  const double least = earliest(root), most = earliest(p);
  if (!(least > 0) || !std::isfinite(most))
    return quantile_of_cdf(failed, p, earliest(0.5), positive_);
  const double half = 0.5 * std::log(most / least);
  return quantile_of_cdf(failed, p, std::sqrt(least) * std::sqrt(most), positive_, half + 1e-9);
}

double LifeAtPoint::middle() const {
  return single() ? risks_.front().life.middle(slots(0)) : quantile(0.5);
}

double LifeAtPoint::failing() const {
  return single() ? risks_.front().life.failing(slots(0)) : 1;
}

double LifeAtPoint::share_among_survivors(std::size_t k, double life) const {
  return risks_.front().life.share_among_survivors(k, life, slots(0));
}

double LifeAtPoint::mean_beyond(double from) const {
  if (failing() < 1) return infinity;
  // Of those that are not dead on arrival; these count as lives of 0.
  const double works = single() ? 1 - risks_.front().life.dead_share(slots(0)) : 1;
  const double mean = wearwell::mean_beyond(
      [&, log_works = std::log(works)](double life) { return log_survival(life) - log_works; },
      middle(), from);
  return from > 0 ? mean : works * mean;
}

double LifeAtPoint::outlives(const LifeAtPoint& other) const {
  constexpr double tail = 1e-10;
  // Those of the other that are dead on arrival end at 0.
  const double dead = other.single() ? other.risks_.front().life.dead_share(other.slots(0)) : 0;
  const double at_once = dead > 0 ? dead * std::exp(log_survival(0)) : 0;
  const double ending = other.failing() - dead;
  const double low = other.quantile(dead + tail * ending),
               high = other.quantile(dead + (1 - tail) * ending);
  if (!(low < high)) return at_once + ending * std::exp(log_survival(low));  // all have one life
  const bool logarithmic = positive_ && low > 0;
  const auto integrand = [&](double at) {
    const double life = logarithmic ? std::exp(at) : at;
    return std::exp(other.log_density(life) + log_survival(life) + (logarithmic ? at : 0));
  };
  // The rule adapts, because the integrand is a peak of any width.
  return at_once + (logarithmic ? LifeRule::integrate(integrand, std::log(low), std::log(high),
                                                      deepest_cut, 1e-8)
                                : LifeRule::integrate(integrand, low, high, deepest_cut, 1e-8));
}

double LifeAtPoint::incidence(std::size_t risk, double life) const {
  // What is left out at the ends, relative to the share of this risk alone.
  constexpr double before = 1e-9, beyond = 1e-13;
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const double* const own = slots(i, risk);
    const double alone = std::exp(risks_[risk].life.log_cdf(life, own));
    if (!(alone > 0)) continue;
    double end = life;
    for (std::size_t r = 0; r < risks_.size(); ++r)
      end = std::min(end, risks_[r].life.quantile(1 - beyond, slots(i, r)));
    const double begin = std::max(risks_[risk].life.quantile(before * alone, own), 1e-300);
    if (!(end > begin)) continue;
    const auto density = [&](double log_life) {
      const double here = std::exp(log_life);
      double log_share = risks_[risk].life.log_density(here, own) + log_life;
      for (std::size_t r = 0; r < risks_.size(); ++r)
        if (r != risk) log_share += risks_[r].life.log_survival(here, slots(i, r));
      return std::exp(log_share);
    };
    sum +=
        weight(i) * LifeRule::integrate(density, std::log(begin), std::log(end), deepest_cut, 1e-7);
  }
  return sum;
}

}  // namespace wearwell::formula_model
