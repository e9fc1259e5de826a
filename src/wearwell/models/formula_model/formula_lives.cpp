#include "wearwell/models/formula_model/formula_lives.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "wearwell/base/stop_scope.h"
#include "wearwell/models/formula_model/effect_lines.h"
#include "wearwell/models/formula_model/formula_drawn.h"
#include "wearwell/predict/interpolated.h"

// Longer than others: lives of new units and of those with readings, over lines and over points.
namespace wearwell::formula_model {
namespace {

// Points of the posterior: fewer for units with readings, as new ones depend on the population's tail.
struct Most {
  std::size_t next = 4000, seen = 1000;
};

// One thread's part: some points of the posterior, one after the other.
class Part {
 public:
  Part(const FormulaRows& rows, const LimitedPath& path)
      : rows_(rows),
        path_(path),
        fresh_(rows.model().draws_units() ? lines_of_new_unit(effects(), 0.5, 5)
                                          : lines_of_new_unit(effects())),
        new_units_(rows.model()) {
    if (path.next) next_.emplace(*path.next, path.rising, path.begin, path.scale);
    for (const LimitedPath::SeenUnit& each : path.seen) {
      ahead_.emplace_back(*each.ahead, path.rising, path.begin, path.scale);
      behind_.push_back(each.behind ? std::make_unique<PathAt>(*each.behind) : nullptr);
    }
    found.remaining.resize(path.seen.size());
    found.passed.assign(path.seen.size(), 0);
  }

  void add(const double* x, double weight) {
    if (next_) add_next(x, weight);
    if (!path_.seen.empty()) add_seen(x, weight);
  }

  LimitedLives found;

  // Without random effects: the one life of new units at a point.
  double life_of_next(const double* x) {
    next_->at().move_to(x);
    solve(*next_, {}, 1, place_);
    return place_[0];
  }

  // The remaining life of that unit from its last row on, at a point; not positive if it has passed
  // already.
  double remaining_of_seen(std::size_t u, const double* x) {
    ahead_[u].at().move_to(x);
    solve(ahead_[u], {}, 1, place_);
    path_.seen[u].ahead->goes_on() ? from_last_row(u) : from_place(u, x, fresh_);
    return place_[0];
  }

 private:
  std::size_t effects() const { return rows_.model().effects.size(); }

  // Lives of units at `z`, as many as `z` holds.
  void solve(Crossing& crossing, const std::vector<double>& z, std::size_t count,
             std::vector<double>& place) {
    check_stop();
    place.resize(count);
    past_.resize(count);
    level_.assign(count, path_.limit);
    for (std::size_t at = 0; at < count; at += Path::most) {
      const std::size_t n = std::min(Path::most, count - at);
      crossing.solve(n, z.empty() ? nullptr : &z[at * effects()], &level_[at], &place[at]);
      for (std::size_t i = 0; i < n; ++i) past_[at + i] = crossing.ahead(i);
    }
  }

  void add_next(const double* x, double weight) {
    CellMixture units;
    NormalLines along;
    for (std::size_t i = 0; i < new_units_.count(); ++i) {
      add_some(new_units_.at(i, x, rows_.model().parameters.size()), weight * new_units_.share(i),
               units, along);
    }
    found.next.add(units);
    found.next.limit_size();
    if (path_.mean) found.add_mean(path_, units);
    if (path_.shares.empty()) return;
    effects() > 0 ? found.add_shares(path_, along, weight) : found.add_shares(path_, units);
  }

  void add_some(const double* x, double weight, CellMixture& units, NormalLines& along) {
    next_->at().move_to(x);
    const EffectLines* lines = &fresh_;
    if (effects() == 2) {
      turn(fresh_, steepest().data(), lines_);
      lines = &lines_;
    }
    solve(*next_, lines->z, lines->count(), place_);
    lines->each(place_, [&](auto share, auto place) { units.add_curve(weight, share, place); });
    if (path_.shares.empty() || effects() == 0) return;
    // The scores of turned lines are those before turning.
    std::size_t begin = 0;
    for (const std::size_t end : fresh_.ends) {
      double share = 0;
      for (std::size_t i = begin; i < end; ++i) share += fresh_.share[i];
      const double first = fresh_.z[begin * effects()];
      const double step = end - begin > 1 ? fresh_.z[(begin + 1) * effects()] - first : 1;
      along.add(weight * share, first, step, std::span(place_).subspan(begin, end - begin));
      begin = end;
    }
  }

  // The direction of two effects in which lives of new units change.
  std::array<double, 2> steepest() {
    constexpr double away = 0.5;
    static const std::vector<double> z = {away, 0, -away, 0, 0, away, 0, -away};
    solve(*next_, z, 4, place_);
    return {place_[0] - place_[1], place_[2] - place_[3]};
  }

  void add_seen(const double* x, double weight) {
    const std::size_t d = effects(), units = path_.seen.size();
    const latent::UnitIntegrals* integrals = d > 0 ? &rows_.integrate(x) : nullptr;
    for (std::size_t u = 0; u < units; ++u) {
      if (d > 0) lines_of_seen_unit(*integrals, path_.seen[u].unit, d, lines_);
      const EffectLines& lines = d > 0 ? lines_ : fresh_;
      if (lines.count() == 0) continue;
      ahead_[u].at().move_to(x);
      solve(ahead_[u], lines.z, lines.count(), place_);
      path_.seen[u].ahead->goes_on() ? from_last_row(u) : from_place(u, x, lines);
      double left = 0, all = 0;
      lines.each(place_, [&](auto share, auto place) {
        left += found.remaining[u].add_curve(weight, share, place, 0);
      });
      found.remaining[u].limit_size();
      for (const double each : lines.share) all += each;
      found.passed[u] += std::max(weight * all - left, 0.0);
    }
  }

  // A path that continues from the unit's last row starts there. If it has passed the threshold by
  // then, by so much that a curve through its neighbours gives the share that has passed.
  void from_last_row(std::size_t u) {
    const double now = path_.seen[u].now;
    double pace = 0;
    for (std::size_t i = 0; i < place_.size(); ++i) {
      place_[i] -= now;
      if (past_[i] < 0 && std::isfinite(place_[i])) {
        const double own = place_[i] / -past_[i];
        pace = pace > 0 ? std::min(pace, own) : own;
      }
    }
    for (std::size_t i = 0; i < place_.size(); ++i) {
      if (past_[i] >= 0) place_[i] = -past_[i] * (pace > 0 ? pace : 1);
    }
  }

  // Lives count from the unit's last row, or from the corresponding position under new conditions.
  void from_place(std::size_t u, const double* x, const EffectLines& lines) {
    const LimitedPath::SeenUnit& seen = path_.seen[u];
    if (!behind_[u]) {
      for (double& each : place_) each -= seen.now;
      return;
    }
    behind_[u]->move_to(x);
    continued_.find(*behind_[u], ahead_[u], seen.now, lines.z, effects(), lines.count());
    for (std::size_t i = 0; i < lines.count(); ++i) {
      const double level = continued_.level[i], now = continued_.place[i];
      const bool there = path_.rising ? level >= path_.limit : level <= path_.limit;
      place_[i] = there && !(now > place_[i]) ? 0 : place_[i] - now;
    }
  }

  const FormulaRows& rows_;
  const LimitedPath& path_;
  std::optional<Crossing> next_;
  std::vector<Crossing> ahead_;
  std::vector<std::unique_ptr<PathAt>> behind_;
  const EffectLines fresh_;
  NewUnits new_units_;
  EffectLines lines_;
  Continuation continued_;
  std::vector<double> place_, past_, level_;
};

// A posterior in terms of one quantity derived at each of its points.
template <class Value>
WeightedDraws in_terms_of(const WeightedDraws& draws,
                          tbb::enumerable_thread_specific<std::unique_ptr<Part>>& parts,
                          const FormulaRows& rows, const LimitedPath& path, const Value& value) {
  const Eigen::Index n = draws.has_cells() ? draws.cells.mass.size() : draws.values.rows();
  const double least = QuantityDistribution::least_weight(draws);
  const auto of = [&](const Points& points) {
    const Eigen::Index count = std::min(n, points.rows());
    Points numbers = Points::Zero(count, 1);
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, count, 256), [&](const auto& some) {
      std::unique_ptr<Part>& part = parts.local();
      if (!part) part = std::make_unique<Part>(rows, path);
      for (Eigen::Index i = some.begin(); i < some.end(); ++i) {
        if (draws.cell_weight(i) > least) numbers(i, 0) = value(*part, points.row(i).data());
      }
    });
    return numbers;
  };
  WeightedDraws result{of(draws.values), draws.weights.head(n), {}, {}, draws.cells};
  for (const Points& ends : draws.lower) result.lower.push_back(of(ends));
  for (const Points& ends : draws.upper) result.upper.push_back(of(ends));
  return result;
}

// Without random effects each point of the posterior has one life: all points count, with the cells
// of the quadrature, since few points would leave noise of one over the root of their number.
LimitedLives lives_of_points(const FormulaRows& rows, const LimitedPath& path,
                             const WeightedDraws& draws) {
  tbb::enumerable_thread_specific<std::unique_ptr<Part>> parts;
  const auto cells_of = [&](const auto& value) {
    const WeightedDraws lives = in_terms_of(draws, parts, rows, path, value);
    CellMixture cells;
    cells.add(QuantityDistribution(lives, [](const double* life) { return life[0]; }));
    return cells;
  };
  LimitedLives lives;
  lives.over_all = true;
  if (path.next) {
    lives.next = cells_of([](Part& part, const double* x) { return part.life_of_next(x); });
    const bool all = path.survived <= path.begin;
    lives.mean = all ? lives.next : lives.next.beyond(path.survived);
    lives.by_share.assign(path.shares.size(), lives.mean);
  }
  for (std::size_t u = 0; u < path.seen.size(); ++u) {
    const CellMixture all =
        cells_of([u](Part& part, const double* x) { return part.remaining_of_seen(u, x); });
    lives.remaining.push_back(all.beyond(0));
    lives.passed.push_back(std::max(0.0, all.mass() - lives.remaining.back().mass()));
  }
  return lives;
}

Most points_of(const Path& any) {
  if (!any.goes_on()) return {};
  return any.running->running.solved ? Most{400, 200} : Most{2000, 1000};
}

}  // namespace

LimitedLives limited_lives(const FormulaRows& rows, const LimitedPath& path,
                           const WeightedDraws& draws, double share_of_points) {
  if (rows.model().effects.empty() && !rows.model().draws_units())
    return lives_of_points(rows, path, draws);
  Most most = points_of(path.next ? *path.next : *path.seen.front().ahead);
  if (rows.model().draws_units()) most.next = std::min<std::size_t>(most.next, 400);
  for (std::size_t* each : {&most.next, &most.seen})
    *each = static_cast<std::size_t>(share_of_points * static_cast<double>(*each));
  LimitedLives lives;
  LimitedPath seen = path, next = path;
  seen.next.reset();
  next.seen.clear();
  if (!path.seen.empty()) {
    lives = sum_over(ThinnedPosterior(draws, most.seen), [&] { return Part(rows, seen); });
  }
  if (!path.next) return lives;
  const ThinnedPosterior few(draws, most.next);
  LimitedLives of_next = sum_over(few, [&] { return Part(rows, next); });
  if (share_of_points == 1) of_next.spread_shares(path, draws, few);
  lives.next = std::move(of_next.next);
  lives.by_share = std::move(of_next.by_share);
  lives.share_misfit = std::move(of_next.share_misfit);
  lives.mean = std::move(of_next.mean);
  lives.mean_misfit = of_next.mean_misfit;
  return lives;
}

void LimitedLives::add_mean(const LimitedPath& path, const CellMixture& units) {
  const bool all = path.survived <= path.begin;
  const CellMixture& left = all ? units : units.beyond(path.survived);
  const double mass = left.mass();
  mean_at_points.push_back(left.mean());
  if (mass > 0) mean.add(mass, mean_at_points.back(), mean_at_points.back());
}

void LimitedLives::add_shares(const LimitedPath& path, const CellMixture& units) {
  const bool all = path.survived <= path.begin;
  const CellMixture& left = all ? units : units.beyond(path.survived);
  const double mass = left.mass();
  by_share.resize(path.shares.size());
  for (std::size_t i = 0; i < path.shares.size(); ++i) {
    at_points.push_back(mass > 0 ? left.quantile(path.shares[i]) : std::nan(""));
    if (mass > 0) by_share[i].add(mass, at_points.back(), at_points.back());
  }
}

void LimitedLives::add_shares(const LimitedPath& path, const NormalLines& units, double weight) {
  const bool all = path.survived <= path.begin;
  const double gone = all ? 0 : units.cdf(path.survived), mass = weight * (1 - gone);
  by_share.resize(path.shares.size());
  for (std::size_t i = 0; i < path.shares.size(); ++i) {
    const double p = gone + path.shares[i] * (1 - gone);
    const double life = p < 1 ? units.quantile(p) : std::nan("");
    at_points.push_back(all ? life : std::max(0.0, life - path.survived));
    // Points that hardly any unit reaches do not count.
    if (mass > 0 && p < 1) by_share[i].add(mass, at_points.back(), at_points.back());
  }
}

void LimitedLives::spread_shares(const LimitedPath& path, const WeightedDraws& draws,
                                 const ThinnedPosterior& few) {
  const auto shares = static_cast<Eigen::Index>(path.shares.size());
  if (path.survived > path.begin) return;
  const bool finite = std::all_of(mean_at_points.begin(), mean_at_points.end(),
                                  [](double each) { return std::isfinite(each); });
  if (path.mean && finite) {
    const Eigen::Map<const Points> means(mean_at_points.data(), few.values.rows(), 1);
    if (const auto whole = interpolated(draws, few, means).front()) {
      mean = {};
      mean.add(whole->distribution);
      mean_misfit = whole->misfit;
    }
  }
  if (shares == 0) return;
  const Eigen::Map<const Points> lives(at_points.data(), few.values.rows(), shares);
  const auto whole = interpolated(draws, few, lives);
  share_misfit.assign(whole.size(), {});
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (!whole[i]) continue;
    by_share[i] = {};
    by_share[i].add(whole[i]->distribution);
    share_misfit[i] = whole[i]->misfit;
  }
}

void LimitedLives::add(const LimitedLives& other) {
  at_points.insert(at_points.end(), other.at_points.begin(), other.at_points.end());
  mean_at_points.insert(mean_at_points.end(), other.mean_at_points.begin(),
                        other.mean_at_points.end());
  next.add(other.next);
  next.limit_size();
  mean.add(other.mean);
  by_share.resize(std::max(by_share.size(), other.by_share.size()));
  for (std::size_t i = 0; i < other.by_share.size(); ++i) by_share[i].add(other.by_share[i]);
  for (std::size_t u = 0; u < remaining.size(); ++u) {
    remaining[u].add(other.remaining[u]);
    remaining[u].limit_size();
    passed[u] += other.passed[u];
  }
}

}  // namespace wearwell::formula_model
