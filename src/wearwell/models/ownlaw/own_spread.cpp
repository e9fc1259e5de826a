#include "wearwell/models/ownlaw/own_spread.h"

#include <algorithm>
#include <cmath>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/models/ownlaw/few_points.h"

namespace wearwell::ownlaw {
namespace {

// Effects of a unit, and cells that reach from one to another, of a weight each.
struct Effects {
  struct Cell {
    double weight;
    std::size_t from, to;
  };
  std::vector<double> z;
  std::size_t count = 0;
  std::vector<Cell> cells;

  void clear() {
    z.clear();
    cells.clear();
    count = 0;
  }
};

// Cells of even width over the standard normal law; of two effects those of the plane, each from a
// corner to the one across, which bounds what is monotone in both.
Effects of_new_unit(std::size_t effects) {
  Effects all;
  if (effects == 0) {
    all.count = 1;
    all.cells = {{1, 0, 0}};
    return all;
  }
  const double width = effects == 1 ? 0.25 : 0.5;
  constexpr double farthest = 6;
  std::vector<double> end, share;
  for (double z = -farthest; z < farthest + 0.5 * width; z += width) end.push_back(z);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < end.size(); ++i) {
    share.push_back(normal_cdf(end[i + 1]) - normal_cdf(end[i]));
    sum += share.back();
  }
  for (double& each : share) each /= sum;
  const std::size_t n = end.size();
  if (effects == 1) {
    all.z = end;
    all.count = n;
    for (std::size_t i = 0; i + 1 < n; ++i) all.cells.push_back({share[i], i, i + 1});
    return all;
  }
  for (const double a : end) {
    for (const double b : end) all.z.insert(all.z.end(), {a, b});
  }
  all.count = n * n;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    for (std::size_t j = 0; j + 1 < n; ++j) {
      const double weight = share[i] * share[j];
      if (weight < 1e-9) continue;
      all.cells.push_back({0.5 * weight, i * n + j, (i + 1) * n + j + 1});
      all.cells.push_back({0.5 * weight, i * n + j + 1, (i + 1) * n + j});
    }
  }
  return all;
}

// The nodes on which a unit's effects were integrated out.
void of_seen_unit(const latent::UnitIntegrals& integrals, std::size_t unit, std::size_t effects,
                  Effects& all) {
  constexpr double negligible = 1e-7;
  struct Node {
    double weight, z[2];
  };
  static thread_local std::vector<Node> nodes;
  nodes.clear();
  all.clear();
  for (const latent::Sweep& sweep : integrals.sweeps) {
    if (!(sweep.weight[unit] > negligible)) continue;
    const double* z = &sweep.z[unit * effects];
    nodes.push_back({sweep.weight[unit], {z[0], effects > 1 ? z[1] : 0}});
  }
  if (effects > 1) {
    for (const Node& each : nodes) {
      all.z.insert(all.z.end(), {each.z[0], each.z[1]});
      all.cells.push_back({each.weight, all.count, all.count});
      ++all.count;
    }
    return;
  }
  std::sort(nodes.begin(), nodes.end(),
            [](const Node& a, const Node& b) { return a.z[0] < b.z[0]; });
  const std::size_t n = nodes.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double before = i > 0   ? 0.5 * (nodes[i].z[0] - nodes[i - 1].z[0])
                          : n > 1 ? 0.5 * (nodes[1].z[0] - nodes[0].z[0])
                                  : 0;
    all.z.push_back(nodes[i].z[0] - before);
    all.cells.push_back({nodes[i].weight, i, i + 1});
    if (i + 1 == n) all.z.push_back(nodes[i].z[0] + before);
  }
  all.count = all.z.size();
}

// One thread's part: some points of the posterior, one after the other.
class Part {
 public:
  Part(const OwnRows& rows, const std::vector<SpreadPath>& paths)
      : rows_(rows), effects_(rows.law().effects.size()), paths_(paths) {
    fresh_ = of_new_unit(effects_);
    for (const SpreadPath& each : paths) {
      at_.push_back(
          std::make_unique<Crossing>(*each.path.ahead, each.rising, each.begin, each.scale));
      behind_.push_back(each.path.behind ? std::make_unique<PathAt>(*each.path.behind) : nullptr);
      any_seen_ |= each.unit.has_value();
      Spread spread;
      spread.ahead.resize(each.places.size());
      trace_.push_back(each.trace ? std::make_unique<PathAt>(*each.trace) : nullptr);
      if (each.trace) spread.traced.resize(each.trace->running->history->rows());
      found.paths.push_back(std::move(spread));
    }
  }

  void add(const double* x, double weight) {
    const latent::UnitIntegrals* integrals =
        any_seen_ && effects_ > 0 ? &rows_.integrate(x) : nullptr;
    for (std::size_t p = 0; p < paths_.size(); ++p) {
      const SpreadPath& path = paths_[p];
      const bool known = path.unit && effects_ > 0;
      if (known) of_seen_unit(*integrals, *path.unit, effects_, seen_);
      const Effects& effects = known ? seen_ : fresh_;
      if (effects.count == 0) continue;
      at_[p]->at().move_to(x);
      if (trace_[p]) {
        trace_[p]->move_to(x);
        trace(p, effects, weight);
      }
      look_ahead(p, x, effects, weight);
    }
  }

  Spreads found;

 private:
  const double* z_of(const Effects& effects, std::size_t i) const {
    return effects_ > 0 ? &effects.z[i * effects_] : nullptr;
  }

  void trace(std::size_t p, const Effects& effects, double weight) {
    PathAt& at = *trace_[p];
    const std::size_t rows = found.paths[p].traced.size();
    value_.resize(rows * effects.count);
    for (std::size_t i = 0; i < effects.count; ++i) {
      at.retrace(z_of(effects, i));
      for (std::size_t r = 0; r < rows; ++r) value_[r * effects.count + i] = at.retraced(0, r);
    }
    for (std::size_t r = 0; r < rows; ++r) {
      for (const Effects::Cell& cell : effects.cells) {
        found.paths[p].traced[r].add(weight * cell.weight, value_[r * effects.count + cell.from],
                                     value_[r * effects.count + cell.to]);
      }
    }
  }

  // Where conditions change, the path of a unit goes on from where it stands, wherever under the new
  // ones that is.
  void find_shifts(std::size_t p, const double* x, const Effects& effects) {
    shift_.assign(effects.count, 0);
    if (!behind_[p]) return;
    behind_[p]->move_to(x);
    for (std::size_t i = 0; i < effects.count; ++i) {
      const double* z = z_of(effects, i);
      behind_[p]->evaluate(1, z, &paths_[p].path.now);
      const double level = behind_[p]->output(0, 0);
      double now = 0;
      at_[p]->solve(1, z, &level, &now);
      shift_[i] = now - paths_[p].path.now;
    }
  }

  void look_ahead(std::size_t p, const double* x, const Effects& effects, double weight) {
    const SpreadPath& path = paths_[p];
    find_shifts(p, x, effects);
    PathAt& at = at_[p]->at();
    const std::size_t places = path.places.size();
    value_.resize(places * effects.count);
    for (std::size_t begin = 0; begin < effects.count; begin += Path::most) {
      const std::size_t n = std::min(Path::most, effects.count - begin);
      const double* z = z_of(effects, begin);
      at.stand(n, z);
      for (std::size_t k = 0; k < places; ++k) {
        place_.resize(n);
        for (std::size_t i = 0; i < n; ++i) place_[i] = path.places[k] + shift_[begin + i];
        at.evaluate(n, z, place_.data());
        for (std::size_t i = 0; i < n; ++i) value_[k * effects.count + begin + i] = at.output(0, i);
      }
    }
    for (std::size_t k = 0; k < places; ++k) {
      for (const Effects::Cell& cell : effects.cells) {
        found.paths[p].ahead[k].add(weight * cell.weight, value_[k * effects.count + cell.from],
                                    value_[k * effects.count + cell.to]);
      }
    }
  }

  const OwnRows& rows_;
  std::size_t effects_;
  const std::vector<SpreadPath>& paths_;
  bool any_seen_ = false;
  Effects fresh_, seen_;
  std::vector<std::unique_ptr<Crossing>> at_;
  std::vector<std::unique_ptr<PathAt>> behind_, trace_;
  std::vector<double> value_, place_, shift_;
};

}  // namespace

void Spreads::add(const Spreads& other) {
  const auto sum = [](std::vector<CellMixture>& to, const std::vector<CellMixture>& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i].add(from[i]);
  };
  for (std::size_t i = 0; i < paths.size(); ++i) {
    sum(paths[i].traced, other.paths[i].traced);
    sum(paths[i].ahead, other.paths[i].ahead);
  }
}

std::vector<Spread> spreads(const OwnRows& rows, const std::vector<SpreadPath>& paths,
                            const WeightedDraws& draws, std::size_t most_points) {
  return sum_over(FewPoints(draws, most_points), [&] { return Part(rows, paths); }).paths;
}

}  // namespace wearwell::ownlaw
