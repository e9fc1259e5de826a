#include "wearwell/models/formula_model/classical_quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/models/formula_model/formula_asked.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell::formula_model {
namespace {

using LifeValue = LifeDistribution::Known (*)(const LifeDistribution&, const WeightedDraws&,
                                              double);

std::string without_level(const std::string& name) {
  return name.substr(0, name.find('['));
}

double identity(double y) {
  return y;
}
double exponential(double y) {
  return std::exp(y);
}
double logistic(double y) {
  return from_normal_scale(NormalScale::logit, y);
}

ScaledQuantity life_quantity(const ClassicalLife& own, const std::string& name,
                             const Measured& measured, double (*value)(const LifeAtPoint&, double),
                             LifeValue posterior, double argument) {
  const bool positive = measured.form->positive;
  return {name,
          own.of,
          own.at,
          measured.unit,
          positive ? "log" : "natural",
          [life = own.life, value, argument, positive]() -> MaximumLikelihood::Quantity {
            return [at = std::make_shared<LifeAtPoint>(life->at_point()), life, value, argument,
                    positive](const double* x) {
              at->move_to(x);
              const double found = value(*at, argument);
              return positive ? std::log(found) : found;
            };
          },
          positive ? exponential : identity,
          [life = own.life, posterior, argument](const WeightedDraws& draws) {
            return posterior(*life, draws, argument).distribution;
          }};
}

// A quantile exceeds a life if the share that has failed by then is less.
MaximumLikelihood::Comparison quantile_comparison(std::shared_ptr<const LifeDistribution> life,
                                                  double p, bool positive) {
  const double height = std::log(-std::log1p(-p));
  return [at = std::make_shared<LifeAtPoint>(life->at_point()), life, height, positive](
             const double* x, double value) {
    constexpr double far = 700;
    at->move_to(x);
    const double failed = std::log(-at->log_survival(positive ? std::exp(value) : value));
    return height - std::clamp(failed, -far, far);
  };
}

// The share that survives, on the axis of the family's probability paper: there the bounds of
// survival and those of life are the same lines for a location-scale family.
ScaledQuantity survival_quantity(const ClassicalLife& own, const Quantity& life) {
  const Measured& measured = *own.measured;
  const bool several = own.life->is_earliest_of_several() || !measured.life.plain();
  const StandardDistribution paper =
      several ? StandardDistribution::smallest_extreme_value : measured.form->paper.distribution;
  return {"survival to " + description(life),
          own.of,
          own.at,
          Unit{"%", 0.01, 0},
          several ? "Weibull paper" : fmt::format("{} paper", measured.form->paper.name),
          [distribution = own.life, at_life = life.si(), paper]() -> MaximumLikelihood::Quantity {
            return [at = std::make_shared<LifeAtPoint>(distribution->at_point()), distribution,
                    at_life, paper](const double* x) {
              at->move_to(x);
              const double log_left = at->log_survival(at_life);
              if (paper == StandardDistribution::smallest_extreme_value) return std::log(-log_left);
              const double failed = at->cdf(at_life);
              return failed < 0.5 ? quantile(paper, failed)
                                  : upper_quantile(paper, std::exp(log_left));
            };
          },
          [paper](double z) { return std::exp(log_survival_and_slope(paper, z).value); },
          [distribution = own.life, at_life = life.si()](const WeightedDraws& draws) {
            return distribution->survival(draws, at_life).distribution;
          },
          false};
}

}  // namespace

NormalScale normal_scale(const FormulaModel& model, const Parameter& parameter) {
  for (const Measured& measured : model.measured) {
    for (std::size_t o = 0; o < measured.wanted.size(); ++o) {
      if (without_level(measured.wanted[o].text) != without_level(parameter.name)) continue;
      const std::size_t at = measured.family_parameter[o], k = at / most_response_parameters;
      if (k >= measured.life.families.size()) return NormalScale::logit;  // a share
      const ParameterForm& place =
          form_of(measured.life.families[k]).family_parameters[at % most_response_parameters];
      const bool positive =
          place.kind == ParameterKind::scale || place.kind == ParameterKind::number;
      return positive && place.name != "threshold" ? NormalScale::logarithm : NormalScale::natural;
    }
  }
  return parameter.prior.lower >= 0 ? NormalScale::logarithm : NormalScale::natural;
}

ScaledQuantity scaled_parameter(const Parameter& parameter, std::size_t i, NormalScale scale) {
  const bool logarithm = scale == NormalScale::logarithm, share = scale == NormalScale::logit;
  return {parameter.name,
          "",
          "",
          parameter.unit,
          logarithm ? "log"
          : share   ? "logit"
                    : "natural",
          {},
          logarithm ? exponential
          : share   ? logistic
                    : identity,
          [i](const WeightedDraws& draws) {
            return QuantityDistribution(draws, [i](const double* x) { return x[i]; });
          }};
}

std::vector<ScaledQuantity> scaled_quantities(const AskedOfClassics& asked) {
  const Measured& measured = asked.model->measured.front();
  std::vector<ScaledQuantity> all;
  for (const ClassicalLife& own : asked.lives) {
    for (const double percent : asked.percents) {
      all.push_back(life_quantity(
          own, b_life_name(percent), measured,
          [](const LifeAtPoint& at, double p) { return at.quantile(p); },
          [](const LifeDistribution& life, const WeightedDraws& draws, double p) {
            return life.quantile(draws, p);
          },
          percent / 100));
      all.back().compare = [life = own.life, percent, positive = measured.form->positive] {
        return quantile_comparison(life, percent / 100, positive);
      };
    }
    if (asked.mean)
      all.push_back(life_quantity(
          own, "mean life", measured,
          [](const LifeAtPoint& at, double from) { return at.mean_beyond(from); },
          [](const LifeDistribution& life, const WeightedDraws& draws, double from) {
            return life.mean_beyond(draws, from);
          },
          0));
    for (const Quantity& each : asked.survival) all.push_back(survival_quantity(own, each));
  }
  return all;
}

}  // namespace wearwell::formula_model
