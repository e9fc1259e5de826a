#include "wearwell/models/formula_model/formula_spread.h"

#include <algorithm>
#include <array>

#include "wearwell/models/formula_model/effect_lines.h"
#include "wearwell/predict/thinned_posterior.h"

namespace wearwell::formula_model {
namespace {

// One thread's part: some points of the posterior, one after the other.
class Part {
 public:
  Part(const FormulaRows& rows, const std::vector<SpreadPath>& paths)
      : rows_(rows), effects_(rows.model().effects.size()), paths_(paths) {
    fresh_ = lines_of_new_unit(effects_, 0.25, effects_ > 1 ? 5 : 8.25);
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
      if (known) lines_of_seen_unit(*integrals, *path.unit, effects_, seen_);
      at_[p]->at().move_to(x);
      if (!known && effects_ == 2) turn(fresh_, steepest(p).data(), seen_);
      const EffectLines& effects = known || effects_ == 2 ? seen_ : fresh_;
      if (effects.count() == 0) continue;
      if (trace_[p]) {
        trace_[p]->move_to(x);
        trace(p, effects, weight);
      }
      look_ahead(p, x, effects, weight);
    }
  }

  Spreads found;

 private:
  const double* z_of(const EffectLines& effects, std::size_t i) const {
    return effects_ > 0 ? &effects.z[i * effects_] : nullptr;
  }

  void trace(std::size_t p, const EffectLines& effects, double weight) {
    PathAt& at = *trace_[p];
    const std::size_t rows = found.paths[p].traced.size();
    value_.resize(rows * effects.count());
    for (std::size_t i = 0; i < effects.count(); ++i) {
      at.retrace(z_of(effects, i));
      for (std::size_t r = 0; r < rows; ++r) value_[r * effects.count() + i] = at.retraced(0, r);
    }
    for (std::size_t r = 0; r < rows; ++r) {
      add_curves(effects, r, weight, found.paths[p].traced[r]);
    }
  }

  // The i-th value of all nodes.
  void add_curves(const EffectLines& effects, std::size_t i, double weight, CellMixture& to) {
    const std::span<const double> values = std::span(value_).subspan(i * effects.count());
    effects.each(values, [&](auto share, auto value) { to.add_curve(weight, share, value); });
    to.limit_size();
  }

  // The direction of two effects in which the path of a new unit changes, at the farthest position.
  std::array<double, 2> steepest(std::size_t p) {
    constexpr double away = 0.5, z[] = {away, 0, -away, 0, 0, away, 0, -away};
    const double farthest = paths_[p].places.empty() ? 0 : paths_[p].places.back();
    const double place[] = {farthest, farthest, farthest, farthest};
    PathAt& at = at_[p]->at();
    at.stand(4, z);
    at.evaluate(4, z, place);
    return {at.output(0, 0) - at.output(0, 1), at.output(0, 2) - at.output(0, 3)};
  }

  // How far the path of each unit moves along the axis where conditions change.
  void find_shifts(std::size_t p, const double* x, const EffectLines& effects) {
    shift_.assign(effects.count(), 0);
    if (!behind_[p]) return;
    behind_[p]->move_to(x);
    const double now = paths_[p].path.now;
    continued_.find(*behind_[p], *at_[p], now, effects.z, effects_, effects.count());
    for (std::size_t i = 0; i < effects.count(); ++i) shift_[i] = continued_.place[i] - now;
  }

  void look_ahead(std::size_t p, const double* x, const EffectLines& effects, double weight) {
    const SpreadPath& path = paths_[p];
    find_shifts(p, x, effects);
    PathAt& at = at_[p]->at();
    const std::size_t places = path.places.size();
    value_.resize(places * effects.count());
    for (std::size_t begin = 0; begin < effects.count(); begin += Path::most) {
      const std::size_t n = std::min(Path::most, effects.count() - begin);
      const double* z = z_of(effects, begin);
      at.stand(n, z);
      for (std::size_t k = 0; k < places; ++k) {
        place_.resize(n);
        for (std::size_t i = 0; i < n; ++i) place_[i] = path.places[k] + shift_[begin + i];
        at.evaluate(n, z, place_.data());
        for (std::size_t i = 0; i < n; ++i)
          value_[k * effects.count() + begin + i] = at.output(0, i);
      }
    }
    for (std::size_t k = 0; k < places; ++k) {
      add_curves(effects, k, weight, found.paths[p].ahead[k]);
    }
  }

  const FormulaRows& rows_;
  std::size_t effects_;
  const std::vector<SpreadPath>& paths_;
  bool any_seen_ = false;
  EffectLines fresh_, seen_;
  std::vector<std::unique_ptr<Crossing>> at_;
  std::vector<std::unique_ptr<PathAt>> behind_, trace_;
  Continuation continued_;
  std::vector<double> value_, place_, shift_;
};

}  // namespace

void Spreads::add(const Spreads& other) {
  const auto sum = [this](std::vector<CellMixture>& to, const std::vector<CellMixture>& from) {
    for (std::size_t i = 0; i < to.size(); ++i) {
      to[i].add(from[i]);
      to[i].limit_size();
    }
  };
  for (std::size_t i = 0; i < paths.size(); ++i) {
    sum(paths[i].traced, other.paths[i].traced);
    sum(paths[i].ahead, other.paths[i].ahead);
  }
}

std::vector<Spread> spreads(const FormulaRows& rows, const std::vector<SpreadPath>& paths,
                            const WeightedDraws& draws, std::size_t most_points) {
  return sum_over(ThinnedPosterior(draws, most_points), [&] { return Part(rows, paths); }).paths;
}

}  // namespace wearwell::formula_model
