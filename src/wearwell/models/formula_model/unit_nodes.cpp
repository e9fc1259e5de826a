#include "wearwell/models/formula_model/unit_nodes.h"

#include <algorithm>
#include <cmath>

#include "wearwell/formula/kernels.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/lanes.h"
#include "wearwell/models/formula_model/node_points.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t few_lines = 256, most_lines = 600, many_lines = 2000;
constexpr std::size_t few_alone = 2000, many_alone = 20'000;  // without random effects
constexpr double tail = 1e-5;  // of a line: the weight beyond its nodes on either side
// of the initial effective number of the few points: below it other points are chosen
constexpr double least_few = 0.3;
// wider than the distribution of two effects by this factor, for the nodes' proposal
constexpr double wider = 1.15;

// The likelihood of a unit's rows at one point of the parameters.
struct AtPoint {
  double log_likelihood = 0;
  double mean[2] = {}, square[3] = {1, 0, 1};  // of z: mean, covariance (11, 12, 22)
  double low = -4.3, high = 4.3;               // where one effect has all but its tails
};

// From the nodes of the integral over the unit's effect.
void look_at_line(const latent::UnitIntegrals& integrals, AtPoint& at) {
  static thread_local std::vector<std::pair<double, double>> nodes;
  nodes.clear();
  // From the middle outward, mostly alternating between both sides.
  const std::vector<latent::Sweep>& sweeps = integrals.sweeps;
  const auto note = [&](const latent::Sweep& sweep) {
    if (sweep.weight[0] > 0) nodes.emplace_back(sweep.z[0], sweep.weight[0]);
  };
  for (std::size_t i = (sweeps.size() + 1) / 2; i-- > 0;) note(sweeps[2 * i]);
  for (std::size_t i = 1; i < sweeps.size(); i += 2) note(sweeps[i]);
  if (nodes.empty()) return;
  if (!std::is_sorted(nodes.begin(), nodes.end())) std::sort(nodes.begin(), nodes.end());
  double below = 0, above = 0;
  for (const auto& [z, weight] : nodes) {
    at.mean[0] += weight * z;
    if (below < tail) at.low = z;
    below += weight;
  }
  for (auto each = nodes.rbegin(); each != nodes.rend(); ++each) {
    if (above < tail) at.high = each->first;
    above += each->second;
  }
  at.square[0] = 0;
  for (const auto& [z, weight] : nodes) {
    at.square[0] += weight * (z - at.mean[0]) * (z - at.mean[0]);
  }
  // As wide as needed if there are few nodes, and no wider than the tails of a normal distribution
  // if not.
  const double sd = std::max(std::sqrt(at.square[0]), 1e-12);
  at.low = std::min(std::max(at.low, at.mean[0] - 7 * sd), at.mean[0] - 4.3 * sd);
  at.high = std::max(std::min(at.high, at.mean[0] + 7 * sd), at.mean[0] + 4.3 * sd);
}

void look_at_plane(const latent::UnitIntegrals& integrals, AtPoint& at) {
  if (!(integrals.log_likelihood[0] > -infinity)) return;
  for (double& each : at.square) each = 0;
  for (const latent::Sweep& sweep : integrals.sweeps) {
    if (!(sweep.weight[0] > 0)) continue;
    for (int e = 0; e < 2; ++e)
      at.mean[e] += sweep.weight[0] * sweep.z[static_cast<std::size_t>(e)];
  }
  for (const latent::Sweep& sweep : integrals.sweeps) {
    if (!(sweep.weight[0] > 0)) continue;
    const double a = sweep.z[0] - at.mean[0], b = sweep.z[1] - at.mean[1];
    at.square[0] += sweep.weight[0] * a * a;
    at.square[1] += sweep.weight[0] * a * b;
    at.square[2] += sweep.weight[0] * b * b;
  }
}

// A unit's rows at many points of the parameters.
class UnitAt {
 public:
  UnitAt(const FormulaModel& model, const std::vector<UnitReading>& readings)
      : effects_(model.effects.size()) {
    if (!readings.empty()) {
      rows_ = std::make_unique<FormulaRows>(model_of_unit(model, readings), readings.size());
    }
  }

  AtPoint operator()(const double* x) const {
    AtPoint at;
    if (!rows_) return at;
    if (effects_ == 0) {
      UnitRows& rows = rows_->mine().rows;
      rows.move_to(x);
      const std::uint8_t wanted = 1;
      rows.evaluate({}, {&wanted, 1}, {&at.log_likelihood, 1}, {});
    } else {
      const latent::UnitIntegrals& integrals = rows_->integrate(x);
      at.log_likelihood = integrals.log_likelihood[0];
      effects_ == 1 ? look_at_line(integrals, at) : look_at_plane(integrals, at);
    }
    if (!(at.log_likelihood < infinity)) at.log_likelihood = -infinity;
    return at;
  }

  // The same value without nodes, cheaper where a formula exists.
  double log_likelihood(const double* x) const {
    FormulaRows::Scratch* const mine = rows_ && effects_ > 0 ? &rows_->mine() : nullptr;
    if (!mine || !mine->linear) return (*this)(x).log_likelihood;
    mine->rows.move_to(x);
    mine->linear->move();
    if (!mine->linear->each(mine->value)) return (*this)(x).log_likelihood;
    return mine->value[0] < infinity ? mine->value[0] : -infinity;
  }

 private:
  std::size_t effects_;
  std::unique_ptr<FormulaRows> rows_;
};

struct Looked {
  std::vector<AtPoint> all;
  std::vector<double> log_seen, log_weight;  // given the study's rows of the unit; given all rows
};

Looked look_at(const PopulationPoints& points, const UnitAt& seen, const UnitAt& all) {
  Looked looked;
  for (Eigen::Index j = 0; j < points.values->rows(); ++j) {
    const double* x = points.values->row(j).data();
    const double prior = points.log_weight[static_cast<std::size_t>(j)];
    looked.all.push_back(all(x));
    looked.log_seen.push_back(seen(x).log_likelihood);
    const double weight = prior + looked.all.back().log_likelihood - looked.log_seen.back();
    looked.log_weight.push_back(std::isnan(weight) ? -infinity : weight);
  }
  return looked;
}

// Only their weights.
std::vector<double> weights_of(const PopulationPoints& points, const UnitAt& seen,
                               const UnitAt& all) {
  std::vector<double> log_weight;
  for (Eigen::Index j = 0; j < points.values->rows(); ++j) {
    const double* x = points.values->row(j).data();
    const double weight = points.log_weight[static_cast<std::size_t>(j)] + all.log_likelihood(x) -
                          seen.log_likelihood(x);
    log_weight.push_back(std::isnan(weight) ? -infinity : weight);
  }
  return log_weight;
}

void shape_of(const AtPoint& at, std::size_t effects, std::size_t line, double* shape) {
  if (effects == 1) {
    const double step = (at.high - at.low) / UnitNodes::usual_per_line;
    shape[0] = at.low + step * fraction(line, 0.6180339887498949);
    shape[1] = step;
  }
  if (effects == 2) {
    const double a = std::sqrt(std::max(at.square[0], 1e-20));
    const double b = at.square[1] / a;
    const double c = std::sqrt(std::max(at.square[2] - b * b, 1e-20));
    const double all[] = {at.mean[0], at.mean[1], wider * a, wider * b, wider * c};
    std::copy(std::begin(all), std::end(all), shape);
  }
}

// The number of lines is small if the unit itself determines the parameters.
PopulationPoints choose(const PopulationPoints& many, const std::vector<double>& log_weight,
                        std::size_t most) {
  WeightedDraws draws;
  draws.values = *many.values;
  std::vector<double> weight;
  normalize(log_weight, weight);
  draws.weights =
      Eigen::Map<const Eigen::VectorXd>(weight.data(), static_cast<Eigen::Index>(weight.size()));
  return PopulationPoints(ThinnedPosterior(draws, most));
}

}  // namespace

PopulationPoints::PopulationPoints(const ThinnedPosterior& few)
    : values(std::make_shared<const Points>(few.values)) {
  for (const double each : few.weights) log_weight.push_back(std::log(each));
}

NodePopulation::NodePopulation(std::shared_ptr<const FormulaModel> formula_model,
                               const WeightedDraws& posterior)
    : model(std::move(formula_model)) {
  const bool alone = model->effects.empty();
  // As many as preserve means, variances and covariances of all parameters in several regions.
  const auto d = static_cast<std::size_t>(posterior.values.cols());
  const std::size_t moments = 1 + d + d * (d + 1) / 2;
  const std::size_t lines = std::min(std::max(few_lines, 8 * moments), most_lines);
  few = PopulationPoints(ThinnedPosterior(posterior, alone ? few_alone : lines));
  many = PopulationPoints(ThinnedPosterior(posterior, alone ? many_alone : many_lines));
}

namespace {

// Roberts' lattice in two dimensions, shifted from line to line, as standard normal numbers.
void lattice_point(std::size_t node, double& u, double& v) {
  u = normal_quantile(fraction(node, 0.7548776662466927));
  v = normal_quantile(fraction(node, 0.5698402909980532));
}

}  // namespace

void UnitNodes::scores(std::size_t effects, std::size_t node, double* z) const {
  const std::size_t line = node / nodes.per_line;
  const double* own = shape.data() + line * shape_size(effects);
  if (effects == 1) z[0] = own[0] + static_cast<double>(node % nodes.per_line) * own[1];
  if (effects != 2) return;
  double u = 0, v = 0;
  lattice_point(node, u, v);
  z[0] = own[0] + own[2] * u;
  z[1] = own[1] + own[3] * u + own[4] * v;
}

void UnitNodes::fill(const FormulaModel& model, std::size_t per_line) {
  const std::size_t lines = nodes.lines(), d = model.effects.size(), size = shape_size(d);
  nodes.per_line = d == 0 ? 1 : per_line;
  log_before.resize(nodes.count());
  for (std::size_t e = 0; e < d; ++e) nodes.effect[e].resize(nodes.count());
  PopulationAt population_at(model);
  for (std::size_t j = 0; j < lines; ++j) {
    if (d == 0) {
      log_before[j] = log_point[j] - log_seen[j];
      continue;
    }
    const double* own_shape = &shape[j * size];
    const Population population =
        population_at(nodes.parameters->row(static_cast<Eigen::Index>(j)).data());
    for (std::size_t k = 0; k < per_line; ++k) {
      const std::size_t i = j * per_line + k;
      double z[2] = {}, log_share = 0;
      scores(d, i, z);
      if (d == 1) {
        log_share = std::log(own_shape[1]) - 0.5 * (log_two_pi + z[0] * z[0]);
      } else {
        double u = 0, v = 0;
        lattice_point(i, u, v);
        log_share = std::log(own_shape[2] * own_shape[4] / static_cast<double>(per_line)) +
                    0.5 * (u * u + v * v - z[0] * z[0] - z[1] * z[1]);
      }
      log_before[i] = log_point[j] - log_seen[j] + log_share;
      for (std::size_t e = 0; e < d; ++e) nodes.effect[e][i] = population.value(model, e, z);
    }
  }
}

UnitNodes place_nodes(const NodePopulation& population, const std::vector<UnitReading>& seen,
                      const std::vector<UnitReading>& all, const UnitNodes& before) {
  const FormulaModel& model = *population.model;
  const UnitAt at_seen(model, seen), at_all(model, all);
  UnitNodes laid;
  laid.own = before.own;
  PopulationPoints points = population.few;
  if (before.own) {
    points.values = before.nodes.parameters;
    points.log_weight = before.log_point;
  }
  Looked looked = look_at(points, at_seen, at_all);
  const double least = least_few * effective_number(population.few.log_weight);
  const bool more = population.many.log_weight.size() > population.few.log_weight.size();
  if (more && effective_number(looked.log_weight) < least) {
    const std::vector<double> of_many = weights_of(population.many, at_seen, at_all);
    if (effective_number(of_many) > 0) {
      laid.own = true;
      points = choose(population.many, of_many, population.few.log_weight.size());
      looked = look_at(points, at_seen, at_all);
      // Weights of chosen points are those after the readings.
      for (std::size_t j = 0; j < points.log_weight.size(); ++j) {
        points.log_weight[j] -= looked.all[j].log_likelihood - looked.log_seen[j];
      }
    }
  }
  const std::size_t d = model.effects.size(), size = UnitNodes::shape_size(d);
  laid.nodes.parameters = points.values;
  laid.log_point = points.log_weight;
  laid.log_seen = looked.log_seen;
  laid.shape.resize(points.log_weight.size() * size);
  for (std::size_t j = 0; j < points.log_weight.size(); ++j) {
    shape_of(looked.all[j], d, j, laid.shape.data() + j * size);
  }
  // In single precision, as states are saved.
  for (auto* each : {&laid.log_point, &laid.log_seen}) {
    const double top = *std::max_element(each->begin(), each->end());
    for (double& one : *each) one = static_cast<float>(one - top);
  }
  for (double& each : laid.shape) each = static_cast<float>(each);
  laid.fill(model);
  return laid;
}

std::vector<double> log_likelihoods(const FormulaModel& model, const PopulationPoints& points,
                                    const std::vector<UnitReading>& rows) {
  const UnitAt at(model, rows);
  std::vector<double> found;
  for (Eigen::Index j = 0; j < points.values->rows(); ++j)
    found.push_back(at.log_likelihood(points.values->row(j).data()));
  return found;
}

double effective_number(std::span<const double> log_weight) {
  double top = -infinity;
  for (const double each : log_weight) top = std::max(top, each);
  if (!(top > -infinity)) return 0;
  double sum = 0, square = 0;
  for (const double each : log_weight) {
    if (!(each > top - 40)) continue;
    const double weight = std::exp(each - top);
    sum += weight;
    square += weight * weight;
  }
  return sum * sum / square;
}

void normalize(std::span<const double> log_weight, std::vector<double>& weight) {
  static const formula::Forward exp = formula::kernels_of(formula::Op::exp, 0).forward;
  constexpr double none = -40;
  const double top = highest_of(log_weight);
  weight.resize(log_weight.size());
  static thread_local std::vector<double> exponent;
  exponent.resize(log_weight.size());
  for (std::size_t i = 0; i < weight.size(); ++i)
    exponent[i] = log_weight[i] > top + none ? log_weight[i] - top : none;
  exp(exponent.data(), nullptr, nullptr, weight.data(), weight.size(), 0);
  for (std::size_t i = 0; i < weight.size(); ++i) {
    if (!(exponent[i] > none)) weight[i] = 0;
  }
  const double sum = sums_of(weight).sum;
  for (double& each : weight) each /= sum;
}

}  // namespace wearwell::formula_model
