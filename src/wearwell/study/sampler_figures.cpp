#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/present/plot.h"
#include "wearwell/study/axis_scale.h"
#include "wearwell/study/figures.h"

namespace wearwell {
namespace {

namespace colour = plot::colour;
using html::Figure;
using plot::Json;

// Measured values about the fitted mean.
Figure check_figure(const Plots& plots) {
  const History& r = plots.replicated;
  std::vector<std::string> names;
  Numbers low, high, ci05, ci95, measured;
  for (std::size_t i = 0; i < r.at.size(); ++i) {
    names.push_back(html::given(r.at[i]));
    low.push_back(r.pi05[i] - r.mean[i]);
    high.push_back(r.pi95[i] - r.mean[i]);
    ci05.push_back(r.ci05[i] - r.mean[i]);
    ci95.push_back(r.ci95[i] - r.mean[i]);
    measured.push_back(plots.measured[i] - r.mean[i]);
  }
  const Numbers x = counted(names.size());
  return {"check", "Measured about the fit",
          "Measurements minus the fitted mean. Nine in ten should lie within the bars, scattered "
          "about zero without a pattern.",
          plot::plot("Measured minus fitted at each row",
                     {fmt::format("Inspection at … {}", plots.at_name), false, {}, {}, names},
                     {fmt::format("Difference [{}]", html::unit(plots.unit))},
                     {plot::ranges({{"x", x}, {"y", low}, {"y2", high}},
                                   {colour::wide, "90 % of measurements", 0.55, 8}),
                      plot::ranges({{"x", x}, {"y", ci05}, {"y2", ci95}},
                                   {colour::posterior, "90 % of the mean", 0.9, 8}),
                      plot::horizontal_line(0, {colour::prior, "", 1, 1}),
                      plot::points({{"x", x}, {"y", measured}, {"difference", measured}},
                                   {colour::measured, "measured", 1, 0, false, 70})},
                     300)};
}

const char* chain_colour(std::size_t c) {
  return colour::chains[c % std::size(colour::chains)];
}

constexpr std::size_t chains_shown = 8;

Figure trace_figure(const PosteriorSummary& result, std::size_t i) {
  constexpr Eigen::Index shown = 400;
  const ParameterSummary& p = result.parameters[i];
  const AxisScale scale = scale_of(p);
  std::vector<Json> marks;
  for (std::size_t c = 0; c < std::min(chains_shown, result.posterior_draws.size()); ++c) {
    const auto& values = result.posterior_draws[c].values;
    const Eigen::Index thin = std::max<Eigen::Index>(1, values.rows() / shown);
    Numbers x, y;
    for (Eigen::Index row = 0; row < values.rows(); row += thin) {
      x.push_back(static_cast<double>(row + 1));
      y.push_back(values(row, static_cast<Eigen::Index>(i)));
    }
    marks.push_back(plot::line({{"x", x}, {"y", scale(y)}},
                               {chain_colour(c), fmt::format("chain {}", c + 1), 0.65, 0.8}));
  }
  return {"trace-" + p.name, "Trace of " + p.name,
          "Converged chains look alike: they cover the same range without a trend.",
          plot::plot("Trace of " + p.name + " for each chain", {"Draw"}, {scale.title(p.name)},
                     marks, 240, true)};
}

Figure chain_figure(const PosteriorSummary& result, const Plots& plots, std::size_t i) {
  const ParameterSummary& p = result.parameters[i];
  const ParameterPlots& drawn = plots.parameters[i];
  const AxisScale scale = scale_of(p);
  std::vector<Json> marks;
  for (std::size_t c = 0; c < std::min(chains_shown, drawn.histogram.density.size()); ++c) {
    Numbers y = drawn.histogram.density[c];
    y.push_back(y.back());
    marks.push_back(plot::steps({{"x", scale(drawn.histogram.edges)}, {"y", y}},
                                {chain_colour(c), fmt::format("chain {}", c + 1), 0.9, 1.2}));
  }
  return {"chains-" + p.name, "Histogram of " + p.name + " by chain",
          "Converged chains have the same histogram up to noise.",
          plot::plot("Histogram of " + p.name + " for each chain", {scale.title(p.name)},
                     {"Density", false, 0.0, {}, {}, false}, marks, 240)};
}

}  // namespace

std::vector<Figure> fit_figures(const Plots& plots) {
  if (plots.replicated.at.empty()) return {};
  return {check_figure(plots)};
}

std::vector<Figure> sampler_figures(const PosteriorSummary& result, const Plots& plots) {
  std::vector<Figure> figures;
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    figures.push_back(trace_figure(result, i));
    figures.push_back(chain_figure(result, plots, i));
  }
  return figures;
}

}  // namespace wearwell
