#include "wearwell/models/formula_model/rate_change_moves.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/math/log_sum_exp.h"

namespace wearwell::formula_model {
namespace {

constexpr double least_effective = 0.5;  // of the particles
constexpr double least_step = 0.05;      // of the power of the last reading
constexpr int fewest_moves = 6, most_moves = 60;
constexpr double enough_accepted = 4;  // of each particle, on average
constexpr double enough_within = 2;    // while the last reading is in a smaller power

// What is normal in a population: of a lognormal effect the logarithm.
double normal_value(const FormulaModel& model, std::size_t e, double value) {
  return model.effects[e].lognormal ? std::log(value) : value;
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

RateChangeMoves::NormalPopulation RateChangeMoves::normal_population(const FormulaModel& model,
                                                                     const Population& of) {
  NormalPopulation found;
  const std::size_t d = model.effects.size();
  found.correlation = of.correlation;
  for (std::size_t e = 0; e < d; ++e) {
    found.middle[e] = normal_value(model, e, of.middle[e]);
    found.scatter[e] = of.scatter[e];
    found.log_pace += std::log(of.scatter[e]);
  }
  if (d == 2) found.log_pace += 0.5 * std::log1p(-of.correlation * of.correlation);
  return found;
}

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
    population_.push_back(normal_population(model_, population_at(points_.values->row(i).data())));
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

// The effects of particle i from their normal values.
void RateChangeMoves::place(const NormalPopulation& population, const double* normal,
                            ChangedUnits& to, std::size_t i) const {
  for (std::size_t e = 0; e < model_.effects.size(); ++e) {
    const double own = (normal[e] - population.middle[e]) / population.scatter[e];
    const double r = population.correlation;
    to.z[e][i] = e == 0 ? own : (own - r * to.z[0][i]) / std::sqrt(1 - r * r);
    to.nodes.effect[e][i] = model_.effects[e].lognormal ? std::exp(normal[e]) : normal[e];
  }
}

// Not of scores: in different populations one effect has different scores.
void RateChangeMoves::propose_differences(const ChangedUnits& from, const Particles& particles,
                                          double scale, ChangedUnits& to, Rng& rng) const {
  const std::size_t d = model_.effects.size(), count = from.count();
  for (std::size_t i = 0; i < count; ++i) {
    const auto other = [&] {
      return static_cast<std::size_t>(rng.uniform() * static_cast<double>(count));
    };
    const std::size_t a = other(), b = other();
    const auto moved = [&](const std::vector<double>& x, double tiny) {
      return x[i] + scale * (x[a] - x[b]) + tiny * (rng.uniform() - 0.5);
    };
    double normal[2] = {};
    for (std::size_t e = 0; e < d; ++e)
      normal[e] = moved(particles.normal[e], 1e-4 * particles.population[i].scatter[e]);
    place(particles.population[i], normal, to, i);
    to.score[i] = moved(from.score, 1e-4);
    to.axis.since[i] = moved(from.axis.since, 1e-6 * (end_ - start_));
    to.axis.factor[i] = shared_.prior.factor(to.score[i]);
  }
}

// Other points of the population, with the effects as they are. Returns the points.
std::vector<std::size_t> RateChangeMoves::propose_points(const Particles& particles,
                                                         ChangedUnits& to, Rng& rng) const {
  auto rows = std::make_shared<Points>(to.nodes.parameters->rows(), to.nodes.parameters->cols());
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < to.count(); ++i) {
    const auto at = std::lower_bound(below_.begin(), below_.end(), rng.uniform() * below_.back());
    const auto point = std::min<std::size_t>(at - below_.begin(), below_.size() - 1);
    rows->row(static_cast<Eigen::Index>(i)) = points_.values->row(static_cast<Eigen::Index>(point));
    const double normal[] = {particles.normal[0][i], particles.normal[1][i]};
    place(population_[point], normal, to, i);
    points.push_back(point);
  }
  to.nodes.parameters = std::move(rows);
  return points;
}

RateChangeMoves::Particles RateChangeMoves::particles_of(const ChangedUnits& units) const {
  Particles found;
  PopulationAt population_at(model_);
  for (std::size_t i = 0; i < units.count(); ++i) {
    const double* const point = units.nodes.parameters->row(static_cast<Eigen::Index>(i)).data();
    found.population.push_back(normal_population(model_, population_at(point)));
    found.log_prior.push_back(log_prior(units, i));
  }
  for (std::size_t e = 0; e < 2; ++e) {
    for (const double each : units.nodes.effect[e])
      found.normal[e].push_back(normal_value(model_, e, each));
    found.normal[e].resize(units.count());
  }
  return found;
}

void RateChangeMoves::move(ChangedUnits& units, double power, std::vector<double>& last,
                           Rng& rng) const {
  const std::size_t d = model_.effects.size(), count = units.count();
  Particles particles = particles_of(units);
  LogLikelihood now = look(units);
  const double usual_scale = 2.38 / std::sqrt(2.0 * static_cast<double>(d + 2));
  const double enough = (power < 1 ? enough_within : enough_accepted) * static_cast<double>(count);
  double accepted_moves = 0;  // by differences
  std::vector<std::size_t> accepted, points;
  for (int step = 0; step < most_moves; ++step) {
    if (step >= fewest_moves && accepted_moves >= enough) break;
    ChangedUnits to = units;
    const bool other_points = step % 3 == 1;
    if (other_points) {
      points = propose_points(particles, to, rng);
    } else {
      propose_differences(units, particles, step % 6 == 5 ? 1 : usual_scale, to, rng);
    }
    const LogLikelihood then = look(to);
    accepted.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const double prior = log_prior(to, i), u = rng.uniform();
      const NormalPopulation& population =
          other_points ? population_[points[i]] : particles.population[i];
      const double ratio = then.at(i, power) + prior - now.at(i, power) - particles.log_prior[i] +
                           particles.population[i].log_pace - population.log_pace;
      if (!(ratio >= 0 || u < std::exp(ratio))) continue;
      accepted.push_back(i);
      now.earlier[i] = then.earlier[i];
      now.last[i] = then.last[i];
      particles.log_prior[i] = prior;
      if (other_points) particles.population[i] = population;
      for (std::size_t e = 0; e < d && !other_points; ++e)
        particles.normal[e][i] = normal_value(model_, e, to.nodes.effect[e][i]);
    }
    if (!other_points) accepted_moves += static_cast<double>(accepted.size());
    units.replace(accepted, to);
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
