#include "wearwell/models/fatigue/load_life.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/monitor.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/fatigue/life.h"
#include "wearwell/predict/cell_mixture.h"
#include "wearwell/prognosis/weighted_quantiles.h"

namespace wearwell::fatigue {
namespace {

constexpr double negligible = 1e-9;
constexpr double golden = 0.6180339887498949;  // its multiples are the most even modulo 1
constexpr std::size_t sums_per_draw = 4, limits_per_draw = 16;
constexpr double most_decades = 300;

double clamped(double log10) {
  return log10 == infinity ? log10 : std::clamp(log10, -most_decades, most_decades);
}

void refuse_what_has_no_sum(const SnLaw& law, const DamageRule& rule) {
  if (!law.logarithmic())
    throw InputError(
        "the study's lives are normal in cycles (likelihood.family = \"normal\"): under small "
        "stresses a scatter in cycles has no meaning, and damage cannot be summed; fit "
        "log10-normal or weibull");
  if (law.bends() && rule.miner != MinerRule::original)
    throw InputError(
        "the study's curve has its own knee or fatigue limit: use --rule original; for another "
        "rule fit without law.curve and law.fatigue_limit and give --knee");
  if (law.bends() && rule.knee.any())
    throw InputError("--knee: the study's curve has its own knee or limit; remove --knee");
  if (law.scatter_grows && !law.bends() && rule.miner != MinerRule::elementary)
    throw InputError(
        "the study's scatter grows with life (law.scatter), so items have no common knee: use "
        "--rule elementary, or fit a curve with its own knee (law.curve = \"knee\")");
  if (!law.bends() && rule.miner != MinerRule::elementary && !rule.knee.any())
    throw InputError(
        "--rule: the study's curve has no knee; give one with --knee '2e6 cycles' or --knee '150 "
        "MPa', or use --rule elementary, which has none");
}

// Scores from tail to tail.
std::vector<double> edges(StandardDistribution law, std::size_t count) {
  const double first = quantile(law, negligible), last = quantile(law, 1 - negligible);
  std::vector<double> at;
  for (std::size_t i = 0; i <= count; ++i)
    at.push_back(std::lerp(first, last, static_cast<double>(i) / static_cast<double>(count)));
  return at;
}

// Scores of items, with their shares of all items.
struct Scores {
  Scores(StandardDistribution law, std::size_t count) : at(edges(law, count)) {
    double all = 0;
    for (const double z : at) all += share.emplace_back(std::exp(log_density(law, z)));
    for (double& each : share) each /= all;
  }
  std::vector<double> at, share;
};

// One point of the posterior.
struct Drawn {
  double weight = 0;
  std::vector<double> b;  // log10 of blocks to a damage sum of 1, by percent
  double median = 0;      // of the item at score 0, log10 of blocks to a sum of 1
  const Scores* scores = nullptr;
  std::vector<std::vector<double>> items;  // at each score; for random limits of several limits
};

class Draws {
 public:
  Draws(const SnResult& result, const LoadCycles& cycles, const LoadQuestion& question)
      : result_(result),
        cycles_(cycles),
        question_(question),
        fine_(result.law.standard(), 64),
        coarse_(result.law.standard(), 32) {}

  /// `where` takes the shares of the cycles, times the weight of the point.
  Drawn operator()(Eigen::Index i, std::vector<double>& where) const {
    const SnLaw& law = result_.law;
    const double* x = result_.posterior.values.row(i).data();
    const BlockDamage damage(law, x, question_.rule, cycles_);
    Drawn drawn;
    drawn.weight = result_.posterior.weights[i];
    drawn.scores = &scores_for(drawn.weight);
    drawn.median = clamped(-damage.log10_damage(0));
    add_shares(damage, drawn.weight, where);
    if (law.limit) {
      add_items_of_limits(damage, i, x, drawn);
    } else {
      add_items([&](double z) { return -damage.log10_damage(z); }, drawn);
      for (const double percent : question_.percents)
        drawn.b.push_back(clamped(-damage.log10_damage(quantile(law.standard(), percent / 100))));
    }
    return drawn;
  }

 private:
  void add_shares(const BlockDamage& damage, double weight, std::vector<double>& where) const {
    const std::vector<double> shares = damage.shares(cycles_);
    for (std::size_t c = 0; c < shares.size(); ++c) where[c] += weight * shares[c];
  }

  // A quadrature has many points of little weight.
  const Scores& scores_for(double weight) const {
    return weight * static_cast<double>(result_.posterior.weights.size()) < 0.2 ? coarse_ : fine_;
  }

  template <class Life>
  static void add_items(const Life& life, Drawn& drawn) {
    std::vector<double>& lives = drawn.items.emplace_back();
    lives.reserve(drawn.scores->at.size());
    for (const double z : drawn.scores->at) lives.push_back(clamped(life(z)));
  }

  // Stratified limits; their positions move from draw to draw.
  void add_items_of_limits(const BlockDamage& damage, Eigen::Index i, const double* x,
                           Drawn& drawn) const {
    const SnLaw& law = result_.law;
    double whole = 0;
    const double shift = std::modf((static_cast<double>(i) + 0.5) * golden, &whole);
    const double sigma = x[law.sigma_index()];
    for (std::size_t j = 0; j < limits_per_draw; ++j) {
      const double p = (static_cast<double>(j) + shift) / limits_per_draw;
      const double base = -damage.log10_damage(0, quantile(*law.limit, p));
      add_items([&](double z) { return base + sigma * z; }, drawn);
    }
    MixedLife lives(law.family);
    const std::vector<double> limits = edges(*law.limit, 100);
    double below = 0;
    for (std::size_t j = 1; j < limits.size(); ++j) {
      const double through = j + 1 == limits.size() ? 1 : cdf(*law.limit, limits[j]);
      lives.add(through - below,
                clamped(-damage.log10_damage(0, 0.5 * (limits[j - 1] + limits[j]))), sigma);
      below = through;
    }
    for (const double percent : question_.percents)
      drawn.b.push_back(std::log10(lives.quantile(percent / 100)));
  }

  const SnResult& result_;
  const LoadCycles& cycles_;
  const LoadQuestion& question_;
  Scores fine_, coarse_;
};

// At least as many damage sums as draws, with equal probability.
double log10_sum(const DamageSum& sum, std::size_t draw, std::size_t j) {
  double whole = 0;
  const auto index = static_cast<double>(draw * sums_per_draw + j);
  const double p = std::modf((index + 0.5) * golden, &whole);
  return std::log10(sum.median) +
         std::log10(sum.factor) *
             quantile(StandardDistribution::normal, std::clamp(p, 1e-12, 1 - 1e-12));
}

double power(double log10) {
  return log10 <= -most_decades ? 0 : std::pow(10, log10);
}

void add_lives(const std::vector<Drawn>& drawn, const LoadQuestion& question, LoadLife& life) {
  CellMixture next, damage;
  std::vector<double> blocks, of_one;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    check_stop();
    const double shift = log10_sum(question.sum, i, 0);
    const double weight = drawn[i].weight / static_cast<double>(drawn[i].items.size());
    for (const std::vector<double>& item : drawn[i].items) {
      blocks.clear();
      of_one.clear();
      for (const double at : item) {
        blocks.push_back(at + shift);
        of_one.push_back(std::max(-at, -most_decades));
      }
      next.add_curve(weight, drawn[i].scores->share, blocks);
      damage.add_curve(weight, drawn[i].scores->share, of_one);
    }
  }
  // A million cells: their distribution at these many places, exact there, answers all questions.
  constexpr std::size_t places = 1024;
  next.condense(places);
  damage.condense(places);
  life.next05 = power(next.quantile(0.05));
  life.next50 = power(next.quantile(0.5));
  life.next95 = power(next.quantile(0.95));
  life.damage05 = power(damage.quantile(0.05));
  life.damage50 = power(damage.quantile(0.5));
  life.damage95 = power(damage.quantile(0.95));
  const double low = next.quantile(0.001), high = next.quantile(0.999);
  for (int i = 0; std::isfinite(low) && std::isfinite(high) && i <= 60; ++i) {
    const double at = std::lerp(low, high, i / 60.0);
    life.cdf.emplace_back(at, next.cdf(at));
  }
  for (std::size_t p = 0; p < question.percents.size(); ++p) {
    std::vector<double> all, weights;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      for (std::size_t j = 0; j < sums_per_draw; ++j) {
        all.push_back(drawn[i].b[p] + log10_sum(question.sum, i, j));
        weights.push_back(drawn[i].weight);
      }
    }
    const std::vector<double> at = prognosis::weighted_quantiles(
        all, weights, std::array{0.05, 0.5, 0.95, 1 - question.confidence});
    life.lives.push_back({question.percents[p], power(at[0]), power(at[1]), power(at[2]),
                          power(at[3]), power(next.quantile(question.percents[p] / 100))});
  }
}

void add_contributions(const SnResult& result, const std::vector<Drawn>& drawn,
                       const LoadQuestion& question, LoadLife& life) {
  Eigen::VectorXd y(std::ssize(drawn));
  double items = 0;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    // Mean and variance over items.
    double mean = 0, square = 0;
    for (const std::vector<double>& item : drawn[i].items) {
      for (std::size_t k = 0; k < item.size(); ++k) {
        mean += drawn[i].scores->share[k] * item[k];
        square += drawn[i].scores->share[k] * item[k] * item[k];
      }
    }
    if (!std::isfinite(square) || !std::isfinite(drawn[i].median)) return;
    const auto curves = static_cast<double>(drawn[i].items.size());
    mean /= curves;
    items += (square / curves - mean * mean) * drawn[i].weight;
    y[static_cast<Eigen::Index>(i)] = mean;
  }
  const Eigen::VectorXd& weights = result.posterior.weights;
  const double of_posterior = weights.dot((y.array() - weights.dot(y)).square().matrix());
  const double of_sum = std::pow(std::log10(question.sum.factor), 2);
  const double all = of_posterior + of_sum + items;
  life.sd = std::sqrt(all);
  if (!(all > 0)) return;
  const std::vector<double> shares = variance_shares(result.posterior, y);
  for (std::size_t i = 0; i < result.parameters.size(); ++i)
    life.contributions.push_back({result.parameters[i], shares[i] * of_posterior / all});
  if (shares.back() * of_posterior > 0.005 * all)
    life.contributions.push_back(
        {"these together, nonlinear part", shares.back() * of_posterior / all});
  life.contributions.push_back({"scatter from item to item", items / all});
  life.contributions.push_back({"the damage sum at failure", of_sum / all});
}

void add_extrapolation(const SnResult& result, const LoadCycles& cycles, LoadLife& life) {
  constexpr double slack = 1e-9;
  const TestedSpan& tested = result.tested;
  const double room = slack * (std::abs(tested.mean_low) + std::abs(tested.mean_high));
  for (std::size_t c = 0; c < cycles.size(); ++c) {
    const Stress& stress = cycles[c].stress;
    if (stress.alternating > tested.alternating_high * (1 + slack)) life.above += life.shares[c];
    if (stress.alternating < tested.alternating_low * (1 - slack)) life.below += life.shares[c];
    if (result.law.correction != MeanStress::none &&
        (stress.mean < tested.mean_low - room || stress.mean > tested.mean_high + room))
      life.beyond_mean += life.shares[c];
  }
}

}  // namespace

LoadLife load_life(const SnResult& result, const LoadCycles& cycles, const LoadQuestion& question,
                   const std::stop_token& stop) {
  refuse_what_has_no_sum(result.law, question.rule);
  const Draws draw(result, cycles, question);
  std::vector<Drawn> drawn(static_cast<std::size_t>(result.posterior.values.rows()));
  // Sums of shares by blocks, so that threads do not change their order.
  constexpr std::size_t block = 64;
  std::vector<std::vector<double>> sums((drawn.size() + block - 1) / block,
                                        std::vector<double>(cycles.size(), 0));
  tbb::parallel_for(std::size_t{0}, sums.size(), [&](std::size_t b) {
    for (std::size_t i = b * block; i < std::min(drawn.size(), (b + 1) * block); ++i) {
      if (stop.stop_requested()) throw Cancelled();
      drawn[i] = draw(static_cast<Eigen::Index>(i), sums[b]);
    }
  });
  LoadLife life;
  life.draws = drawn.size();
  life.shares.assign(cycles.size(), 0);
  for (const auto& sum : sums) {
    for (std::size_t c = 0; c < sum.size(); ++c) life.shares[c] += sum[c];
  }
  add_extrapolation(result, cycles, life);
  add_lives(drawn, question, life);
  add_contributions(result, drawn, question, life);
  return life;
}

std::vector<double> variance_shares(const WeightedDraws& x, const Eigen::VectorXd& y) {
  const auto d = static_cast<std::size_t>(x.values.cols());
  const Eigen::VectorXd& weights = x.weights;
  // In units of their standard deviations; a constant column explains nothing.
  const Eigen::RowVectorXd mean = weights.transpose() * x.values;
  Eigen::MatrixXd z = x.values.rowwise() - mean;
  for (Eigen::Index c = 0; c < z.cols(); ++c) {
    const double sd = std::sqrt(weights.dot(z.col(c).cwiseAbs2()));
    z.col(c) *= sd > 0 ? 1 / sd : 0;
  }
  const Eigen::VectorXd centered = y.array() - weights.dot(y);
  const double variance = weights.dot(centered.cwiseAbs2());
  std::vector<double> shares(d + 1, 0);
  if (!(variance > 0)) return shares;
  const Eigen::MatrixXd weighted = weights.asDiagonal() * z;
  const Eigen::MatrixXd covariance = z.transpose() * weighted;
  const Eigen::VectorXd with_y = weighted.transpose() * centered;
  // The explained variance of each set of columns.
  std::vector<double> explained(std::size_t{1} << d, 0);
  for (std::size_t set = 1; set < explained.size(); ++set) {
    std::vector<Eigen::Index> in;
    for (std::size_t c = 0; c < d; ++c) {
      if (set >> c & 1) in.push_back(static_cast<Eigen::Index>(c));
    }
    const Eigen::MatrixXd part = covariance(in, in);
    const Eigen::VectorXd to_y = with_y(in);
    explained[set] = to_y.dot(part.completeOrthogonalDecomposition().solve(to_y)) / variance;
  }
  // Shapley: the contribution of a column, averaged over all orders of adding columns.
  std::vector<double> orders(d + 1, 1);
  for (std::size_t i = 1; i <= d; ++i) orders[i] = orders[i - 1] * static_cast<double>(i);
  for (std::size_t c = 0; c < d; ++c) {
    for (std::size_t set = 0; set < explained.size(); ++set) {
      if (set >> c & 1) continue;
      const auto size = static_cast<std::size_t>(__builtin_popcountll(set));
      shares[c] += orders[size] * orders[d - size - 1] / orders[d] *
                   (explained[set | std::size_t{1} << c] - explained[set]);
    }
  }
  shares[d] = std::max(0.0, 1 - explained.back());
  return shares;
}

}  // namespace wearwell::fatigue
