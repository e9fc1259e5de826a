#include "wearwell/models/clutch/clutch_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/present/html.h"
#include "wearwell/present/plot.h"

namespace wearwell::clutch {
namespace {

namespace colour = plot::colour;
using html::Figure;
using plot::Json;
using Numbers = std::vector<double>;

constexpr const char* w_title = "wear rate w [mm³/MJ]";

Numbers reported(const Eigen::VectorXd& w) {
  Numbers values;
  for (const double each : w) values.push_back(each / mm3_per_MJ);
  return values;
}

Numbers as_numbers(const std::vector<int>& values) {
  return {values.begin(), values.end()};
}

}  // namespace

/// Fig. 6: wear rates during run-in, each relative to its plate, and the fitted curve.
Figure run_in_figure(const ClutchResult& r) {
  Numbers energy, w;
  for (const WornBlock& b : r.blocks.blocks) {
    if (b.block != Block::run_in) continue;
    double factor = 1;
    for (const PlateFactor& p : r.run_in.plates) {
      if (p.plate == b.plate) factor = p.factor();
    }
    energy.push_back((b.energy_before + 0.5 * b.energy) / MJ);
    w.push_back(b.w / factor / mm3_per_MJ);
  }
  const double most = energy.empty() ? 1 : *std::max_element(energy.begin(), energy.end());
  Numbers x, y;
  for (int i = 0; i <= 300; ++i) {
    x.push_back(most * std::pow(i / 300.0, 2));
    y.push_back(r.run_in.parameters[0] * r.run_in.run_in.g(x.back() * MJ) / mm3_per_MJ);
  }
  return {"run-in", "Run-in",
          "Wear rate of each weighed block against the energy that its plate has absorbed, and the "
          "curve w0 + w1 exp(−Ec/eps1) + w2 exp(−Ec/eps2) fitted to all plates together.",
          plot::plot("Wear rate falls with energy during run-in", {"energy Ec [MJ]"}, {w_title},
                     {plot::points({{"x", energy}, {"y", w}, {"energy", energy}, {"rate", w}},
                                   {colour::measured, "measured", 0.55}),
                      plot::line({{"x", x}, {"y", y}}, {colour::posterior, "fitted"})})};
}

/// Fig. 11: the best R2p at every pair of exponents.
Figure exponent_figure(const ExponentSearch& search) {
  Numbers x, x2, y, y2, r, q, r2p;
  double low = INFINITY, high = -INFINITY;
  for (const PairBest& pair : search.pairs) {
    low = std::min(low, pair.r2p);
    high = std::max(high, pair.r2p);
  }
  const auto& e = search.exponents;
  const double half = e.size() > 1 ? 0.5 * (e[1] - e[0]) : 0.05;
  for (const PairBest& pair : search.pairs) {
    x.push_back(pair.r - half);
    x2.push_back(pair.r + half);
    y.push_back(pair.q - half);
    y2.push_back(pair.q + half);
    r.push_back(pair.r);
    q.push_back(pair.q);
    r2p.push_back(pair.r2p);
  }
  const PairBest& best = search.pairs[search.best];
  return {
      "exponents", "Exponents of the surrogate input",
      fmt::format("R2p of the best submodel at each pair of exponents of ds = ω₀^r t₂^q; darker is "
                  "higher, from {:.3f} to {:.3f}. The point is the best.",
                  low, high),
      plot::plot("R2p over the exponents r and q", {"r"}, {"q"},
                 {plot::heat_map(
                      {{"x", x}, {"x2", x2}, {"y", y}, {"y2", y2}, {"density", r2p}, {"R2p", r2p}},
                      {colour::posterior}, {"R2p", low, std::max(high, low + 1e-6)}),
                  plot::points({{"x", {best.r}}, {"y", {best.q}}, {"r2p", {best.r2p}}},
                               {colour::measured, "best"})})};
}

/// Figs. 13 and 14: measured against predicted.
Figure parity_figure(const ClutchResult& r) {
  const Numbers fitted = reported(r.maps.front().fit.fitted), measured = reported(r.points.w);
  Numbers x, y, point;
  for (const ValidationPoint& p : r.validation.points) {
    x.push_back(p.predicted / mm3_per_MJ);
    y.push_back(p.measured / mm3_per_MJ);
    point.push_back(p.number);
  }
  const double high = *std::max_element(measured.begin(), measured.end());
  std::vector<Json> marks = {
      plot::line({{"x", {0, high}}, {"y", {0, high}}}, {colour::prior, "equal", 1, 1.5, true}),
      plot::points({{"x", fitted},
                    {"y", measured},
                    {"point", as_numbers(r.points.number)},
                    {"measured", measured},
                    {"predicted", fitted}},
                   {colour::posterior, "used for the fit", 0.7})};
  if (!x.empty())
    marks.push_back(
        plot::points({{"x", x}, {"y", y}, {"point", point}, {"measured", y}, {"predicted", x}},
                     {colour::measured, "held out", 0.9}));
  return {"parity", "Measured and predicted wear rates",
          "Each point of the design, compensated for run-in and plate. The fit does not use "
          "held-out points.",
          plot::plot("Measured against predicted wear rates", {"predicted [mm³/MJ]"},
                     {"measured [mm³/MJ]"}, std::move(marks))};
}

/// Fig. 15, as heat maps: wear rate over slip speed and torque at each temperature.
std::vector<Figure> map_figures(const ClutchStudy& study, const ClutchResult& r) {
  const WearPolynomial w = r.model.polynomial();
  OperatingPoint at = r.model.lowest;
  at.closing_time = 0.5 * (r.model.lowest.closing_time + r.model.highest.closing_time);
  std::vector<double> temperatures;
  for (const DesignPoint& p : study.campaign.design) {
    const double t = p.at.temperature;
    if (p.role == Role::model &&
        std::find(temperatures.begin(), temperatures.end(), t) == temperatures.end())
      temperatures.push_back(t);
  }
  std::sort(temperatures.begin(), temperatures.end());
  constexpr int cells = 24;
  struct Grid {
    double temperature;
    Numbers x, x2, y, y2, rate;
  };
  std::vector<Grid> grids;
  double most = 0;
  for (const double temperature : temperatures) {
    Grid grid{temperature, {}, {}, {}, {}, {}};
    at.temperature = temperature;
    for (int i = 0; i < cells; ++i) {
      for (int j = 0; j < cells; ++j) {
        const auto edge = [&](double OperatingPoint::*value, double share) {
          return std::lerp(r.model.lowest.*value, r.model.highest.*value, share / cells);
        };
        at.slip_speed = edge(&OperatingPoint::slip_speed, i + 0.5);
        at.torque = edge(&OperatingPoint::torque, j + 0.5);
        grid.x.push_back(edge(&OperatingPoint::slip_speed, i) / rpm);
        grid.x2.push_back(edge(&OperatingPoint::slip_speed, i + 1) / rpm);
        grid.y.push_back(edge(&OperatingPoint::torque, j));
        grid.y2.push_back(edge(&OperatingPoint::torque, j + 1));
        grid.rate.push_back(w(at) / mm3_per_MJ);
        most = std::max(most, grid.rate.back());
      }
    }
    grids.push_back(std::move(grid));
  }
  std::vector<Figure> figures;
  for (const Grid& grid : grids) {
    const auto [low, high] = std::minmax_element(grid.rate.begin(), grid.rate.end());
    figures.push_back(
        {fmt::format("map-{:.0f}", grid.temperature),
         fmt::format("Wear rate at {:g} °C", grid.temperature),
         fmt::format("At a closing time of {:.3g} s: from {:.3g} to {:.3g} mm³/MJ; the darkest "
                     "shade of all temperatures is {:.3g}.",
                     at.closing_time, *low, *high, most),
         plot::plot(fmt::format("Wear rate at {:g} degrees", grid.temperature),
                    {"slip speed [rpm]"}, {"torque [N m]"},
                    {plot::heat_map({{"x", grid.x},
                                     {"x2", grid.x2},
                                     {"y", grid.y},
                                     {"y2", grid.y2},
                                     {"density", grid.rate},
                                     {"rate", grid.rate}},
                                    {colour::measured},
                                    {"wear rate [mm³/MJ]", 0, std::max(most, 1e-6)})})});
  }
  return figures;
}

/// Figs. 7 and 17: normal probability plot of scaled residuals.
Figure normal_figure(const ClutchResult& r) {
  const Eigen::VectorXd scaled = scaled_residuals(r.points, r.maps.front(), r.scatter_fit().law);
  const NormalPlot points = normal_plot({scaled.begin(), scaled.end()});
  return {"normal", "Normality of scaled residuals",
          "Residuals over their standard deviation in order, against normal quantiles: they follow "
          "the line if the scatter is right.",
          plot::plot("Normal probability plot", {"normal quantile"}, {"scaled residual"},
                     {plot::line({{"x", {-3, 3}}, {"y", {-3, 3}}},
                                 {colour::prior, "N(0, 1)", 1, 1.5, true}),
                      plot::points({{"x", points.quantile}, {"y", points.value}},
                                   {colour::posterior, "points of the design"})})};
}

/// Fig. 16: size of residuals and the fitted scatter.
Figure scatter_figure(const ClutchResult& r) {
  const Eigen::VectorXd& mean = r.maps.front().fit.fitted;
  const Eigen::VectorXd cycles = r.points.effective_cycles();
  Numbers x, size, sigma;
  for (Eigen::Index j = 0; j < mean.size(); ++j) {
    x.push_back(mean[j] / mm3_per_MJ);
    size.push_back(std::abs(r.maps.front().fit.residuals[j]) * std::sqrt(cycles[j]) / mm3_per_MJ);
    sigma.push_back(r.scatter_fit().law.formula(mean[j], r.points.at[static_cast<std::size_t>(j)]) /
                    mm3_per_MJ);
  }
  return {
      "scatter", "Scatter of one cycle",
      fmt::format("Residuals times the root of their cycles, and sigma_w = {}.",
                  formula_of(r.scatter_fit().law.kind)),
      plot::plot("Scatter against wear rate", {w_title}, {"scatter [mm³/MJ]"},
                 {plot::points({{"x", x}, {"y", size}}, {colour::measured, "|residual| √n", 0.6}),
                  plot::points({{"x", x}, {"y", sigma}},
                               {colour::posterior, "sigma_w", 1, 0, false, 30})})};
}

/// Fig. 18: worn volume along a sequence.
Figure sequence_figure(const SequenceResult& s) {
  Numbers x = {0}, mean = {0}, low = {0}, high = {0}, full_low = {0}, full_high = {0}, at, measured;
  for (const auto& w : s.weighings) {
    x.push_back(static_cast<double>(w.cycle));
    mean.push_back(w.predicted / mm3);
    low.push_back(std::max(0.0, w.predicted - 2 * w.sd) / mm3);
    high.push_back((w.predicted + 2 * w.sd) / mm3);
    full_low.push_back(std::max(0.0, w.predicted - 2 * w.full_sd) / mm3);
    full_high.push_back((w.predicted + 2 * w.full_sd) / mm3);
    at.push_back(x.back());
    measured.push_back(w.measured / mm3);
  }
  return {"sequence-" + s.name, fmt::format("Worn volume, {} sequence", s.name),
          fmt::format(
              "Predicted cycle by cycle from the new plate. At the end predicted wear is {}. The "
              "inner band is the scatter of cycles, the outer one the total uncertainty (95 %).",
              error_text(s.final_error())),
          plot::plot("Worn volume against cycles", {"cycles", false, 0.0},
                     {"worn volume [mm³]", false, 0.0},
                     {plot::area({{"x", x}, {"y", full_high}, {"y2", full_low}},
                                 {colour::wide, "95 %, total", 0.28}),
                      plot::area({{"x", x}, {"y", high}, {"y2", low}},
                                 {colour::posterior, "95 %, scatter", 0.38}),
                      plot::line({{"x", x}, {"y", mean}}, {colour::posterior}),
                      plot::points({{"x", at}, {"y", measured}, {"measured", measured}},
                                   {colour::measured, "weighed"})},
                     280, true)};
}

/// Fig. 20: relative width of the interval against the wear level.
Figure width_figure(const ClutchResult& r) {
  std::vector<Json> marks;
  std::size_t c = 0;
  for (const NamedLife& each : r.lives) {
    Numbers levels;
    for (int i = 1; i <= 60; ++i) levels.push_back(i / 50.0);
    const Cycle cycle{1, 1, each.at, closing_energy(each.at)};
    const Life life = predict_life(r.model, {cycle}, levels);
    Numbers x, scatter, full;
    for (const LifeAtLevel& at : life.levels) {
      x.push_back(100 * at.level);
      scatter.push_back(100 * at.relative);
      full.push_back(100 * at.full_relative);
    }
    const char* paint = colour::chains[c++ % std::size(colour::chains)];
    marks.push_back(plot::line({{"x", x}, {"y", scatter}}, {paint, each.name + ", scatter"}));
    marks.push_back(
        plot::line({{"x", x}, {"y", full}}, {paint, each.name + ", total", 0.7, 2, true}));
  }
  return {"width", "Width of the interval",
          "Half width of the 95 % interval of the volume, relative to the volume, when a level of "
          "wear is reached. The scatter of cycles averages out; the uncertainty of the map, the "
          "run-in and the plate does not.",
          plot::plot("Relative interval width against wear level", {"worn [%]"},
                     {"± of the volume [%]"}, std::move(marks))};
}

}  // namespace wearwell::clutch
