#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "wearwell/models/formula_model/node_points.h"
#include "wearwell/models/formula_model/rate_change_unit.h"

// The forecast of a unit whose rate may change: the mixture of those without and with a change.
namespace wearwell::formula_model {

// Changes after the last row, one of each node.
NodeAxis RateChangeUnit::future(std::size_t nodes) const {
  NodeAxis axis;
  const double from = last_place();
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto [place, score] = change_fractions(i);
    axis.since.push_back(from - std::log1p(-place) / shared_->prior.hazard);
    axis.factor.push_back(shared_->prior.factor(normal_quantile(score)));
  }
  return axis;
}

prognosis::Forecast RateChangeUnit::forecast() const {
  const NodeLives& lives = base_->lives();
  const UnitReading last = last_row();
  std::vector<double> weight;
  normalize(base_->log_weight_, weight);
  LivesSample unchanged = lives.lives(base_->nodes_.nodes, weight, last, base_->paths_);
  const NodeAxis axis = future(unchanged.lives.size());
  for (std::size_t i = 0; i < unchanged.lives.size(); ++i)
    unchanged.lives[i] = axis.back(i, last.place + unchanged.lives[i]) - last.place;
  const double changed = probability();
  LivesSample both;
  both.add(unchanged, 1 - changed);
  prognosis::RateChange change{changed,      std::nan(""), std::nan(""), std::nan(""),
                               std::nan(""), std::nan(""), std::nan("")};
  double effective = effective_number(base_->log_weight_);
  if (changed_.count() > 0) {
    normalize(changed_.log_weight, weight);
    both.add(lives.lives(changed_.nodes, weight, last, changed_.paths, &changed_.axis), changed);
    const prognosis::WeightedLives since(changed_.axis.since, weight);
    const prognosis::WeightedLives factor(changed_.axis.factor, weight);
    change = {changed,
              since.quantile(0.05),
              since.quantile(0.5),
              since.quantile(0.95),
              factor.quantile(0.05),
              factor.quantile(0.5),
              factor.quantile(0.95)};
    effective = 1 / ((1 - changed) * (1 - changed) / effective +
                     changed * changed / effective_number(changed_.log_weight));
  }
  prognosis::Forecast forecast = both.forecast();
  move_levels(forecast, -base_->moved_);
  forecast.now = last.place;
  forecast.effective = effective;
  forecast.rate_change = change;
  return forecast;
}

std::vector<prognosis::ForecastBand> RateChangeUnit::ahead(std::span<const double> places) const {
  const NodeLives& lives = base_->lives();
  const UnitReading last = last_row();
  if (std::any_of(places.begin(), places.end(), [&](double x) { return !(x >= last.place); }))
    throw std::invalid_argument("a position that is not ahead");
  std::vector<double> weight;
  normalize(base_->log_weight_, weight);
  const NodeAxis axis = future(base_->nodes_.nodes.count());
  const double changed = probability();
  const std::vector<LevelSample> unchanged =
      lives.levels_ahead(base_->nodes_.nodes, weight, last, base_->paths_, places, &axis);
  std::vector<LevelSample> moved;
  if (changed_.count() > 0) {
    normalize(changed_.log_weight, weight);
    moved =
        lives.levels_ahead(changed_.nodes, weight, last, changed_.paths, places, &changed_.axis);
  }
  std::vector<prognosis::ForecastBand> found;
  for (std::size_t k = 0; k < places.size(); ++k) {
    LevelSample both;
    both.add(unchanged[k], 1 - changed);
    if (!moved.empty()) both.add(moved[k], changed);
    found.push_back(both.at(places[k]));
    move_levels(found.back(), -base_->moved_);
  }
  return found;
}

}  // namespace wearwell::formula_model
