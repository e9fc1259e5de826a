#include "wearwell/models/formula_model/mode_figures.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/group_colour.h"
#include "wearwell/present/plot.h"
#include "wearwell/study/plot_study.h"

namespace wearwell::formula_model {
namespace {

using Numbers = std::vector<double>;

constexpr std::size_t places = 25;
constexpr Eigen::Index draws_of_bands = 1000;

const char* colour_of_mode(std::size_t k) {
  return group_colour(k + 1);  // as in the probability plot, after all modes
}

double longest_life(const Observed& lives) {
  double most = 0;
  for (const Response& each : lives.responses)
    most = std::max(most, each.seen == Censoring::interval ? each.until : each.at);
  return most;
}

html::Figure incidence_figure(const FormulaModel& model, const LifeDistribution& part,
                              const std::string& conditions, const Fit& fit) {
  const Unit& unit = model.measured.front().unit;
  const std::vector<std::string>& modes = model.modes->modes;
  const WeightedDraws draws = thinned(fit.exact ? fit.exact->nodes : fit.pooled, draws_of_bands);
  const double longest = longest_life(model.lives);
  struct Band {
    double low, middle, high;
  };
  std::vector<Band> bands(modes.size() * places);
  tbb::parallel_for(std::size_t{0}, bands.size(), [&](std::size_t i) {
    const double life = longest * static_cast<double>(i % places) / (places - 1);
    const QuantityDistribution known = part.incidence(draws, i / places, life).distribution;
    bands[i] = {known.quantile(0.05), known.quantile(0.5), known.quantile(0.95)};
  });
  const auto steps = conditions.empty() ? incidence_steps(*model.modes, model.lives)
                                        : std::vector<std::vector<IncidenceStep>>();
  std::vector<plot::Json> marks;
  double most = 0;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    Numbers x, low, middle, high;
    for (std::size_t i = 0; i < places; ++i) {
      const Band& band = bands[k * places + i];
      x.push_back(from_si(unit, longest * static_cast<double>(i) / (places - 1)));
      low.push_back(100 * band.low);
      middle.push_back(100 * band.middle);
      high.push_back(100 * band.high);
      most = std::max(most, high.back());
    }
    marks.push_back(
        plot::area({{"x", x}, {"y", high}, {"y2", low}}, {colour_of_mode(k), "", 0.22}));
    marks.push_back(plot::line({{"x", x}, {"y", middle}, {"failed [%]", middle}},
                               {colour_of_mode(k), modes[k], 1, 2}));
    if (steps.empty()) continue;
    Numbers at, share;
    for (const IncidenceStep& each : steps[k]) {
      at.push_back(from_si(unit, each.at));
      share.push_back(100 * each.share);
      most = std::max(most, share.back());
    }
    marks.push_back(plot::points({{"x", at}, {"y", share}, {"failed [%]", share}},
                                 {colour_of_mode(k), "", 1, 0, false, 50}));
  }
  const std::string column = model.measured.front().column, shown = html::unit(unit.text);
  return {
      "cumulative-incidence", "Share failed by each mode (cumulative incidence)",
      fmt::format(
          "All modes are at work, so the shares add up to the share that has failed{}. Lines are "
          "posterior medians, bands hold 90 %.{}",
          conditions.empty() ? "" : ", at " + conditions,
          steps.empty() ? "" : " Points are the Aalen-Johansen estimate."),
      plot::plot(fmt::format("Share failed by each mode against {}", column),
                 {html::capital(column) + (shown.empty() ? "" : fmt::format(" [{}]", shown)), false,
                  0, from_si(unit, longest)},
                 {"Failed [%]", false, 0, std::min(100.0, 1.05 * most)}, marks, 300, true)};
}

}  // namespace

std::vector<std::vector<IncidenceStep>> incidence_steps(const FailureModes& modes,
                                                        const Observed& lives) {
  std::vector<double> failures;
  for (std::size_t i = 0; i < lives.responses.size(); ++i) {
    const std::uint32_t possible = modes.possible[lives.rows[i]];
    const Censoring seen = lives.responses[i].seen;
    if (std::popcount(possible) > 1 || seen == Censoring::left || seen == Censoring::interval)
      return {};
    if (possible != 0) failures.push_back(lives.responses[i].at);
  }
  std::sort(failures.begin(), failures.end());
  failures.erase(std::unique(failures.begin(), failures.end()), failures.end());
  constexpr std::size_t most = 2000;  // failures; each costs a pass over the lives
  if (failures.size() > most) return {};
  std::vector<std::vector<IncidenceStep>> steps(modes.modes.size());
  Numbers failed(modes.modes.size());
  double survival = 1;
  for (const double life : failures) {
    double running = 0, all = 0;
    Numbers now(modes.modes.size());
    for (std::size_t i = 0; i < lives.responses.size(); ++i) {
      const Response& y = lives.responses[i];
      if (y.at < life || y.entry >= life) continue;
      running += lives.counts[i];
      const std::uint32_t possible = modes.possible[lives.rows[i]];
      if (y.at > life || possible == 0) continue;
      now[static_cast<std::size_t>(std::countr_zero(possible))] += lives.counts[i];
      all += lives.counts[i];
    }
    for (std::size_t k = 0; k < now.size(); ++k) {
      failed[k] += survival * now[k] / running;
      if (now[k] > 0) steps[k].push_back({life, failed[k]});
    }
    survival *= 1 - all / running;
  }
  return steps;
}

void show_incidence(std::shared_ptr<const FormulaModel> model,
                    std::shared_ptr<const LifeDistribution> part, const std::string& conditions,
                    PosteriorStudy& study) {
  study.figures = [model, part, conditions, before = study.figures](const Fit& fit) {
    auto figures = before ? before(fit) : std::map<std::string, std::vector<html::Figure>>();
    figures["verdict"].push_back(incidence_figure(*model, *part, conditions, fit));
    return figures;
  };
}

}  // namespace wearwell::formula_model
