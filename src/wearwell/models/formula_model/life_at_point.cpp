#include "wearwell/models/formula_model/life_at_point.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "wearwell/math/constants.h"
#include "wearwell/math/mean_beyond.h"

namespace wearwell::formula_model {

LifeAtPoint::LifeAtPoint(const Path& family_parameters, std::span<const std::size_t> places,
                         ResponseFamily family, bool positive)
    : places_(places),
      family_(family),
      positive_(positive),
      model_(*family_parameters.model),
      nodes_(model_.effects.size(), 6.5),
      new_units_(model_),
      path_(family_parameters) {
  family_parameters_.resize(most_response_parameters * size());
}

void LifeAtPoint::move_to(const double* x) {
  const std::size_t d = model_.effects.size(), count = nodes_.weight.size();
  for (std::size_t k = 0; k < new_units_.count(); ++k) {
    path_.move_to(new_units_.at(k, x, model_.parameters.size()));
    for (std::size_t at = 0; at < count; at += Path::most) {
      const std::size_t n = std::min(Path::most, count - at);
      path_.evaluate(n, d ? &nodes_.z[at * d] : nullptr, nullptr);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t o = 0; o < places_.size(); ++o) {
          family_parameters_[(k * count + at + i) * most_response_parameters + places_[o]] =
              path_.output(o, i);
        }
      }
    }
  }
}

double LifeAtPoint::weight(std::size_t i) const {
  const std::size_t count = nodes_.weight.size();
  return nodes_.weight[i % count] * new_units_.share(i / count);
}

double LifeAtPoint::cdf(double life) const {
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i)
    sum += weight(i) * std::exp(log_cdf(family_, life, slots(i)));
  return sum;
}

double LifeAtPoint::log_survival(double life) const {
  double most = -infinity, sum = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const double term = wearwell::log_survival(family_, life, slots(i));
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
    const double term = log_response_value(family_, {.at = life}, slots(i));
    if (size() == 1) return term;
    density += weight(i) * std::exp(term);
  }
  return std::log(density);
}

double LifeAtPoint::hazard(double life) const {
  return std::exp(log_density(life) - log_survival(life));
}

double LifeAtPoint::quantile(double p) const {
  if (size() == 1) return wearwell::quantile(family_, p, slots(0));
  const double middle = wearwell::quantile(family_, 0.5, slots(size() / 2));
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
  using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
  constexpr unsigned depth = 12;
  return logarithmic ? Rule::integrate(integrand, std::log(low), std::log(high), depth, 1e-8)
                     : Rule::integrate(integrand, low, high, depth, 1e-8);
}

}  // namespace wearwell::formula_model
