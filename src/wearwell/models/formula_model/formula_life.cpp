#include "wearwell/models/formula_model/formula_life.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numeric>

#include "wearwell/base/stop_scope.h"
#include "wearwell/predict/interpolated.h"
#include "wearwell/predict/prediction.h"
#include "wearwell/predict/thinned_posterior.h"

// Longer than others: every quantity of a life, over the posterior and for the next item, goes by the same few points.

namespace wearwell::formula_model {
namespace {

// If items survive to this point more rarely, the rest is undetermined.
constexpr double least_survival = 1e-3;

constexpr std::size_t thinned_posterior = 2000, points_of_next = 1000;

// Components of all points together, to which the points are limited, but for the fewest that sum a posterior well.
constexpr double most_components = 2e6;
constexpr std::size_t fewest_points = 200;

// Components of a predictive life; the others are too light to matter.
bool is_kept(double weight) {
  return weight >= 1e-9;
}

Eigen::Index heaviest(const WeightedDraws& draws) {
  Eigen::Index row = 0;
  draws.weights.maxCoeff(&row);
  return row;
}

std::size_t some(std::size_t most, double share) {
  return static_cast<std::size_t>(share * static_cast<double>(most));
}

// Points of a posterior: at most `most`, and fewer where each has many components (most_components). Their number
// depends on the point; it is averaged over a few.
std::size_t affordable(std::size_t most, const WeightedDraws& draws,
                       std::initializer_list<LifeAtPoint*> lives) {
  constexpr std::size_t probes = 16;
  double components = 0;
  for (LifeAtPoint* const each : lives) {
    if (!each->varies()) {
      components += static_cast<double>(each->size());
      continue;
    }
    const ThinnedPosterior few(draws, probes);
    for (std::size_t i = 0; i < few.weights.size(); ++i) {
      each->move_to(few.values.row(static_cast<Eigen::Index>(i)).data());
      components += few.weights[i] * static_cast<double>(each->size());
    }
  }
  const auto within = static_cast<std::size_t>(most_components / std::max(components, 1.0));
  return std::clamp(within, std::min(fewest_points, most), most);
}

}  // namespace

std::string per_unit(const Unit& unit) {
  if (unit.text == "1") return "1";
  const bool one = unit.text.find_first_of(" */.^") == std::string::npos;
  return one ? "1/" + unit.text : "1/(" + unit.text + ")";
}

Risk risk_of(std::shared_ptr<const Path> family_parameters, const Measured& measured) {
  std::vector<std::size_t> places = measured.family_parameter;
  places.resize(family_parameters->program.outputs().size());
  return {std::move(family_parameters), std::move(places), measured.life, measured.form->positive};
}

Risk risk_of_subpopulation(std::shared_ptr<const Path> family_parameters, const Measured& measured,
                           std::size_t k) {
  std::vector<std::size_t> places;
  for (const std::size_t each : measured.family_parameter) {
    if (each / most_response_parameters == k) places.push_back(each % most_response_parameters);
  }
  return {std::move(family_parameters),
          std::move(places),
          {.families = {measured.life.families[k]}},
          true};
}

LifeDistribution::LifeDistribution(std::vector<Risk> risks) : risks_(std::move(risks)) {}

double LifeDistribution::Next::cdf(double life) const {
  check_stop();
  constexpr std::size_t part = 4096;  // components, independent of the number of threads
  std::vector<double> sums((weights_.size() + part - 1) / part);
  const std::size_t stride = parameters_of(risks_);
  const auto failed = [&](std::size_t i) {
    const double* const own = &family_parameters_[i * stride];
    return risks_.size() == 1 ? std::exp(risks_.front().life.log_cdf(life, own))
                              : -std::expm1(log_survival_of(risks_, life, own));
  };
  tbb::parallel_for(std::size_t{0}, sums.size(), [&](std::size_t k) {
    for (std::size_t i = k * part; i < std::min((k + 1) * part, weights_.size()); ++i)
      sums[k] += weights_[i] * failed(i);
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

double LifeDistribution::Next::quantile(double p) const {
  if (!risks_.front().life.plain()) {
    if (p <= cdf(0)) return 0;
    if (p >= cdf(infinity)) return infinity;
  }
  return quantile_of_cdf([&](double y) { return cdf(y); }, p, middle_, risks_.front().positive);
}

double LifeDistribution::Next::quantile(double p, double from) const {
  const double gone = cdf(from);
  if (1 - gone < least_survival) return std::nan("");
  return quantile(gone + p * (1 - gone)) - from;
}

bool LifeDistribution::over_all() const {
  return risks_.front().family_parameters->model->effects.empty() &&
         !risks_.front().family_parameters->varied;
}

void LifeDistribution::Next::add(const LifeAtPoint& at, double weight) {
  double kept = 0;
  for (std::size_t j = 0; j < at.size(); ++j)
    if (is_kept(at.weight(j))) kept += at.weight(j);
  for (std::size_t j = 0; j < at.size(); ++j) {
    if (!is_kept(at.weight(j))) continue;
    weights_.push_back(weight * at.weight(j) / kept);
    family_parameters_.insert(family_parameters_.end(), at.slots(j),
                              at.slots(j) + parameters_of(risks_));
  }
}

LifeDistribution::Next LifeDistribution::next(const WeightedDraws& draws,
                                              double share_of_points) const {
  LifeAtPoint at = at_point();
  Next next;
  next.risks_ = risks_;
  if (risks_.front().family_parameters->model->modes && at.size() == 1) {
    // All points: few lose digits, because a mode with few failures has a long tail of parameters.
    const double least = QuantityDistribution::least_weight(draws);
    for (Eigen::Index i = 0; i < draws.weights.size(); ++i) {
      if (!(draws.weights[i] > least)) continue;
      at.move_to(draws.values.row(i).data());
      next.add(at, draws.weights[i]);
    }
    const double total = std::accumulate(next.weights_.begin(), next.weights_.end(), 0.0);
    for (double& each : next.weights_) each /= total;
    at.move_to(draws.values.row(heaviest(draws)).data());
    next.middle_ = at.middle();
    return next;
  }
  // Each age is an integral over rates of use.
  const std::size_t most_of_one = risks_.front().life.rate ? 4'000 : 20'000;
  const ThinnedPosterior few(
      draws, at.size() == 1 ? most_of_one
                            : some(affordable(points_of_next, draws, {&at}), share_of_points));
  for (std::size_t i = 0; i < few.weights.size(); ++i) {
    at.move_to(few.values.row(static_cast<Eigen::Index>(i)).data());
    if (i == 0) next.middle_ = at.middle();
    next.add(at, few.weights[i]);
  }
  return next;
}

// If every point needs an equation solved, few are used.
WeightedDraws LifeDistribution::points(const WeightedDraws& draws, double share_of_points) const {
  if (over_all()) return draws;
  LifeAtPoint at = at_point();
  ThinnedPosterior few(draws, some(affordable(thinned_posterior, draws, {&at}), share_of_points));
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
                                               double share_of_points,
                                               const LifeDistribution* other) const {
  if (over_all() && (!other || other->over_all())) return {{draws, value}};
  LifeAtPoint here = at_point(), there = (other ? other : this)->at_point();
  const std::size_t most = other ? affordable(thinned_posterior, draws, {&here, &there})
                                 : affordable(thinned_posterior, draws, {&here});
  const ThinnedPosterior few(draws, some(most, share_of_points));
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
  LifeAtPoint at = at_point();
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
  LifeAtPoint at = at_point();
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
  LifeAtPoint at = at_point();
  return {{*given, [&](const double* x) {
             at.move_to(x);
             const double gone = at.cdf(from);
             // If none survives the value does not count, but it must be a number.
             return gone < 1 ? at.quantile(gone + p * (1 - gone)) - from : 0;
           }}};
}

LifeDistribution::Known LifeDistribution::mean_beyond(const WeightedDraws& draws, double from,
                                                      double share_of_points) const {
  LifeAtPoint at = at_point();
  const auto value = [&](const double* x) {
    at.move_to(x);
    const double mean = at.mean_beyond(from);
    return std::isnan(mean) && at.cdf(from) == 1 ? 0 : mean;  // of a point that does not count
  };
  if (!(from > 0)) return over(draws, value, share_of_points);
  const auto given = survivors(draws, from, share_of_points);
  return given ? Known{{*given, value}} : undetermined(draws);
}

double LifeDistribution::share_of_mean_beyond(const WeightedDraws& draws, double from,
                                              double life) const {
  constexpr std::size_t points = 200;  // of a share, between 0 and 1
  LifeAtPoint at = at_point();
  const ThinnedPosterior few(draws, std::min(points, affordable(thinned_posterior, draws, {&at})));
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < few.weights.size(); ++i) {
    at.move_to(few.values.row(static_cast<Eigen::Index>(i)).data());
    const double weight = few.weights[i] * (from > 0 ? 1 - at.cdf(from) : 1);
    const double share = weight > 0 ? at.share_of_mean_beyond(from, life) : std::nan("");
    if (std::isnan(share)) continue;
    sum += weight * share;
    weights += weight;
  }
  return sum / weights;
}

LifeDistribution::Known LifeDistribution::survival(const WeightedDraws& draws, double life,
                                                   double share_of_points) const {
  LifeAtPoint at = at_point();
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
  LifeAtPoint at = at_point();
  return over(
      draws,
      [&](const double* x) {
        at.move_to(x);
        return at.hazard(life);
      },
      share_of_points);
}

LifeDistribution::Known LifeDistribution::incidence(const WeightedDraws& draws, std::size_t risk,
                                                    double life, double share_of_points) const {
  LifeAtPoint at = at_point();
  return over(
      draws,
      [&](const double* x) {
        at.move_to(x);
        return at.incidence(risk, life);
      },
      share_of_points);
}

LifeDistribution::Known LifeDistribution::failing(const WeightedDraws& draws,
                                                  double share_of_points) const {
  LifeAtPoint at = at_point();
  return over(
      draws,
      [&](const double* x) {
        at.move_to(x);
        return at.failing();
      },
      share_of_points);
}

LifeDistribution::Known LifeDistribution::failing_within(const WeightedDraws& draws, double age,
                                                         double use, double share_of_points) const {
  LifeAtPoint at = at_point();
  return over(
      draws,
      [&](const double* x) {
        at.move_to(x);
        return at.failing_within(age, use);
      },
      share_of_points);
}

LifeDistribution::Known LifeDistribution::share_among_survivors(const WeightedDraws& draws,
                                                                std::size_t k, double life,
                                                                double share_of_points) const {
  LifeAtPoint at = at_point();
  return over(
      draws,
      [&](const double* x) {
        at.move_to(x);
        return at.share_among_survivors(k, life);
      },
      share_of_points);
}

template <class Value>
LifeDistribution::Known LifeDistribution::compared(const WeightedDraws& draws,
                                                   const LifeDistribution& other,
                                                   const Value& value,
                                                   double share_of_points) const {
  LifeAtPoint here = at_point(), there = other.at_point();
  return over(
      draws,
      [&](const double* x) {
        here.move_to(x);
        there.move_to(x);
        return value(here, there);
      },
      share_of_points, &other);
}

LifeDistribution::Known LifeDistribution::ratio(const WeightedDraws& draws,
                                                const LifeDistribution& other, double p,
                                                double share_of_points) const {
  return compared(
      draws, other,
      [p](const LifeAtPoint& here, const LifeAtPoint& there) {
        return here.quantile(p) / there.quantile(p);
      },
      share_of_points);
}

LifeDistribution::Known LifeDistribution::ratio_of_middles(const WeightedDraws& draws,
                                                           const LifeDistribution& other,
                                                           double share_of_points) const {
  return compared(
      draws, other,
      [](const LifeAtPoint& here, const LifeAtPoint& there) {
        return here.middle() / there.middle();
      },
      share_of_points);
}

LifeDistribution::Known LifeDistribution::survival_difference(const WeightedDraws& draws,
                                                              const LifeDistribution& other,
                                                              double life,
                                                              double share_of_points) const {
  return compared(
      draws, other,
      [life](const LifeAtPoint& here, const LifeAtPoint& there) {
        return there.cdf(life) - here.cdf(life);
      },
      share_of_points);
}

LifeDistribution::Known LifeDistribution::outliving(const WeightedDraws& draws,
                                                    const LifeDistribution& other,
                                                    double share_of_points) const {
  return compared(
      draws, other,
      [](const LifeAtPoint& here, const LifeAtPoint& there) { return here.outlives(there); },
      share_of_points);
}

}  // namespace wearwell::formula_model
