#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/math/quantile.h"
#include "wearwell/models/recurrence/mean_cumulative.h"
#include "wearwell/models/recurrence/recurrence_report.h"
#include "wearwell/present/plot.h"
#include "wearwell/study/plot_study.h"

namespace wearwell::recurrence {
namespace {

constexpr Eigen::Index draws_of_figure = 400;

// The fitted number of failures per unit from the first observed age on, in the unit of the data.
struct FittedBand {
  std::vector<double> age = {}, low = {}, middle = {}, high = {};
};
FittedBand fitted_band(const Asked& asked, const WeightedDraws& all) {
  constexpr int points = 60;
  const WeightedDraws draws = thinned(all, draws_of_figure);
  // Both count failures from the first age at which a unit is observed.
  const double first = asked.data.first_start();
  std::vector<double> ages = {first};
  for (int i = 1; i <= points; ++i)
    ages.push_back(std::lerp(first, asked.data.longest(), static_cast<double>(i) / points));
  std::vector<std::vector<double>> means;  // of each draw
  for (Eigen::Index i = 0; i < draws.values.rows(); ++i)
    means.push_back(expected_failures(asked.process, draws.values.row(i).data(), ages));
  FittedBand band;
  for (std::size_t k = 0; k < ages.size(); ++k) {
    std::vector<double> at;
    for (const auto& each : means) at.push_back(each[k] - each[0]);
    std::sort(at.begin(), at.end());
    band.age.push_back(from_si(asked.data.unit, ages[k]));
    band.low.push_back(quantile(at, asked.outside()));
    band.middle.push_back(quantile(at, 0.5));
    band.high.push_back(quantile(at, 1 - asked.outside()));
  }
  return band;
}

html::Figure mcf_figure(const Asked& asked, const WeightedDraws& draws) {
  namespace colour = plot::colour;
  const Unit& unit = asked.data.unit;
  const FittedBand fitted = fitted_band(asked, draws);
  // Each step twice, so that lines and areas are steps.
  std::vector<double> at, mean, below, above;
  double last_mean = 0, last_low = 0, last_high = 0;
  const auto add = [&](double age, double m, double l, double h) {
    at.push_back(age);
    mean.push_back(m);
    below.push_back(l);
    above.push_back(h);
  };
  add(fitted.age.front(), 0, 0, 0);
  for (const MeanCumulativeStep& step :
       mean_cumulative(asked.data.units, 1 - 2 * asked.outside())) {
    const double age = from_si(unit, step.age);
    add(age, last_mean, last_low, last_high);
    add(age, last_mean = step.mean, last_low = step.low, last_high = step.high);
  }
  add(from_si(unit, asked.data.longest()), last_mean, last_low, last_high);
  const std::string shown = html::unit(unit.text), gaps = unobserved_text(asked);
  return {
      "mean-cumulative-function",
      fitted.age.front() > 0 ? fmt::format("Failures per unit from age {} {} until each age",
                                           age_number(fitted.age.front()), shown)
                             : "Failures per unit until each age",
      fmt::format("Steps are the mean cumulative function of the data (Nelson), with {0} bounds "
                  "that assume no model (none where one unit alone is at risk). The line is "
                  "the fitted process, posterior median with its {0} band.",
                  asked.interval_name()) +
          (gaps.empty() ? ""
                        : fmt::format(" No unit was observed {}: the steps lack the failures "
                                      "there, the line has them.",
                                      gaps)),
      plot::plot(
          "Mean cumulative number of failures per unit against age, from the data and fitted",
          {"Age [" + shown + "]", false, fitted.age.front(), fitted.age.back()},
          {"Failures per unit", false, 0, {}},
          {plot::area({{"x", at}, {"y", above}, {"y2", below}},
                      {colour::measured, asked.interval_name() + ", data", 0.15}),
           plot::area({{"x", fitted.age}, {"y", fitted.high}, {"y2", fitted.low}},
                      {colour::posterior, asked.interval_name() + ", fitted", 0.28}),
           plot::line({{"x", at}, {"y", mean}, {"failures per unit", mean}},
                      {colour::measured, "data", 1, 2}),
           plot::line(
               {{"x", fitted.age}, {"y", fitted.middle}, {"failures per unit", fitted.middle}},
               {colour::posterior, "fitted", 1, 2})},
          320, true),
      {},
      true};
}

}  // namespace

std::map<std::string, std::vector<html::Figure>> recurrence_figures(const Asked& asked,
                                                                    const WeightedDraws& draws) {
  return {{"verdict", {mcf_figure(asked, draws)}}};
}

}  // namespace wearwell::recurrence
