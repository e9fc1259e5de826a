#include "wearwell/models/formula_model/formula_life.h"

#include <cmath>

#include "wearwell/math/mean_beyond.h"
#include "wearwell/math/root.h"
#include "wearwell/models/formula_model/effect_lines.h"
#include "wearwell/models/formula_model/formula_drawn.h"
#include "wearwell/models/formula_model/formula_lives.h"
#include "wearwell/predict/interpolated.h"
#include "wearwell/predict/prediction.h"
#include "wearwell/predict/thinned_posterior.h"

namespace wearwell::formula_model {
namespace {

// If items survive to this point more rarely, the rest is undetermined.
constexpr double least_survival = 1e-3;

constexpr std::size_t thinned_posterior = 2000;

std::size_t some(std::size_t most, double share) {
  return static_cast<std::size_t>(share * static_cast<double>(most));
}

double probability(ResponseFamily family, double life, const double* family_parameters) {
  return std::exp(log_cdf(family, life, family_parameters));
}

// The quantile p of a cdf; in the logarithm for positive values.
template <class F>
double solve(const F& cdf, double p, double middle, bool positive) {
  if (!std::isfinite(middle)) return std::nan("");
  if (!positive) {
    return solve_increasing([&](double y) { return cdf(y) - p; }, middle,
                            std::max(1e-3 * std::abs(middle), 1e-12), {.relative = 1e-10});
  }
  return std::exp(solve_increasing([&](double log_y) { return cdf(std::exp(log_y)) - p; },
                                   std::log(middle), 0.5, {.absolute = 1e-10}, -700, 700));
}

}  // namespace

// The distribution parameters at one point, over the population.
class LifeDistribution::AtPoint {
 public:
  explicit AtPoint(const LifeDistribution& life)
      : life_(life),
        nodes_(life.family_parameters_->model->effects.size(), 6.5),
        new_units_(*life.family_parameters_->model),
        path_(*life.family_parameters_) {
    family_parameters_.resize(most_response_parameters * size());
  }

  void move_to(const double* x) {
    const FormulaModel& model = *life_.family_parameters_->model;
    const std::size_t d = model.effects.size(), count = nodes_.weight.size();
    for (std::size_t k = 0; k < new_units_.count(); ++k) {
      path_.move_to(new_units_.at(k, x, model.parameters.size()));
      for (std::size_t at = 0; at < count; at += Path::most) {
        const std::size_t n = std::min(Path::most, count - at);
        path_.evaluate(n, d ? &nodes_.z[at * d] : nullptr, nullptr);
        for (std::size_t i = 0; i < n; ++i) {
          for (std::size_t o = 0; o < life_.family_parameter_.size(); ++o) {
            family_parameters_[(k * count + at + i) * most_response_parameters +
                               life_.family_parameter_[o]] = path_.output(o, i);
          }
        }
      }
    }
  }

  std::size_t size() const { return nodes_.weight.size() * new_units_.count(); }
  double weight(std::size_t i) const {
    const std::size_t count = nodes_.weight.size();
    return nodes_.weight[i % count] * new_units_.share(i / count);
  }
  const double* slots(std::size_t i) const {
    return &family_parameters_[i * most_response_parameters];
  }

  double cdf(double life) const {
    double sum = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      sum += weight(i) * probability(life_.family_, life, slots(i));
    }
    return sum;
  }

  double log_left(double life) const {
    double most = -infinity, sum = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      const double term = log_survival(life_.family_, life, slots(i));
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

  double mean_beyond(double from) const {
    return wearwell::mean_beyond([&](double life) { return log_left(life); }, quantile(0.5), from);
  }

  // Density over survival; for a single distribution in logarithms, so that it stays finite far in
  // the tail.
  double hazard(double life) const {
    double failing = 0, left = 0, one = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      const double density = log_response_value(life_.family_, {.at = life}, slots(i));
      const double survival = log_survival(life_.family_, life, slots(i));
      failing += weight(i) * std::exp(density);
      left += weight(i) * std::exp(survival);
      one = std::exp(density - survival);
    }
    return size() == 1 ? one : failing / left;
  }

  double quantile(double p) const {
    if (size() == 1) return wearwell::quantile(life_.family_, p, slots(0));
    const double middle = wearwell::quantile(life_.family_, 0.5, slots(size() / 2));
    return solve([&](double y) { return cdf(y); }, p, middle, life_.positive_);
  }

 private:
  const LifeDistribution& life_;
  NormalNodes nodes_;
  NewUnits new_units_;
  PathAt path_;
  std::vector<double> family_parameters_;
};

std::string per_unit(const Unit& unit) {
  if (unit.text == "1") return "1";
  const bool one = unit.text.find_first_of(" */.^") == std::string::npos;
  return one ? "1/" + unit.text : "1/(" + unit.text + ")";
}

LifeDistribution::LifeDistribution(std::shared_ptr<const Path> family_parameters,
                                   const Measured& measured)
    : family_parameters_(std::move(family_parameters)),
      family_(measured.form->family),
      positive_(measured.form->positive),
      family_parameter_(measured.family_parameter) {}

double LifeDistribution::Next::cdf(double life) const {
  double sum = 0;
  for (const Component& each : components_) {
    sum += each.weight * probability(family_, life, each.family_parameter);
  }
  return sum;
}

double LifeDistribution::Next::quantile(double p) const {
  return solve([&](double y) { return cdf(y); }, p, middle_, positive_);
}

double LifeDistribution::Next::quantile(double p, double from) const {
  const double gone = cdf(from);
  if (1 - gone < least_survival) return std::nan("");
  return quantile(gone + p * (1 - gone)) - from;
}

bool LifeDistribution::over_all() const {
  return family_parameters_->model->effects.empty();
}

LifeDistribution::Next LifeDistribution::next(const WeightedDraws& draws,
                                              double share_of_points) const {
  AtPoint at(*this);
  Next next;
  next.family_ = family_;
  next.positive_ = positive_;
  const ThinnedPosterior few(draws, at.size() == 1 ? 20'000 : some(1000, share_of_points));
  for (std::size_t i = 0; i < few.weights.size(); ++i) {
    at.move_to(few.values.row(static_cast<Eigen::Index>(i)).data());
    if (i == 0) next.middle_ = at.quantile(0.5);
    for (std::size_t j = 0; j < at.size(); ++j) {
      if (at.weight(j) < 1e-9) continue;
      Next::Component component{few.weights[i] * at.weight(j), {}};
      std::copy_n(at.slots(j), most_response_parameters, component.family_parameter);
      next.components_.push_back(component);
    }
  }
  return next;
}

// If every point needs an equation solved, few are used.
WeightedDraws LifeDistribution::points(const WeightedDraws& draws, double share_of_points) const {
  if (over_all()) return draws;
  ThinnedPosterior few(draws, some(thinned_posterior, share_of_points));
  WeightedDraws result;
  result.values = std::move(few.values);
  result.weights = Eigen::Map<const Eigen::VectorXd>(few.weights.data(),
                                                     static_cast<Eigen::Index>(few.weights.size()));
  return result;
}

LifeDistribution::Known LifeDistribution::undetermined(const WeightedDraws& draws) {
  return {{draws, [](const double*) { return std::nan(""); }}};
}

// A quantity derived from the parameters; if it is expensive, it is evaluated at few points.
template <class Value>
LifeDistribution::Known LifeDistribution::over(const WeightedDraws& draws, const Value& value,
                                               double share_of_points) const {
  if (over_all()) return {{draws, value}};
  const ThinnedPosterior few(draws, some(thinned_posterior, share_of_points));
  Points at_few(few.values.rows(), 1);
  for (Eigen::Index i = 0; i < at_few.rows(); ++i) at_few(i, 0) = value(few.values.row(i).data());
  if (share_of_points == 1) {
    if (auto whole = interpolated(draws, few, at_few).front())
      return {std::move(whole->distribution), whole->misfit};
  }
  WeightedDraws points;
  points.values = at_few;
  points.weights = Eigen::Map<const Eigen::VectorXd>(few.weights.data(), at_few.rows());
  return {{points, [](const double* x) { return x[0]; }}};
}

LifeDistribution::Known LifeDistribution::quantile(const WeightedDraws& draws, double p,
                                                   double share_of_points) const {
  AtPoint at(*this);
  return over(
      draws,
      [&](const double* x) {
        at.move_to(x);
        return at.quantile(p);
      },
      share_of_points);
}

std::optional<WeightedDraws> LifeDistribution::survivors(const WeightedDraws& draws, double from,
                                                         double share_of_points) const {
  AtPoint at(*this);
  WeightedDraws given = points(draws, share_of_points);
  std::vector<double> left;
  for (Eigen::Index i = 0; i < given.values.rows(); ++i) {
    at.move_to(given.values.row(i).data());
    left.push_back(1 - at.cdf(from));
  }
  const Eigen::Map<const Eigen::VectorXd> share(left.data(),
                                                static_cast<Eigen::Index>(left.size()));
  if (!(given.weights.dot(share) >= least_survival)) return {};
  given.weights.array() *= share.array();
  given.weights /= given.weights.sum();
  if (given.has_cells()) {
    given.cells.mass.array() *= share.head(given.cells.mass.size()).array();
    given.cells.mass /= given.cells.mass.sum();
  }
  return given;
}

LifeDistribution::Known LifeDistribution::quantile_beyond(const WeightedDraws& draws, double p,
                                                          double from,
                                                          double share_of_points) const {
  const auto given = survivors(draws, from, share_of_points);
  if (!given) return undetermined(draws);
  AtPoint at(*this);
  return {{*given, [&](const double* x) {
             at.move_to(x);
             const double gone = at.cdf(from);
             // If none survives the value does not count, but it must be a number.
             return gone < 1 ? at.quantile(gone + p * (1 - gone)) - from : 0;
           }}};
}

LifeDistribution::Known LifeDistribution::mean_beyond(const WeightedDraws& draws, double from,
                                                      double share_of_points) const {
  AtPoint at(*this);
  const auto value = [&](const double* x) {
    at.move_to(x);
    const double mean = at.mean_beyond(from);
    return std::isnan(mean) && at.cdf(from) == 1 ? 0 : mean;  // of a point that does not count
  };
  if (!(from > 0)) return over(draws, value, share_of_points);
  const auto given = survivors(draws, from, share_of_points);
  return given ? Known{{*given, value}} : undetermined(draws);
}

LifeDistribution::Known LifeDistribution::survival(const WeightedDraws& draws, double life,
                                                   double share_of_points) const {
  AtPoint at(*this);
  return over(
      draws,
      [&](const double* x) {
        at.move_to(x);
        return 1 - at.cdf(life);
      },
      share_of_points);
}

LifeDistribution::Known LifeDistribution::hazard(const WeightedDraws& draws, double life,
                                                 double share_of_points) const {
  AtPoint at(*this);
  return over(
      draws,
      [&](const double* x) {
        at.move_to(x);
        return at.hazard(life);
      },
      share_of_points);
}

LifeDistribution::Known LifeDistribution::ratio(const WeightedDraws& draws,
                                                const LifeDistribution& other,
                                                double share_of_points) const {
  AtPoint here(*this), there(other);
  return over(
      draws,
      [&](const double* x) {
        here.move_to(x);
        there.move_to(x);
        return here.quantile(0.5) / there.quantile(0.5);
      },
      share_of_points);
}

}  // namespace wearwell::formula_model
