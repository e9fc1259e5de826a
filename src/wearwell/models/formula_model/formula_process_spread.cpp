#include "wearwell/models/formula_model/formula_process_spread.h"

#include <algorithm>
#include <cmath>

#include "wearwell/models/formula_model/effect_lines.h"
#include "wearwell/models/formula_model/formula_first_passage.h"
#include "wearwell/predict/thinned_posterior.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t most_points = 100, most_points_of_effects = 25;
constexpr double least_share = 2e-3;  // of a unit's posterior: smaller nodes are left out

// One thread's part: some points of the posterior, one after the other.
class Part {
 public:
  Part(const FormulaRows& rows, const ProcessLimit& mean, const std::vector<SpreadPath>& paths)
      : rows_(rows),
        column_(mean.column),
        form_(*rows.model().measured[mean.column].process),
        effects_(rows.model().effects.size()),
        paths_(paths),
        fresh_(lines_of_new_unit(effects_, 0.5, 4)) {
    for (const SpreadPath& each : paths) {
      at_.push_back(
          std::make_unique<Crossing>(*each.path.ahead, each.rising, each.begin, each.scale));
      found.paths.emplace_back();
      found.paths.back().ahead.resize(each.places.size());
    }
  }

  void add(const double* x, double weight) {
    for (auto& each : at_) each->at().move_to(x);
    UnitRows& units = rows_.mine().rows;
    units.move_to(x);
    add_new(weight);
    if (effects_ == 0) {
      const std::vector<Standing> all = units.standings({}, column_);
      for (std::size_t p = 0; p < paths_.size(); ++p) add_seen(p, nullptr, all, weight);
      return;
    }
    for (const latent::Sweep& sweep : rows_.integrate(x).sweeps) {
      std::vector<Standing> all;
      for (std::size_t p = 0; p < paths_.size(); ++p) {
        if (!paths_[p].unit || !(sweep.weight[*paths_[p].unit] > least_share)) continue;
        if (all.empty()) all = units.standings(sweep.z, column_);
        add_seen(p, &sweep.z[*paths_[p].unit * effects_], all,
                 weight * sweep.weight[*paths_[p].unit]);
      }
    }
  }

  Spreads found;

 private:
  void add_new(double weight) {
    for (std::size_t i = 0; i < fresh_.count(); ++i) {
      const double* z = effects_ > 0 ? &fresh_.z[i * effects_] : nullptr;
      for (std::size_t p = 0; p < paths_.size(); ++p) {
        if (!paths_[p].unit) look_ahead(p, z, 0, {}, weight * fresh_.share[i]);
      }
    }
  }

  void add_seen(std::size_t p, const double* z, const std::vector<Standing>& all, double weight) {
    if (!paths_[p].unit) return;
    const Standing& stands = all[*paths_[p].unit];
    // Under new conditions the mean continues from the position where it has the same value.
    double place = 0;
    at_[p]->solve(1, z, &stands.mean, &place);
    look_ahead(p, z, place - paths_[p].path.now, stands, weight);
  }

  void look_ahead(std::size_t p, const double* z, double shift, const Standing& stands,
                  double weight) {
    constexpr int edges = ScoreTable::edges;
    PathAt& at = at_[p]->at();
    at.stand(1, z);
    for (std::size_t k = 0; k < paths_[p].places.size(); ++k) {
      const double place = paths_[p].places[k] + shift;
      at.evaluate(1, z, &place);
      const double mean = at.output(0, 0), spread = at.output(1, 0);
      const double scale = form_.by_sd ? spread * spread / std::abs(mean) : spread;
      const double grown = mean - stands.mean;
      double step[edges] = {};
      if (form_.process == Process::wiener) {
        // The present value of the path and its growth are both normal.
        const double sd = std::sqrt(stands.variance + scale * std::abs(grown));
        for (int e = 0; e < edges; ++e)
          step[e] = grown + sd * (ScoreTable::first_score + ScoreTable::score_step * e);
      } else if (grown > 0) {
        ScoreTable::increments(form_.process).look_up(grown, scale, step);
      }
      if (form_.process == Process::wiener || stands.cells.empty()) {
        for (double& each : step) each += stands.at;
        found.paths[p].ahead[k].add_curve(weight, ScoreTable::shares(), step);
        continue;
      }
      for (const Standing::Cell& cell : stands.cells) {
        double place_of[edges];
        for (int e = 0; e < edges; ++e) place_of[e] = cell.at + step[e];
        found.paths[p].ahead[k].add_curve(weight * cell.share, ScoreTable::shares(), place_of);
      }
    }
  }

  const FormulaRows& rows_;
  std::size_t column_;
  const ProcessForm& form_;
  std::size_t effects_;
  const std::vector<SpreadPath>& paths_;
  const EffectLines fresh_;
  std::vector<std::unique_ptr<Crossing>> at_;
};

}  // namespace

std::vector<Spread> process_spreads(const FormulaRows& rows, const ProcessLimit& mean,
                                    const std::vector<SpreadPath>& paths,
                                    const WeightedDraws& draws, std::size_t finer) {
  const std::size_t most = rows.model().has_random_effects() ? most_points_of_effects : most_points;
  return sum_over(ThinnedPosterior(draws, finer * most), [&] { return Part(rows, mean, paths); })
      .paths;
}

}  // namespace wearwell::formula_model
