#include "wearwell/models/ownlaw/own_lives.h"

#include <algorithm>
#include <cmath>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/models/ownlaw/few_points.h"
#include "wearwell/predict/prediction.h"

namespace wearwell::ownlaw {
namespace {

constexpr std::size_t most_points = 4000;
constexpr double least_share = 1e-7;  // of a unit's posterior: nodes with less are left out

// The ends of cells of equal width that fill the standard normal law, up to 1e-16 of it.
struct NormalCells {
  std::vector<double> end, weight;

  explicit NormalCells(double width) {
    constexpr double farthest = 8.25;
    for (double z = -farthest; z < farthest + 0.5 * width; z += width) end.push_back(z);
    for (std::size_t i = 0; i + 1 < end.size(); ++i) {
      weight.push_back(end[i] < 0 ? normal_cdf(end[i + 1]) - normal_cdf(end[i])
                                  : normal_cdf(-end[i]) - normal_cdf(-end[i + 1]));
    }
  }
};

// One thread's part: some points of the posterior, one after the other.
class Part {
 public:
  Part(const OwnRows& rows, const LimitedPath& path) : rows_(rows), path_(path) {
    if (path.next) next_.emplace(*path.next, path.rising, path.begin, path.scale);
    for (const LimitedPath::Seen& each : path.seen) {
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

 private:
  std::size_t effects() const { return rows_.law().effects.size(); }

  // Lives of units at `z`, as many as `z` holds.
  void solve(Crossing& crossing, const std::vector<double>& z, std::size_t count,
             std::vector<double>& place) {
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
    next_->at().move_to(x);
    if (effects() == 0) {
      solve(*next_, {}, 1, place_);
      found.next.add(weight, place_[0], place_[0]);
      if (!path_.shares.empty()) add_shares(weight);
      return;
    }
    if (!path_.shares.empty()) add_shares(weight);
    if (effects() == 1) {
      static const NormalCells cells(0.25);
      solve(*next_, cells.end, cells.end.size(), place_);
      for (std::size_t i = 0; i < cells.weight.size(); ++i) {
        found.next.add(weight * cells.weight[i], place_[i], place_[i + 1]);
      }
      return;
    }
    // A cell of the plane spreads from corner to corner.
    static const NormalCells cells(0.5);
    const std::size_t n = cells.end.size();
    if (grid_.empty()) {
      for (const double a : cells.end) {
        for (const double b : cells.end) {
          grid_.push_back(a);
          grid_.push_back(b);
        }
      }
    }
    solve(*next_, grid_, n * n, place_);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      for (std::size_t j = 0; j + 1 < n; ++j) {
        const double w = weight * cells.weight[i] * cells.weight[j];
        if (w < 1e-12 * weight) continue;
        const double corner[] = {place_[i * n + j], place_[i * n + j + 1], place_[(i + 1) * n + j],
                                 place_[(i + 1) * n + j + 1]};
        found.next.add(w, *std::min_element(corner, corner + 4),
                       *std::max_element(corner, corner + 4));
      }
    }
  }

  // Of each point by itself: cells are finer than where many points smooth them. Of two effects a cell
  // spreads from corner to corner along both diagonals, which keeps its variance.
  void add_shares(double weight) {
    CellMixture units;
    if (effects() == 0) {
      units.add(weight, place_[0], place_[0]);
    } else if (effects() == 1) {
      static const NormalCells cells(0.0625);
      solve(*next_, cells.end, cells.end.size(), place_);
      for (std::size_t i = 0; i < cells.weight.size(); ++i) {
        units.add(weight * cells.weight[i], place_[i], place_[i + 1]);
      }
    } else {
      static const NormalCells cells(0.5);
      const std::size_t n = cells.end.size();
      std::vector<double> z;
      for (const double a : cells.end) {
        for (const double b : cells.end) z.insert(z.end(), {a, b});
      }
      solve(*next_, z, n * n, place_);
      for (std::size_t i = 0; i + 1 < n; ++i) {
        for (std::size_t j = 0; j + 1 < n; ++j) {
          const double half = 0.5 * weight * cells.weight[i] * cells.weight[j];
          if (half < 1e-9 * weight) continue;
          units.add(half, place_[i * n + j], place_[(i + 1) * n + j + 1]);
          units.add(half, place_[i * n + j + 1], place_[(i + 1) * n + j]);
        }
      }
    }
    found.add_shares(path_, units);
  }

  void add_seen(const double* x, double weight) {
    const std::size_t d = effects(), units = path_.seen.size();
    if (d == 0) {
      for (std::size_t u = 0; u < units; ++u) {
        ahead_[u].at().move_to(x);
        solve(ahead_[u], {}, 1, place_);
        if (path_.seen[u].ahead->goes_on()) {
          add_ahead(u, weight, 0, 0);
        } else {
          add_remaining(u, x, {}, weight, place_[0], place_[0]);
        }
      }
      return;
    }
    const auto& sweeps = rows_.integrate(x).sweeps;
    for (std::size_t u = 0; u < units; ++u) {
      nodes_.clear();
      for (const latent::Sweep& sweep : sweeps) {
        if (!(sweep.weight[u] > least_share)) continue;
        nodes_.push_back({sweep.weight[u], sweep.z[u * d], d > 1 ? sweep.z[u * d + 1] : 0});
      }
      std::sort(nodes_.begin(), nodes_.end(),
                [](const Node& a, const Node& b) { return a.z0 < b.z0; });
      z_.clear();
      // Ends of the nodes' cells; of two effects the nodes themselves, which are many.
      for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (d == 1) {
          const double gap = nodes_.size() > 1 ? nodes_[1].z0 - nodes_[0].z0 : 0;
          const double before = i > 0 ? nodes_[i].z0 - nodes_[i - 1].z0 : gap;
          if (i == 0) z_.push_back(nodes_[0].z0 - 0.5 * before);
          const double after = i + 1 < nodes_.size() ? nodes_[i + 1].z0 - nodes_[i].z0 : before;
          z_.push_back(nodes_[i].z0 + 0.5 * after);
        } else {
          z_.push_back(nodes_[i].z0);
          z_.push_back(nodes_[i].z1);
        }
      }
      const std::size_t count = z_.size() / d;
      if (nodes_.empty()) continue;
      ahead_[u].at().move_to(x);
      solve(ahead_[u], z_, count, place_);
      for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const double z[2] = {nodes_[i].z0, nodes_[i].z1};
        const std::size_t other = d == 1 ? i + 1 : i;
        if (path_.seen[u].ahead->goes_on()) {
          add_ahead(u, weight * nodes_[i].weight, i, other);
          continue;
        }
        add_remaining(u, x, {z, d}, weight * nodes_[i].weight, place_[i], place_[other]);
      }
    }
  }

  // A path that goes on from the unit's last row begins there; of a cell of which one end has passed the
  // limit by then, the part that has.
  void add_ahead(std::size_t u, double weight, std::size_t i, std::size_t j) {
    const double now = path_.seen[u].now;
    const bool first = past_[i] >= 0, second = past_[j] >= 0;
    double left = first && second ? 0 : 1;
    if (first != second)
      left = past_[first ? j : i] / (past_[first ? j : i] - past_[first ? i : j]);
    found.passed[u] += weight * (1 - left);
    if (left > 0) found.remaining[u].add(weight * left, place_[i] - now, place_[j] - now);
  }

  // What lies beyond the unit's last row counts. Where conditions change, its path goes on from where
  // it stands, wherever under the new ones that is.
  void add_remaining(std::size_t u, const double* x, std::span<const double> z, double weight,
                     double a, double b) {
    const LimitedPath::Seen& seen = path_.seen[u];
    double now = seen.now;
    if (behind_[u]) {
      behind_[u]->move_to(x);
      behind_[u]->evaluate(1, z.empty() ? nullptr : z.data(), &seen.now);
      const double level = behind_[u]->output(0, 0);
      const bool there = path_.rising ? level >= path_.limit : level <= path_.limit;
      if (there) {
        found.passed[u] += weight;
        return;
      }
      ahead_[u].solve(1, z.empty() ? nullptr : z.data(), &level, &now);
    }
    found.passed[u] += weight - found.remaining[u].add_beyond(weight, a, b, now);
  }

  struct Node {
    double weight, z0, z1;
  };
  const OwnRows& rows_;
  const LimitedPath& path_;
  std::optional<Crossing> next_;
  std::vector<Crossing> ahead_;
  std::vector<std::unique_ptr<PathAt>> behind_;
  std::vector<Node> nodes_;
  std::vector<double> z_, place_, past_, level_, grid_;
};

// Of paths that are dear, fewer.
std::size_t points_of(const LimitedPath& path) {
  const auto& any = path.next ? path.next : path.seen.front().ahead;
  if (!any->goes_on()) return most_points;
  return any->running->running.solved ? 200 : 1000;
}

}  // namespace

LimitedLives limited_lives(const OwnRows& rows, const LimitedPath& path,
                           const WeightedDraws& draws) {
  return sum_over(FewPoints(draws, points_of(path)), [&] { return Part(rows, path); });
}

void LimitedLives::add_shares(const LimitedPath& path, const CellMixture& units) {
  const bool all = path.survived <= path.begin;
  const CellMixture& left = all ? units : units.beyond(path.survived);
  const double mass = left.mass();
  by_share.resize(path.shares.size());
  for (std::size_t i = 0; mass > 0 && i < path.shares.size(); ++i) {
    const double life = left.quantile(path.shares[i]);
    by_share[i].add(mass, life, life);
  }
}

void LimitedLives::add(const LimitedLives& other) {
  next.add(other.next);
  by_share.resize(std::max(by_share.size(), other.by_share.size()));
  for (std::size_t i = 0; i < other.by_share.size(); ++i) by_share[i].add(other.by_share[i]);
  for (std::size_t u = 0; u < remaining.size(); ++u) {
    remaining[u].add(other.remaining[u]);
    passed[u] += other.passed[u];
  }
}

}  // namespace wearwell::ownlaw
