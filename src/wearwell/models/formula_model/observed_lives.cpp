#include "wearwell/models/formula_model/observed_lives.h"

#include <algorithm>
#include <cmath>

namespace wearwell::formula_model {
namespace {

double end_of_observation(const Response& y) {
  return y.seen == Censoring::interval ? y.until : y.at;
}

bool depends_on_conditions(const FormulaModel& model) {
  for (const Measured& each : model.measured) {
    for (std::size_t c = 0; c < model.row_symbols.columns.size(); ++c)
      if (each.program.uses_column(c)) return true;
  }
  return false;
}

}  // namespace

ObservedLives::ObservedLives(std::shared_ptr<const FormulaRows> rows) {
  const FormulaModel& model = rows->model();
  // With rates of use the last of `measured` are ages and rates.
  if (depends_on_conditions(model) || model.has_random_effects() || !model.drawn.empty()) {
    if (!model.modes && !model.use_rate && !model.has_exposure() && !model.has_random_effects() &&
        model.drawn.empty())
      rows_ = std::move(rows);
    return;
  }
  double longest = 0;
  for (const Response& each :
       model.modes ? model.lives.responses : model.measured.front().observed.responses)
    longest = std::max(longest, end_of_observation(each));
  if (longest > 0 && std::isfinite(longest)) longest_ = longest;
}

ObservedLives ObservedLives::of_other_life() const {
  ObservedLives other = *this;
  other.rows_ = nullptr;
  return other;
}

std::optional<double> ObservedLives::longest(const LifeDistribution& life,
                                             const WeightedDraws& draws) const {
  if (!rows_) return longest_;
  const Measured& measured = rows_->model().measured.front();
  const Eigen::RowVectorXd mean = draws.weights.transpose() * draws.values;
  UnitRows& units = rows_->mine().rows;
  units.move_to(mean.data());
  const std::vector<double> parameters = units.each_family_parameter({}).front();
  double log_survival = 0;
  const std::vector<Response>& observed = measured.observed.responses;
  for (std::size_t i = 0; i < observed.size(); ++i)
    log_survival = std::min(
        log_survival, measured.life.log_survival(end_of_observation(observed[i]),
                                                 &parameters[i * measured.life.parameters()]));
  const double failed = -std::expm1(log_survival);
  if (!(failed > 0 && failed < 1)) return {};
  LifeAtPoint at = life.at_point();
  at.move_to(mean.data());
  const double longest = at.quantile(failed);
  return longest > 0 && std::isfinite(longest) ? std::optional(longest) : std::nullopt;
}

}  // namespace wearwell::formula_model
