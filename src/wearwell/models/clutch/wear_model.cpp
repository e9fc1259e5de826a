#include "wearwell/models/clutch/wear_model.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>

#include "wearwell/base/rng.h"

namespace wearwell::clutch {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double outlier_level = 0.05;
constexpr std::size_t bootstrap_exponents = 6;

/// The power of each input in a term.
std::array<int, 3> powers_of(const Term& term) {
  std::array<int, 3> powers{};
  for (const int factor : term.factors) ++powers[static_cast<std::size_t>(factor)];
  return powers;
}

std::vector<double> spread_out(const std::vector<double>& exponents, double own) {
  std::vector<double> chosen;
  const std::size_t count = std::min(bootstrap_exponents, exponents.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = count == 1 ? 0 : i * (exponents.size() - 1) / (count - 1);
    chosen.push_back(exponents[at]);
  }
  chosen.push_back(own);
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

/// The exponents of a repeated search: the map's own, and some others.
std::vector<double> tried_exponents(const std::vector<double>& exponents, const WearMap& map) {
  std::vector<double> tried = spread_out(exponents, map.r);
  const std::vector<double> others = spread_out(exponents, map.q);
  tried.insert(tried.end(), others.begin(), others.end());
  std::sort(tried.begin(), tried.end());
  tried.erase(std::unique(tried.begin(), tried.end()), tried.end());
  return tried;
}

/// The best map of other measurements at the same points.
WearMap search_again(const WearPoints& points, const WearMap& map, const std::vector<double>& tried,
                     Progress* progress) {
  const PairBest best = best_exponents(points, map.surrogate, tried, map.terms, 1, false, progress);
  return fit_map("replicate", points, map.surrogate, best.r, best.q, 3, best.terms);
}

/// The errors of the plates' factors in the measurements, relative, by plate.
std::map<int, double> factor_errors(const RunInFit& run_in, Rng& rng) {
  std::map<int, double> errors;
  for (const PlateFactor& plate : run_in.plates)
    errors[plate.plate] = std::exp(plate.shrunk_sd * rng.normal());
  return errors;
}

Validation::Metrics metrics(const std::vector<ValidationPoint>& points, bool with_outliers) {
  Validation::Metrics m;
  double mean = 0;
  for (const ValidationPoint& p : points) {
    if (p.outlier && !with_outliers) continue;
    ++m.points;
    mean += p.measured;
    m.bias += p.measured - p.predicted;
  }
  mean /= m.points;
  m.bias /= m.points;
  double total = 0, squares = 0;
  for (const ValidationPoint& p : points) {
    if (p.outlier && !with_outliers) continue;
    total += (p.measured - mean) * (p.measured - mean);
    squares += (p.measured - p.predicted) * (p.measured - p.predicted);
  }
  m.r2 = 1 - squares / total;
  m.rmse = std::sqrt(squares / m.points);
  return m;
}

}  // namespace

double WearPolynomial::operator()(const OperatingPoint& at) const {
  const double distance = std::pow(at.slip_speed, r) * std::pow(at.closing_time, q);
  double sum = 0;
  for (const Monomial& m : monomials) {
    sum += m.coefficient * power(distance, m.ds) * power(at.temperature, m.temperature) *
           power(at.torque, m.torque);
  }
  return sum;
}

WearPolynomial WearModel::polynomial() const {
  WearPolynomial w{r, q, {{0, 0, 0, 0}}};
  for (const ModelTerm& term : terms) {
    const double coefficient = term.coefficient / term.range;
    if (term.ds + term.temperature + term.torque == 0) {
      w.monomials.front().coefficient += coefficient;
    } else {
      w.monomials.front().coefficient -= coefficient * term.minimum;
      w.monomials.push_back({term.ds, term.temperature, term.torque, coefficient});
    }
  }
  return w;
}

unsigned outside(const WearModel& model, const OperatingPoint& at) {
  unsigned bits = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const double low = model.lowest.*inputs[i].value, high = model.highest.*inputs[i].value;
    const double slack = validity_slack * (high - low), x = at.*inputs[i].value;
    if (x < low - slack || x > high + slack) bits |= 1u << i;
  }
  return bits;
}

std::string names_of_inputs(unsigned bits) {
  std::string names;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (!(bits & 1u << i)) continue;
    if (!names.empty()) names += ' ';
    names += inputs[i].name;
  }
  return names;
}

MatrixXd robust_covariance(const WearMap& map, const VectorXd& sd) {
  const MatrixXd x = map.design.columns(Eigen::all, map.terms);
  const MatrixXd inverse = (x.transpose() * x).ldlt().solve(MatrixXd::Identity(x.cols(), x.cols()));
  const MatrixXd scaled = sd.asDiagonal() * (x * inverse);
  return scaled.transpose() * scaled;
}

WearPolynomial unscaled(const WearMap& map) {
  const OriginalCoefficients original =
      original_coefficients(map.design, map.terms, map.fit.coefficients, map.fit.covariance);
  WearPolynomial w{map.r, map.q, {{0, 0, 0, original.intercept}}};
  for (std::size_t j = 0; j < map.terms.size(); ++j) {
    const auto powers = powers_of(map.design.terms[static_cast<std::size_t>(map.terms[j])]);
    if (powers[0] + powers[1] + powers[2] > 0)
      w.monomials.push_back(
          {powers[0], powers[1], powers[2], original.coefficients[static_cast<Index>(j)]});
  }
  return w;
}

WearModel make_model(const std::string& title, const WearPoints& points, const WearMap& map,
                     const RunInFit& run_in, const ScatterSearch& scatter, double worn_out) {
  WearModel model;
  model.title = title;
  model.r = map.r;
  model.q = map.q;
  for (std::size_t j = 0; j < map.terms.size(); ++j) {
    const Index t = map.terms[j];
    const Term& term = map.design.terms[static_cast<std::size_t>(t)];
    const auto powers = powers_of(term);
    model.terms.push_back({term.name, powers[0], powers[1], powers[2], map.design.minimum[t],
                           map.design.range[t], map.fit.coefficients[static_cast<Index>(j)]});
  }
  model.scatter = scatter.candidates[scatter.best].law;
  model.scatter_floor = scatter.floors[scatter.best];
  model.covariance = robust_covariance(map, point_sd(model.scatter, points, map.fit.fitted));
  model.run_in = run_in.run_in;
  model.run_in_covariance = run_in.run_in_covariance;
  model.plate_sd = run_in.plate_sd;
  for (const Input& input : inputs) {
    double low = INFINITY, high = -INFINITY;
    for (const OperatingPoint& at : points.at) {
      low = std::min(low, at.*input.value);
      high = std::max(high, at.*input.value);
    }
    model.lowest.*input.value = low;
    model.highest.*input.value = high;
  }
  model.worn_out = worn_out;
  return model;
}

std::vector<Replicate> draw_replicates(const WearPoints& points, const WearMap& map,
                                       const VectorXd& sd, const RunInFit& run_in,
                                       const std::vector<RunIn>& run_ins,
                                       const std::vector<double>& exponents, std::uint64_t seed,
                                       int threads, Progress* progress) {
  const std::vector<double> tried = tried_exponents(exponents, map);
  std::vector<Replicate> replicates(run_ins.size());
  const auto solve = [&](std::size_t b) {
    Rng rng(seed, b);
    WearPoints simulated = points;
    for (Index j = 0; j < simulated.size(); ++j) simulated.w[j] = sd[j] * rng.normal();
    std::map<int, double> factors = factor_errors(run_in, rng);
    for (Index j = 0; j < simulated.size(); ++j) {
      const auto at = static_cast<std::size_t>(j);
      if (points.plate.empty()) {
        simulated.w[j] += map.fit.fitted[j];
        continue;
      }
      const double factor = factors.try_emplace(points.plate[at], 1.0).first->second;
      const double compensation = run_in.run_in.mean(points.from[at], points.to[at]) /
                                  run_ins[b].mean(points.from[at], points.to[at]);
      simulated.w[j] = compensation * (factor * map.fit.fitted[j] + simulated.w[j]);
    }
    replicates[b] = {unscaled(search_again(simulated, map, tried, progress)), run_ins[b]};
  };
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, replicates.size(), solve); });
  return replicates;
}

Validation validate(const WearMap& map, const MatrixXd& covariance, const ScatterLaw& law,
                    const WearPoints& held_out) {
  Validation validation;
  if (held_out.size() == 0) return validation;
  const MatrixXd rows = map.rows(held_out.at);
  const VectorXd predicted = rows * map.fit.coefficients;
  const VectorXd sd = point_sd(law, held_out, predicted);
  const double freedom = static_cast<double>(map.fit.residuals.size() - rows.cols());
  validation.critical = boost::math::quantile(boost::math::complement(
      boost::math::students_t(freedom), outlier_level / 2 / static_cast<double>(held_out.size())));
  for (Index j = 0; j < held_out.size(); ++j) {
    ValidationPoint p{held_out.number[static_cast<std::size_t>(j)], held_out.w[j], predicted[j]};
    p.sd = std::sqrt(sd[j] * sd[j] + rows.row(j).dot(covariance * rows.row(j).transpose()));
    p.t = (p.measured - p.predicted) / p.sd;
    p.outlier = std::abs(p.t) > validation.critical;
    validation.points.push_back(p);
  }
  validation.all = metrics(validation.points, true);
  validation.without_outliers = metrics(validation.points, false);
  return validation;
}

AveragingEffect averaging_effect(const WearPolynomial& w, const std::vector<Cycle>& cycles,
                                 const std::vector<WornBlock>& blocks) {
  AveragingEffect effect;
  double summed_all = 0, averaged_all = 0;
  for (const WornBlock& block : blocks) {
    if (block.block != Block::point) continue;
    double summed = 0;
    for (std::size_t i = block.first; i < block.last; ++i)
      summed += w(cycles[i].at) * cycles[i].energy;
    const double averaged = w(block.mean) * block.energy;
    effect.point.push_back(block.point);
    effect.change.push_back(averaged / summed - 1);
    summed_all += summed;
    averaged_all += averaged;
  }
  effect.total = summed_all > 0 ? averaged_all / summed_all - 1 : 0;
  return effect;
}

}  // namespace wearwell::clutch
