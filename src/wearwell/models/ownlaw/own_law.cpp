#include "wearwell/models/ownlaw/own_law.h"

#include <algorithm>
#include <cmath>

#include "wearwell/law/no_columns.h"

namespace wearwell::ownlaw {

bool OwnLaw::has_process() const {
  return std::any_of(measured.begin(), measured.end(),
                     [](const Measured& each) { return each.process != nullptr; });
}

bool OwnLaw::has_hidden_paths() const {
  return std::any_of(measured.begin(), measured.end(), [](const Measured& each) {
    return each.process && each.process->process != Process::wiener && each.wanted.size() > 2;
  });
}

bool OwnLaw::is_drawn(const std::string& of) const {
  return std::any_of(drawn.begin(), drawn.end(),
                     [&](const DrawnEffect& each) { return each.label == of; });
}

std::size_t OwnLaw::drawn_correlation(std::size_t effect) const {
  std::size_t at = drawn.size();
  for (std::size_t i = 0; i < effect; ++i) at += drawn[i].correlation ? 1 : 0;
  return at;
}

double Population::value(const OwnLaw& law, std::size_t i, const double* z) const {
  const double own =
      i == 0 ? z[0] : correlation * z[0] + std::sqrt(1 - correlation * correlation) * z[1];
  return law.effects[i].lognormal ? middle[i] * std::exp(scatter[i] * own)
                                  : middle[i] + scatter[i] * own;
}

PopulationAt::PopulationAt(const OwnLaw& law) : law_(&law) {
  if (!law.varies()) return;
  data_ = law::bind_no_columns(law.population, law.symbols);
  workspace_ = law.population.workspace(1);
}

Population PopulationAt::operator()(const double* x) {
  Population p;
  if (!law_->varies()) return p;
  law_->population.forward(data_, 0, 1, {{x, law_->parameters.size()}, {}}, workspace_);
  for (std::size_t i = 0; i < law_->effects.size(); ++i) {
    p.middle[i] = x[law_->effects[i].parameter];
    p.scatter[i] = workspace_.values(i)[0];
  }
  if (law_->correlated) p.correlation = workspace_.values(law_->effects.size())[0];
  return p;
}

void PopulationAt::add_gradient(const double* x, const Population& by, std::span<double> gradient) {
  for (std::size_t i = 0; i < law_->effects.size(); ++i) {
    gradient[law_->effects[i].parameter] += by.middle[i];
    workspace_.adjoints(i)[0] = by.scatter[i];
  }
  if (law_->correlated) workspace_.adjoints(law_->effects.size())[0] = by.correlation;
  law_->population.reverse(data_, 0, 1, {{x, law_->parameters.size()}, {}}, workspace_, gradient);
}

}  // namespace wearwell::ownlaw
