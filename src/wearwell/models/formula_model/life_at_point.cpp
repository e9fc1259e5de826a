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
    sum += log_survival(risks[r].family, life, family_parameters + r * most_response_parameters);
  return sum;
}

LifeAtPoint::LifeAtPoint(std::span<const Risk> risks)
    : risks_(risks),
      positive_(risks.front().positive),
      model_(*risks.front().family_parameters->model),
      nodes_(model_.effects.size(), 6.5),
      new_units_(model_) {
  for (const Risk& each : risks) paths_.emplace_back(*each.family_parameters);
  family_parameters_.resize(most_response_parameters * risks.size() * size());
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
          double* const own = &family_parameters_[((k * count + at + i) * risks_.size() + r) *
                                                  most_response_parameters];
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
  if (risks_.size() == 1)
    return log_response_value(risks_.front().family, {.at = life}, slots(component));
  double hazard = 0;
  for (std::size_t r = 0; r < risks_.size(); ++r) {
    const double* const own = slots(component, r);
    hazard += std::exp(log_response_value(risks_[r].family, {.at = life}, own) -
                       wearwell::log_survival(risks_[r].family, life, own));
  }
  return std::log(hazard) + log_survival(component, life);
}

double LifeAtPoint::cdf(double life) const {
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    sum +=
        weight(i) * (risks_.size() == 1 ? std::exp(log_cdf(risks_.front().family, life, slots(i)))
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
  if (single()) return wearwell::quantile(risks_.front().family, p, slots(0));
  double middle = infinity;
  for (std::size_t r = 0; r < risks_.size(); ++r)
    middle = std::min(middle, wearwell::quantile(risks_[r].family, 0.5, slots(size() / 2, r)));
  return quantile_of_cdf([&](double y) { return cdf(y); }, p, middle, positive_);
}

double LifeAtPoint::mean_beyond(double from) const {
  return wearwell::mean_beyond([&](double life) { return log_survival(life); }, quantile(0.5),
                               from);
}

double LifeAtPoint::outlives(const LifeAtPoint& other) const {
  constexpr double tail = 1e-10;
  const double low = other.quantile(tail), high = other.quantile(1 - tail);
  if (!(low < high)) return std::exp(log_survival(low));  // all of the other have one life
  const bool logarithmic = positive_ && low > 0;
  const auto integrand = [&](double at) {
    const double life = logarithmic ? std::exp(at) : at;
    return std::exp(other.log_density(life) + log_survival(life) + (logarithmic ? at : 0));
  };
  // The rule adapts, because the integrand is a peak of any width.
  return logarithmic
             ? LifeRule::integrate(integrand, std::log(low), std::log(high), deepest_cut, 1e-8)
             : LifeRule::integrate(integrand, low, high, deepest_cut, 1e-8);
}

double LifeAtPoint::incidence(std::size_t risk, double life) const {
  constexpr double tail = 1e-10;
  const double low = quantile(tail);
  if (!(life > low)) return 0;
  const auto integrand = [&](double at) {
    const double here = std::exp(at);
    double sum = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      const double* const own = slots(i, risk);
      const double share = std::exp(log_response_value(risks_[risk].family, {.at = here}, own) -
                                    wearwell::log_survival(risks_[risk].family, here, own) +
                                    log_survival(i, here) + at);
      if (share > 0) sum += weight(i) * share;
    }
    return sum;
  };
  const double end = std::min(life, quantile(1 - tail));
  return LifeRule::integrate(integrand, std::log(low), std::log(end), deepest_cut, 1e-8);
}

}  // namespace wearwell::formula_model
