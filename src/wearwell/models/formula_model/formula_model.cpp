#include "wearwell/models/formula_model/formula_model.h"

#include <algorithm>
#include <cmath>

#include "wearwell/formula/no_columns.h"

namespace wearwell::formula_model {

bool FormulaModel::has_process() const {
  return std::any_of(measured.begin(), measured.end(),
                     [](const Measured& each) { return each.process != nullptr; });
}

bool FormulaModel::has_hidden_paths() const {
  return std::any_of(measured.begin(), measured.end(), [](const Measured& each) {
    return each.process && each.process->process != Process::wiener && each.wanted.size() > 2;
  });
}

bool FormulaModel::is_drawn(const std::string& of) const {
  return std::any_of(drawn.begin(), drawn.end(),
                     [&](const DrawnEffect& each) { return each.label == of; });
}

std::size_t FormulaModel::drawn_correlation(std::size_t effect) const {
  std::size_t at = drawn.size();
  for (std::size_t i = 0; i < effect; ++i) at += drawn[i].correlation ? 1 : 0;
  return at;
}

double Population::value(const FormulaModel& model, std::size_t i, const double* z) const {
  const double own =
      i == 0 ? z[0] : correlation * z[0] + std::sqrt(1 - correlation * correlation) * z[1];
  return model.effects[i].lognormal ? middle[i] * std::exp(scatter[i] * own)
                                    : middle[i] + scatter[i] * own;
}

PopulationAt::PopulationAt(const FormulaModel& model) : model_(&model) {
  if (!model.has_random_effects()) return;
  data_ = formula::bind_no_columns(model.population, model.symbols);
  workspace_ = model.population.workspace(1);
}

Population PopulationAt::operator()(const double* x) {
  Population p;
  if (!model_->has_random_effects()) return p;
  model_->population.forward(data_, 0, 1, {{x, model_->parameters.size()}, {}}, workspace_);
  for (std::size_t i = 0; i < model_->effects.size(); ++i) {
    p.middle[i] = x[model_->effects[i].parameter];
    p.scatter[i] = workspace_.values(i)[0];
  }
  if (model_->correlated) p.correlation = workspace_.values(model_->effects.size())[0];
  return p;
}

void PopulationAt::add_gradient(const double* x, const Population& by, std::span<double> gradient) {
  for (std::size_t i = 0; i < model_->effects.size(); ++i) {
    gradient[model_->effects[i].parameter] += by.middle[i];
    workspace_.adjoints(i)[0] = by.scatter[i];
  }
  if (model_->correlated) workspace_.adjoints(model_->effects.size())[0] = by.correlation;
  model_->population.reverse(data_, 0, 1, {{x, model_->parameters.size()}, {}}, workspace_,
                             gradient);
}

}  // namespace wearwell::formula_model
