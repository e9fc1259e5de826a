#include "wearwell/models/formula_model/formula_process_lives.h"

#include <algorithm>
#include <cmath>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/math/quadrature.h"
#include "wearwell/models/formula_model/effect_lines.h"
#include "wearwell/models/formula_model/formula_drawn.h"
#include "wearwell/models/formula_model/formula_first_passage.h"
#include "wearwell/predict/thinned_posterior.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t most_points = 400, most_points_of_next = 2000;
constexpr double least_share = 1e-6;  // of a unit's posterior: smaller shares are left out

// State of a path that readings do not determine exactly: nodes of the normal distribution below
// `highest`. The integrand changes with z over 1/`ratio`: if that is large, and nothing is cut off,
// the Gauss-Hermite rule needs few nodes (Abramowitz and Stegun 25.4.46), with errors of a cdf
// below 1e-5.
struct Standings {
  static constexpr std::size_t most = 16;
  std::size_t count = most;
  double z[most], weight[most];

  Standings(double highest, double ratio) {
    constexpr double uncut = 6, few = 0.2, some = 0.6;
    if (highest > uncut && ratio < few) {
      take({0, 1.7320508075688772}, {2.0 / 3, 1.0 / 6});
    } else if (highest > uncut && ratio < some) {
      take({0, 1.3556261799742659, 2.8569700138728056},
           {8.0 / 15, 0.22207592200561264, 0.011257411327720689});
    } else {
      below(highest);
    }
  }

 private:
  // The middle node, and those on both sides of it.
  void take(std::initializer_list<double> nodes, std::initializer_list<double> weights) {
    count = 0;
    const double* share = weights.begin();
    for (const double node : nodes) {
      for (const double side : {1.0, -1.0}) {
        if (node == 0 && side < 0) continue;
        z[count] = side * node;
        weight[count++] = *share;
      }
      ++share;
    }
  }

  void below(double highest) {
    static const GaussLegendre rule = gauss_legendre(16);
    constexpr double lowest = -5.5;
    const double half = 0.5 * (std::min(highest, -lowest) - lowest);
    double sum = 0;
    for (std::size_t k = 0; k < 16; ++k) {
      z[k] = lowest + half * (1 + rule.node[k]);
      weight[k] = rule.weight[k] * std::exp(-0.5 * z[k] * z[k]);
      sum += weight[k];
    }
    for (double& each : weight) each /= sum;
  }
};

// Nodes of a unit's one effect that are equally spaced: every so many of them are enough for lives.
struct EvenNodes {
  double first = 0, step = 0, sd = 0, stride = 1;

  static EvenNodes of(const std::vector<latent::Sweep>& sweeps, std::size_t unit) {
    EvenNodes even;
    if (sweeps.size() < 3) return even;
    const double z[] = {sweeps[0].z[unit], sweeps[1].z[unit], sweeps[2].z[unit]};
    if (!(std::abs(z[2] - 2 * z[1] + z[0]) < 1e-9 * std::abs(z[1] - z[0]))) return even;
    double mean = 0, square = 0;
    for (const latent::Sweep& each : sweeps) {
      const double off = each.z[unit] - z[0];
      if (!(each.weight[unit] > 0)) continue;
      mean += each.weight[unit] * off;
      square += each.weight[unit] * off * off;
    }
    even.first = z[0];
    even.step = std::abs(z[1] - z[0]);
    even.sd = std::sqrt(std::max(0.0, square - mean * mean));
    return even;
  }
  bool keeps(double z) const {
    return stride == 1 || std::fmod(std::round(std::abs(z - first) / step), stride) == 0;
  }
};

// One thread's part: some points of the posterior, one after the other.
class Part {
 public:
  Part(const FormulaRows& rows, const ProcessLimit& limit)
      : rows_(rows),
        limit_(limit),
        form_(*rows.model().measured[limit.column].process),
        table_(ScoreTable::passages(form_.process)),
        effects_(rows.model().effects.size()),
        fresh_(lines_of_new_unit(effects_, 0.5, 5)),
        new_units_(rows.model()) {
    const LimitedPath& path = limit.path;
    sign_ = path.rising ? 1 : -1;
    if (path.next) next_.emplace(*path.next, path.rising, path.begin, path.scale);
    for (const LimitedPath::SeenUnit& each : path.seen) {
      ahead_.emplace_back(*each.ahead, path.rising, path.begin, path.scale);
    }
    found.remaining.resize(path.seen.size());
    found.passed.assign(path.seen.size(), 0);
  }

  void add(const double* x, double weight) {
    if (next_) add_next(x, weight);
    if (!limit_.path.seen.empty()) add_seen(x, weight);
  }

  LimitedLives found;

 private:
  void add_next(const double* x, double weight) {
    CellMixture units;
    NormalLines along;
    for (std::size_t k = 0; k < new_units_.count(); ++k) {
      next_->at().move_to(new_units_.at(k, x, rows_.model().parameters.size()));
      for (std::size_t i = 0; i < fresh_.count(); ++i) {
        const double* z = effects_ > 0 ? &fresh_.z[i * effects_] : nullptr;
        const double share = weight * new_units_.share(k) * fresh_.share[i];
        add_passage(*next_, z, 0, sign_ * limit_.path.limit, scale_at(*next_, z, limit_.path.begin),
                    share, false, units);
        if (!limit_.path.shares.empty())
          along.add(share, ScoreTable::first_score, ScoreTable::score_step, place_);
      }
    }
    found.next.add(units);
    found.next.limit_size();
    if (limit_.path.mean) found.add_mean(limit_.path, units);
    if (!limit_.path.shares.empty()) found.add_shares(limit_.path, along, weight);
  }

  // The scale of a path at z; if its standard deviation is given, from its value far along.
  double scale_at(Crossing& crossing, const double* z, double from) {
    const double place = std::max(from, limit_.path.begin + limit_.path.scale);
    crossing.at().stand(1, z);
    crossing.at().evaluate(1, z, &place);
    const double mean = crossing.at().output(0, 0), spread = crossing.at().output(1, 0);
    return form_.by_sd ? spread * spread / std::abs(mean) : spread;
  }

  // From a mean of `mean` on, until the path of this scale has grown by `distance` (upward; signs
  // are those of a rising path).
  void add_passage(Crossing& crossing, const double* z, double mean, double distance, double scale,
                   double weight, bool counted_from, CellMixture& to) {
    constexpr int edges = ScoreTable::edges;
    double level[edges + 1], means[edges];
    place_.resize(edges + 1);
    table_.look_up(distance, scale, means);
    level[edges] = sign_ * mean;
    for (int k = 0; k < edges; ++k) level[k] = sign_ * (mean + means[k]);
    double same[latent::most_effects * (edges + 1)];
    for (std::size_t i = 0; i < effects_ * (edges + 1); ++i) same[i] = z[i % effects_];
    crossing.solve(edges + 1, effects_ > 0 ? same : nullptr, level, place_.data());
    const double start = counted_from ? place_[edges] : 0;
    place_.pop_back();
    for (double& each : place_) each -= start;
    to.add_curve(weight, ScoreTable::shares(), place_);
    to.limit_size();
  }

  void add_seen(const double* x, double weight) {
    for (Crossing& each : ahead_) each.at().move_to(x);
    UnitRows& units = rows_.mine().rows;
    units.move_to(x);
    if (effects_ == 0) {
      const std::vector<Standing> all = units.standings({}, limit_.column);
      for (std::size_t u = 0; u < ahead_.size(); ++u)
        add_unit(u, nullptr, all[limit_.path.seen[u].unit], weight, 1);
      return;
    }
    const auto& seen = limit_.path.seen;
    const std::vector<latent::Sweep>& sweeps = rows_.integrate(x).sweeps;
    std::vector<EvenNodes> even(ahead_.size());
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
      const latent::Sweep& sweep = sweeps[i];
      const auto counts = [&](std::size_t u) {
        return sweep.weight[seen[u].unit] > least_share && even[u].keeps(sweep.z[seen[u].unit]);
      };
      bool any = false;
      for (std::size_t u = 0; u < ahead_.size() && !any; ++u) any = counts(u);
      if (!any) continue;
      const std::vector<Standing> all = units.standings(sweep.z, limit_.column);
      for (std::size_t u = 0; u < ahead_.size(); ++u) {
        const std::size_t unit = seen[u].unit;
        if (i == 0 && effects_ == 1) even[u] = even_nodes(u, sweeps, all[unit]);
        if (!counts(u)) continue;
        const double share = even[u].stride * sweep.weight[unit];
        add_unit(u, &sweep.z[unit * effects_], all[unit], weight, share);
      }
    }
  }

  // The first node is that of the mode. A step of h standard deviations of the effect has an error of
  // about exp(-2 pi^2/(h^2 (1 + r^2))) if the passage moves by r of its own standard deviations over one
  // of the effect.
  EvenNodes even_nodes(std::size_t u, const std::vector<latent::Sweep>& sweeps,
                       const Standing& stands) {
    constexpr double two_square_pi = 19.739, exponent = 16;
    const std::size_t unit = limit_.path.seen[u].unit;
    EvenNodes even = EvenNodes::of(sweeps, unit);
    const double distance = sign_ * (limit_.path.limit - stands.at);
    if (!(even.step > 0) || !stands.cells.empty() || !(distance > 0)) return even;
    const Population& population = rows_.mine().rows.population();
    const double z[] = {even.first, even.first + even.sd};
    const double here = population.value(rows_.model(), 0, z);
    const double there = population.value(rows_.model(), 0, z + 1);
    const double scale = scale_at(ahead_[u], z, limit_.path.seen[u].now);
    const double r = std::abs(there / here - 1) / std::sqrt(scale / distance);
    const double h = std::sqrt(two_square_pi / (exponent * (1 + r * r)));
    if (h > 0) even.stride = std::max(1.0, std::floor(h * even.sd / even.step));
    return even;
  }

  // `of_unit`: the share of these effects in the unit's posterior at a point of this weight.
  void add_unit(std::size_t u, const double* z, const Standing& stands, double at_point,
                double of_unit) {
    const double weight = at_point * of_unit;
    const double mean = sign_ * stands.mean, now = limit_.path.seen[u].now;
    const double left = sign_ * (limit_.path.limit - stands.at);
    const double sd = std::sqrt(stands.variance);
    const double scale = scale_at(ahead_[u], z, now);
    if (!stands.cells.empty()) {
      for (const Standing::Cell& cell : stands.cells) {
        // Uniform over the cell: the part that has not reached the threshold, and its center.
        const double room = limit_.path.limit - cell.at, half = 0.5 * stands.width;
        const double below = std::clamp((room + half) / stands.width, 0.0, 1.0);
        const double share = weight * cell.share;
        found.passed[u] += share * (1 - below);
        const double distance = room + half * (1 - below);
        if (!(of_unit * below * cell.share > least_share && distance > 0)) continue;
        add_passage(ahead_[u], z, mean, distance, scale, share * below, true, found.remaining[u]);
      }
      return;
    }
    if (!(sd > 0)) {
      if (left <= 0) {
        found.passed[u] += weight;
      } else {
        add_passage(ahead_[u], z, mean, left, scale, weight, true, found.remaining[u]);
      }
      return;
    }
    const double below = normal_cdf(left / sd);  // it has not reached the threshold
    found.passed[u] += weight * (1 - below);
    if (!(of_unit * below > least_share)) return;
    const Standings nodes(left / sd, sd / std::sqrt(scale * std::max(left, sd)));
    for (std::size_t k = 0; k < nodes.count; ++k) {
      const double distance = left - sd * nodes.z[k], share = below * nodes.weight[k];
      if (!(distance > 0 && of_unit * share > least_share)) continue;
      add_passage(ahead_[u], z, mean, distance, scale, weight * share, true, found.remaining[u]);
    }
  }

  const FormulaRows& rows_;
  const ProcessLimit& limit_;
  const ProcessForm& form_;
  const ScoreTable& table_;
  std::size_t effects_;
  const EffectLines fresh_;
  NewUnits new_units_;
  double sign_ = 1;
  std::optional<Crossing> next_;
  std::vector<Crossing> ahead_;
  std::vector<double> place_;  // of each edge of the table, for the last added passage
};

}  // namespace

LimitedLives process_lives(const FormulaRows& rows, const ProcessLimit& limit,
                           const WeightedDraws& draws, double share_of_points) {
  ProcessLimit seen = limit, next = limit;
  seen.path.next.reset();
  next.path.seen.clear();
  const auto some = [=](std::size_t most) {
    return static_cast<std::size_t>(share_of_points * static_cast<double>(most));
  };
  LimitedLives lives;
  if (!limit.path.seen.empty()) {
    lives = sum_over(ThinnedPosterior(draws, some(most_points)), [&] { return Part(rows, seen); });
  }
  if (!limit.path.next) return lives;
  // Lives of new units depend on the tail of the population.
  const std::size_t most = rows.model().draws_units() ? most_points : most_points_of_next;
  const ThinnedPosterior few(draws, some(most));
  LimitedLives of_next = sum_over(few, [&] { return Part(rows, next); });
  if (share_of_points == 1) of_next.spread_shares(limit.path, draws, few);
  lives.next = std::move(of_next.next);
  lives.by_share = std::move(of_next.by_share);
  lives.share_misfit = std::move(of_next.share_misfit);
  lives.mean = std::move(of_next.mean);
  lives.mean_misfit = of_next.mean_misfit;
  return lives;
}

}  // namespace wearwell::formula_model
