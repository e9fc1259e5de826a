#include "wearwell/models/formula_model/rate_change_moves.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/math/log_sum_exp.h"

namespace wearwell::formula_model {
namespace {

constexpr double least_effective = 0.5;  // of the particles
constexpr double least_step = 0.05;      // of the power of the last reading
constexpr int fewest_moves = 12, most_moves = 60;
constexpr double enough_accepted = 8;  // of each particle, on average

// The scores at which effects have these values.
void find_scores(const FormulaModel& model, const Population& population, const double* value,
                 double* z) {
  for (std::size_t e = 0; e < model.effects.size(); ++e) {
    const double own = model.effects[e].lognormal
                           ? std::log(value[e] / population.middle[e]) / population.scatter[e]
                           : (value[e] - population.middle[e]) / population.scatter[e];
    const double r = population.correlation;
    z[e] = e == 0 ? own : (own - r * z[0]) / std::sqrt(1 - r * r);
  }
}

// The logarithm of how fast effects change with their scores, up to what does not depend on the population.
double log_pace(const FormulaModel& model, const Population& population) {
  const std::size_t d = model.effects.size();
  double sum = 0;
  for (std::size_t e = 0; e < d; ++e) sum += std::log(population.scatter[e]);
  return d == 2 ? sum + 0.5 * std::log1p(-population.correlation * population.correlation) : sum;
}

// The largest part of what is left of the last reading's power that keeps enough particles effective.
double next_step(const std::vector<double>& log_weight, const std::vector<double>& last,
                 double left, double least) {
  std::vector<double> weighed(log_weight.size());
  const auto keeps = [&](double power) {
    for (std::size_t i = 0; i < weighed.size(); ++i) weighed[i] = log_weight[i] + power * last[i];
    return effective_number(weighed) >= least;
  };
  if (keeps(left)) return left;
  double low = 0, high = left;
  constexpr int halvings = 20;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (keeps(middle) ? low : high) = middle;
  }
  return std::min(left, std::max(low, least_step));
}

}  // namespace

// Of a unit of the study each point's weight needs an integral over its effects.
RateChangeMoves::RateChangeMoves(const RateChanges& shared, std::vector<UnitReading> all,
                                 const std::vector<UnitReading>& seen, double start)
    : shared_(shared),
      model_(*shared.tracked->model),
      points_(seen.empty() ? shared.tracked->population.many : shared.tracked->population.few),
      all_(std::move(all)),
      start_(start),
      end_(all_.back().place) {
  PopulationAt population_at(model_);
  for (Eigen::Index i = 0; i < points_.values->rows(); ++i)
    population_.push_back(population_at(points_.values->row(i).data()));
  std::vector<double> log_weight = points_.log_weight, weight;
  if (!seen.empty()) {
    const std::vector<double> contained = log_likelihoods(model_, points_, seen);
    for (std::size_t i = 0; i < log_weight.size(); ++i) log_weight[i] -= contained[i];
  }
  normalize(log_weight, weight);
  double sum = 0;
  for (const double each : weight) below_.push_back(sum += each);
}

RateChangeMoves::LogLikelihood RateChangeMoves::look(ChangedUnits& units) const {
  units.paths = shared_.rows.paths();
  LogLikelihood found;
  found.earlier.assign(units.count(), 0);
  found.last.assign(units.count(), 0);
  std::vector<NodePath> after = units.paths;
  for (const UnitReading& each : all_) {
    for (std::size_t i = 0; i < found.last.size(); ++i) found.earlier[i] += found.last[i];
    const std::vector<double> places = units.places(each.place);
    shared_.rows.look(units.nodes, each, units.paths, &after, found.last, nullptr, nullptr,
                      places.data());
    std::swap(units.paths, after);
  }
  return found;
}

double RateChangeMoves::log_prior(const ChangedUnits& units, std::size_t i) const {
  // None after the last reading: those are among the unchanged.
  if (units.axis.since[i] > end_) return -infinity;
  double sum = shared_.prior.log_density(units.axis.since[i], start_, units.score[i]);
  for (const std::vector<double>& z : units.z)
    if (!z.empty()) sum -= 0.5 * z[i] * z[i];
  return sum;
}

void RateChangeMoves::propose_differences(const ChangedUnits& from,
                                          const std::vector<Population>& population, double scale,
                                          ChangedUnits& to, Rng& rng) const {
  const std::size_t d = model_.effects.size(), count = from.count();
  for (std::size_t i = 0; i < count; ++i) {
    const auto other = [&] {
      return static_cast<std::size_t>(rng.uniform() * static_cast<double>(count));
    };
    const std::size_t a = other(), b = other();
    const auto moved = [&](const std::vector<double>& x, double tiny) {
      return x[i] + scale * (x[a] - x[b]) + tiny * rng.normal();
    };
    double z[2] = {};
    for (std::size_t e = 0; e < d; ++e) to.z[e][i] = z[e] = moved(from.z[e], 1e-4);
    for (std::size_t e = 0; e < d; ++e) to.nodes.effect[e][i] = population[i].value(model_, e, z);
    to.score[i] = moved(from.score, 1e-4);
    to.axis.since[i] = moved(from.axis.since, 1e-6 * (end_ - start_));
    to.axis.factor[i] = shared_.prior.factor(to.score[i]);
  }
}

// Other points of the population, with the effects as they are. Returns the logarithms of the Jacobians.
std::vector<double> RateChangeMoves::propose_points(std::vector<Population>& population,
                                                    ChangedUnits& to, Rng& rng) const {
  const std::size_t d = model_.effects.size();
  auto rows = std::make_shared<Points>(*to.nodes.parameters);
  std::vector<double> log_jacobian(to.count(), 0);
  for (std::size_t i = 0; i < to.count(); ++i) {
    const auto at = std::lower_bound(below_.begin(), below_.end(), rng.uniform() * below_.back());
    const auto point = std::min<std::size_t>(at - below_.begin(), below_.size() - 1);
    rows->row(static_cast<Eigen::Index>(i)) = points_.values->row(static_cast<Eigen::Index>(point));
    double value[2] = {}, z[2] = {};
    for (std::size_t e = 0; e < d; ++e) value[e] = to.nodes.effect[e][i];
    find_scores(model_, population_[point], value, z);
    for (std::size_t e = 0; e < d; ++e) to.z[e][i] = z[e];
    log_jacobian[i] = log_pace(model_, population[i]) - log_pace(model_, population_[point]);
    population[i] = population_[point];
  }
  to.nodes.parameters = std::move(rows);
  return log_jacobian;
}

void RateChangeMoves::move(ChangedUnits& units, double power, std::vector<double>& last,
                           Rng& rng) const {
  const std::size_t d = model_.effects.size(), count = units.count();
  std::vector<Population> population;
  PopulationAt population_at(model_);
  for (std::size_t i = 0; i < count; ++i)
    population.push_back(
        population_at(units.nodes.parameters->row(static_cast<Eigen::Index>(i)).data()));
  LogLikelihood now = look(units);
  const double usual_scale = 2.38 / std::sqrt(2.0 * static_cast<double>(d + 2));
  double accepted_moves = 0;  // by differences
  for (int step = 0; step < most_moves; ++step) {
    if (step >= fewest_moves && accepted_moves >= enough_accepted * static_cast<double>(count))
      break;
    ChangedUnits to = units;
    std::vector<Population> population_of = population;
    std::vector<double> log_jacobian(count, 0);
    const bool other_points = step % 3 == 1;
    if (other_points) {
      log_jacobian = propose_points(population_of, to, rng);
    } else {
      propose_differences(units, population, step % 6 == 5 ? 1 : usual_scale, to, rng);
    }
    LogLikelihood then = look(to);
    std::vector<std::size_t> chosen;  // among both
    for (std::size_t i = 0; i < count; ++i) {
      const double ratio = then.at(i, power) + log_prior(to, i) - now.at(i, power) -
                           log_prior(units, i) + log_jacobian[i];
      const bool accepted = std::log(rng.uniform()) < ratio;
      chosen.push_back(accepted ? count + i : i);
      if (!accepted) continue;
      now.earlier[i] = then.earlier[i];
      now.last[i] = then.last[i];
      population[i] = population_of[i];
      if (!other_points) ++accepted_moves;
    }
    units.append(to);
    units = units.taken(chosen);
  }
  last = std::move(now.last);
}

void RateChangeMoves::take_last(ChangedUnits& units, std::vector<double> last, std::size_t count,
                                Rng& rng) const {
  const double least = least_effective * static_cast<double>(count);
  double power = 0;
  do {
    const double step = effective_number(units.log_weight) < least
                            ? 0
                            : next_step(units.log_weight, last, 1 - power, least);
    if (step > 0)
      for (std::size_t i = 0; i < last.size(); ++i) units.log_weight[i] += step * last[i];
    power += step;
    const double mass = log_sum_exp(units.log_weight);
    units = units.taken(resampled(units.log_weight, count, rng.uniform()));
    if (units.count() == 0) return;
    move(units, power, last, rng);
    units.log_weight.assign(count, mass - std::log(static_cast<double>(count)));
  } while (power < 1);
}

}  // namespace wearwell::formula_model
