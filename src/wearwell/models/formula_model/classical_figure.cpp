#include "wearwell/models/formula_model/classical_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/models/formula_model/group_colour.h"
#include "wearwell/present/plot.h"

namespace wearwell::formula_model {
namespace {

using Numbers = std::vector<double>;

constexpr std::size_t most_groups_drawn = group_colours, most_steps_drawn = 500,
                      points_of_line = 80;

struct Stairs {
  Numbers x, y, low, high, band_x;
};

// Corners of the steps in percent; the band from its first step on.
Stairs stairs_of(const ClassicalGroup& group, const Unit& unit, double deviate) {
  Stairs stairs;
  const std::vector<SurvivalStep>& steps = group.survival.steps;
  const std::size_t every = 1 + steps.size() / most_steps_drawn;
  double before = 100;
  const auto corner = [&](double at, double survival) {
    stairs.x.push_back(at);
    stairs.y.push_back(survival);
  };
  corner(steps.empty() ? 0 : std::min(0.0, from_si(unit, steps.front().at)), before);
  SurvivalBand band{std::nan(""), std::nan("")};
  const auto band_corner = [&](double at) {
    if (std::isnan(band.lower)) return;
    stairs.band_x.push_back(at);
    stairs.low.push_back(100 * band.lower);
    stairs.high.push_back(100 * band.upper);
  };
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (i % every != 0 && i + 1 != steps.size()) continue;
    const double at = from_si(unit, steps[i].at);
    corner(at, before);
    band_corner(at);
    before = 100 * steps[i].survival;
    band = log_log_band(steps[i], deviate);
    corner(at, before);
    band_corner(at);
  }
  const double last = from_si(unit, group.longest);
  if (last > stairs.x.back()) {
    corner(last, before);
    band_corner(last);
  }
  return stairs;
}

// "Kaplan-Meier estimate"; of both, where groups differ in their censoring.
std::string estimators_of(const ClassicalEstimates& found) {
  const auto any = [&](SurvivalMethod method) {
    return std::any_of(found.groups.begin(), found.groups.end(),
                       [&](const auto& group) { return group.survival.method == method; });
  };
  if (!any(SurvivalMethod::turnbull)) return "Kaplan-Meier estimate";
  return any(SurvivalMethod::kaplan_meier) ? "Kaplan-Meier and Turnbull estimates"
                                           : "Turnbull estimate";
}

}  // namespace

html::Figure survival_figure(const AskedOfClassics& asked, const ClassicalEstimates& found,
                             double deviate) {
  const Measured& measured = asked.model->measured.front();
  const Unit& unit = measured.unit;
  std::vector<plot::Json> marks;
  double longest = 0;
  const std::size_t count = std::min(found.groups.size(), most_groups_drawn);
  for (std::size_t g = 0; g < count; ++g)
    longest = std::max(longest, from_si(unit, found.groups[g].longest));
  for (std::size_t g = 0; g < count; ++g) {
    const ClassicalGroup& group = found.groups[g];
    const std::string name = group.words.empty() ? "nonparametric" : group.words;
    const Stairs stairs = stairs_of(group, unit, deviate);
    if (!stairs.band_x.empty())
      marks.push_back(plot::area({{"x", stairs.band_x}, {"y", stairs.high}, {"y2", stairs.low}},
                                 {group_colour(g), "", 0.2}));
    marks.push_back(plot::line({{"x", stairs.x}, {"y", stairs.y}, {"survival [%]", stairs.y}},
                               {group_colour(g), name, 1, 1.5}));
    if (!found.problem.empty() || !group.life) continue;
    LifeAtPoint life = group.life->at_point();
    life.move_to(found.position.data());
    Numbers x, y;
    const double begin = stairs.x.front();
    for (std::size_t i = 0; i < points_of_line; ++i) {
      x.push_back(std::lerp(begin, longest, static_cast<double>(i) / (points_of_line - 1)));
      const double at = to_si(unit, x.back());
      y.push_back(measured.form->positive && !(at > 0) ? 100
                                                       : 100 * std::exp(life.log_survival(at)));
    }
    marks.push_back(
        plot::line({{"x", x}, {"y", y}, {"survival [%]", y}},
                   {group_colour(g), count == 1 ? "maximum likelihood" : "", 1, 2, true}));
  }
  const std::string shown = html::unit(unit.text);
  std::string caption =
      "Steps: the nonparametric estimate with its pointwise bounds. Dashed: maximum likelihood.";
  if (found.groups.size() > count)
    caption += fmt::format(" The first {} of {} conditions are drawn.", count, found.groups.size());
  return {"nonparametric-survival", fmt::format("Survival: {}", estimators_of(found)), caption,
          plot::plot(
              fmt::format("Survival against {}", measured.column),
              {html::capital(measured.column) + (shown.empty() ? "" : fmt::format(" [{}]", shown)),
               false, measured.form->positive ? std::optional(0.0) : std::nullopt, 1.02 * longest},
              {"Survival [%]", false, 0, 100}, marks, 300, true)};
}

}  // namespace wearwell::formula_model
