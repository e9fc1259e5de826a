#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "wearwell/models/formula_model/formula_first_passage.h"
#include "wearwell/models/formula_model/node_points.h"
#include "wearwell/models/formula_model/nodes_ahead.h"
#include "wearwell/prognosis/weighted_quantiles.h"

// The forecast of units from the same nodes as their lives, at given positions.
namespace wearwell::formula_model {
namespace {

constexpr double unknown =
    1e-3;  // of the weight: with a larger share that is not a number, quantiles are NaN

// A path whose mean has grown by `grown` since its last reading, where its value was normal(at,
// variance).
struct RandomStep {
  Process process;
  double at, variance, grown, scale;

  double quantile(double p) const {
    if (process == Process::wiener) {
      return at + grown + std::sqrt(variance + scale * std::abs(grown)) * normal_quantile(p);
    }
    if (!(grown > 0)) return grown <= 0 ? at : grown;
    double values[ScoreTable::edges];
    ScoreTable::increments(process).look_up(grown, scale, values);
    for (double& each : values) each = std::max(each, 1e-300);
    // Most steps that are small relative to their scale are near zero: there a cubic overshoots.
    const double score = normal_quantile(p);
    const double place = (score - ScoreTable::first_score) / ScoreTable::score_step;
    const auto edge =
        static_cast<std::size_t>(std::clamp(std::floor(place), 0.0, ScoreTable::edges - 2.0));
    return at + std::clamp(at_score(values, score), values[edge], values[edge + 1]);
  }
};

}  // namespace

void LevelSample::add(double w, double level) {
  all += w;
  if (std::isnan(level)) {
    lost += w;
  } else {
    value.push_back(level);
    weight.push_back(w);
  }
}

void LevelSample::add(const LevelSample& other, double times) {
  value.insert(value.end(), other.value.begin(), other.value.end());
  for (const double each : other.weight) weight.push_back(times * each);
  all += times * other.all;
  lost += times * other.lost;
}

prognosis::ForecastBand LevelSample::at(double place) const {
  if (lost > unknown * all || value.empty()) {
    return {place, std::nan(""), std::nan(""), std::nan("")};
  }
  const std::vector<double> level =
      prognosis::weighted_quantiles(value, weight, std::array{0.05, 0.5, 0.95});
  return {place, level[0], level[1], level[2]};
}

std::vector<LevelSample> NodeLives::levels_ahead(const Nodes& nodes,
                                                 const std::vector<double>& weight,
                                                 const UnitReading& last,
                                                 const std::vector<NodePath>& paths,
                                                 std::span<const double> places,
                                                 const NodeAxis* axis) const {
  std::vector<LevelSample> levels(places.size());
  Ahead ahead(*this, nodes, last, paths.back(), axis);
  const std::size_t line = model_->effects.size() == 1 && !axis ? nodes.per_line : 1;
  const std::size_t pass = most_crossings / line * line;  // whole lines
  const NodePath& path = paths[column_];
  const bool noisy = process_ && path.measured && !path.variance.empty();
  for (std::size_t begin = 0; begin < nodes.count(); begin += pass) {
    ahead.begin = begin;
    ahead.count = std::min(pass, nodes.count() - begin);
    const std::span<const double> own = std::span(weight).subspan(begin, ahead.count);
    if (std::all_of(own.begin(), own.end(), [](double w) { return w < 1e-14; })) continue;
    double start[most_crossings], place[most_crossings], level[most_crossings];
    ahead.here(start);
    // under new conditions, from the position where the future path has the same value
    if (ahead.changes) {
      ahead.now(0, level);
      ahead.cross(level, start);
    }
    std::optional<DrawnLines> drawn;
    if (!process_) drawn.emplace(own, line);
    for (std::size_t k = 0; k < places.size(); ++k) {
      for (std::size_t i = 0; i < ahead.count; ++i) {
        place[i] = start[i] + (ahead.place_of(i, places[k]) - ahead.place_of(i, last.place));
      }
      ahead.evaluate(ahead.ahead, place);
      for (std::size_t i = 0; i < ahead.count; ++i) level[i] = ahead.at(0, i);
      if (!process_) {
        drawn->put({level, ahead.count},
                   [&](std::size_t, double w, double value) { levels[k].add(w, value); });
        continue;
      }
      for (std::size_t i = 0; i < ahead.count; ++i) {
        const std::size_t node = begin + i;
        if (!(own[i] > 1e-14)) continue;
        const double spread = ahead.at(1, i), mean = std::abs(level[i]);
        const RandomStep step{process_->process,
                              !path.measured ? 0
                              : noisy        ? path.at[node]
                                             : path.reading,
                              noisy ? path.variance[node] : 0,
                              level[i] - (path.measured ? path.mean[node] : 0),
                              !process_->by_sd ? spread
                              : mean > 0       ? spread * spread / mean
                                               : 0};
        for (std::size_t j = 0; j < points_of_node; ++j) {
          const double p =
              (static_cast<double>(j) + fraction(node, 0.6180339887498949)) / points_of_node;
          levels[k].add(own[i] / points_of_node, step.quantile(p));
        }
      }
    }
  }
  return levels;
}

std::vector<prognosis::ForecastBand> NodeLives::ahead(const Nodes& nodes,
                                                      const std::vector<double>& weight,
                                                      const UnitReading& last,
                                                      const std::vector<NodePath>& paths,
                                                      std::span<const double> places) const {
  const std::vector<LevelSample> levels = levels_ahead(nodes, weight, last, paths, places);
  std::vector<prognosis::ForecastBand> found;
  for (std::size_t k = 0; k < places.size(); ++k) found.push_back(levels[k].at(places[k]));
  return found;
}

}  // namespace wearwell::formula_model
