#include <algorithm>
#include <cmath>

#include "wearwell/latent/unit_integral.h"
#include "wearwell/models/formula_model/formula_drawn.h"

namespace wearwell::formula_model {
namespace {

// Units by their drawn effects, at one point of all other parameters.
class DrawnUnits final : public latent::UnitTerms {
 public:
  DrawnUnits(const FormulaModel& model, std::span<const double> x, const LogDensity& likelihood,
             const std::function<std::vector<double>(std::span<const double>)>& each)
      : likelihood_(likelihood), each_(each), x_(x.begin(), x.end()), gradient_(x.size()) {
    for (const DrawnEffect& effect : model.drawn) {
      if (model.label == effect.label) first_.push_back(effect.first);
    }
    units_ = model.units.size();
  }

  std::size_t units() const override { return units_; }
  int effects() const override { return static_cast<int>(first_.size()); }

  void evaluate(std::span<const double> z, std::span<const std::uint8_t> wanted,
                std::span<double> value, std::span<double> slope) override {
    const std::size_t d = first_.size();
    for (std::size_t u = 0; u < units_; ++u) {
      for (std::size_t e = 0; e < d && wanted[u]; ++e) x_[first_[e] + u] = z[u * d + e];
    }
    const std::vector<double> all = each_(x_);
    for (std::size_t u = 0; u < units_; ++u) {
      if (wanted[u]) value[u] = std::isnan(all[u]) ? -INFINITY : all[u];
    }
    if (slope.empty()) return;
    // A unit's effects affect only its own rows.
    const bool sloped = likelihood_.value_and_gradient(x_, gradient_) > -INFINITY;
    for (std::size_t u = 0; u < units_; ++u) {
      for (std::size_t e = 0; e < d && wanted[u]; ++e) {
        slope[u * d + e] = sloped ? gradient_[first_[e] + u] : 0;
      }
    }
  }

 private:
  const LogDensity& likelihood_;
  const std::function<std::vector<double>(std::span<const double>)>& each_;
  std::vector<double> x_, gradient_;
  std::vector<std::size_t> first_;
  std::size_t units_ = 0;
};

}  // namespace

std::vector<double> without_drawn_effects(
    const FormulaModel& model, std::span<const double> x, const LogDensity& likelihood,
    const std::function<std::vector<double>(std::span<const double> x)>& each) {
  DrawnUnits units(model, x, likelihood, each);
  latent::UnitIntegrals integrals;
  latent::integrate(units, integrals);
  return integrals.log_likelihood;
}

}  // namespace wearwell::formula_model
