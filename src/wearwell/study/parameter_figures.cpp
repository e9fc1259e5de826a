#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/present/plot.h"
#include "wearwell/study/answers.h"
#include "wearwell/study/axis_scale.h"
#include "wearwell/study/figures.h"

namespace wearwell {
namespace {

namespace colour = plot::colour;
using html::capital;
using html::Figure;
using plot::Axis;
using plot::Json;

Figure belief_figure(const ParameterSummary& p, const ParameterPlots& plots) {
  const AxisScale scale = scale_of(p);
  const Histogram& h = plots.histogram;
  Numbers pooled(h.edges.size() - 1, 0.0);
  for (const Numbers& chain : h.density) {
    for (std::size_t i = 0; i < pooled.size(); ++i) {
      pooled[i] += chain[i] / static_cast<double>(h.density.size());
    }
  }
  std::vector<Json> marks;
  Numbers left(h.edges.begin(), h.edges.end() - 1);
  const Numbers right(h.edges.begin() + 1, h.edges.end());
  Json columns = plot::cells({{"x", scale(left)},
                              {"x2", scale(right)},
                              {"y", pooled},
                              {"y2", Numbers(pooled.size(), 0.0)}},
                             {colour::wide, "draws"});
  columns["encoding"].erase("opacity");
  columns["mark"]["opacity"] = 0.4;
  marks.push_back(columns);
  marks.push_back(plot::line({{"x", scale(plots.prior.x)}, {"y", plots.prior.y}},
                             {colour::prior, "before the data (prior)", 1, 2, true}));
  if (plots.exact) {
    marks.push_back(plot::line({{"x", scale(plots.exact->x)}, {"y", plots.exact->y}},
                               {colour::posterior, "after the data (exact)"}));
  }
  return {"belief-" + p.name, titled(p),
          fmt::format("Prior: {}.", html::raised(powers_text(p.prior, Script::page)) +
                                        (p.prior_is_default ? " (default)" : "")),
          plot::plot(fmt::format("Density of {} before and after the data", p.name),
                     {scale.title(p.name)}, {"Density", false, 0.0, {}, {}, false}, marks)};
}

// The joint density of two parameters, from draws and exact (Fig. 7).
std::vector<Figure> joint_figures(const PosteriorSummary& result, const Plots& plots) {
  std::vector<Figure> figures;
  const auto& parameters = result.parameters;
  constexpr Eigen::Index shown = 1200;
  for (std::size_t a = 0; a < parameters.size(); ++a) {
    for (std::size_t b = a + 1; b < parameters.size(); ++b) {
      const AxisScale xs = scale_of(parameters[a]), ys = scale_of(parameters[b]);
      Axis x{xs.title(parameters[a].name)}, y{ys.title(parameters[b].name)};
      if (plots.joint && a == 0 && b == 1) {
        const DensityGrid& grid = *plots.joint;
        x.low = xs(1.5 * grid.x.front() - 0.5 * grid.x[1]);
        x.high = xs(1.5 * grid.x.back() - 0.5 * grid.x[grid.x.size() - 2]);
        y.low = ys(1.5 * grid.y.front() - 0.5 * grid.y[1]);
        y.high = ys(1.5 * grid.y.back() - 0.5 * grid.y[grid.y.size() - 2]);
      }
      Numbers px, py, dx, dy;
      for (const Chain& chain : result.posterior_draws) {
        const Eigen::Index total =
            chain.values.rows() * static_cast<Eigen::Index>(result.posterior_draws.size());
        const Eigen::Index thin = std::max<Eigen::Index>(1, total / shown);
        for (Eigen::Index i = 0; i < chain.values.rows(); ++i) {
          const bool divergent =
              !chain.nuts.empty() && chain.nuts[static_cast<std::size_t>(i)].divergent;
          if (i % thin != 0 && !divergent) continue;
          (divergent ? dx : px).push_back(chain.values(i, static_cast<Eigen::Index>(a)));
          (divergent ? dy : py).push_back(chain.values(i, static_cast<Eigen::Index>(b)));
        }
      }
      std::vector<Json> marks = {
          plot::points({{"x", xs(px)}, {"y", ys(py)}}, {colour::posterior, "", 0.45, 0, false, 9})};
      std::string caption = fmt::format("{} of the draws.", px.size());
      if (!dx.empty()) {
        marks.push_back(plot::points({{"x", xs(dx)}, {"y", ys(dy)}},
                                     {colour::measured, "divergent", 1, 0, false, 30}));
      }
      const std::string names = parameters[a].name + " and " + parameters[b].name;
      figures.push_back({fmt::format("draws-{}-{}", parameters[a].name, parameters[b].name),
                         names + ", drawn", caption,
                         plot::plot("Draws of " + names, x, y, marks, 300, true)});
      if (plots.joint && a == 0 && b == 1) {
        const DensityGrid& grid = *plots.joint;
        Numbers x1, x2, y1, y2, density;
        const double w = 0.5 * (grid.x[1] - grid.x[0]), h = 0.5 * (grid.y[1] - grid.y[0]);
        for (std::size_t i = 0; i < grid.x.size(); ++i) {
          for (std::size_t j = 0; j < grid.y.size(); ++j) {
            const double each = grid.density[i * grid.y.size() + j];
            if (each < 0.002) continue;
            x1.push_back(grid.x[i] - w);
            x2.push_back(grid.x[i] + w);
            y1.push_back(grid.y[j] - h);
            y2.push_back(grid.y[j] + h);
            density.push_back(each);
          }
        }
        figures.push_back({"exact-joint", names + ", by quadrature",
                           "The density by quadrature, on the same axes. Darker areas have more "
                           "posterior probability.",
                           plot::plot("Joint density by quadrature of " + names, x, y,
                                      {plot::cells({{"x", xs(x1)},
                                                    {"x2", xs(x2)},
                                                    {"y", ys(y1)},
                                                    {"y2", ys(y2)},
                                                    {"density", density}},
                                                   {colour::posterior})},
                                      300)});
      }
    }
  }
  return figures;
}

// The density of the first parameter after each stage (Fig. 8), one above the other.
Figure stages_figure(const PosteriorSummary& result, const Plots& plots) {
  const ParameterSummary& p = result.parameters.front();
  const AxisScale scale = scale_of(p);
  std::vector<Json> marks;
  std::vector<std::string> names;
  const std::size_t n = plots.stages.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Curve& curve = plots.stages[i];
    const double base = static_cast<double>(n - i) - 0.45;
    const double peak = *std::max_element(curve.y.begin(), curve.y.end());
    Numbers top;
    for (const double y : curve.y) top.push_back(base + (peak > 0 ? 0.9 * y / peak : 0));
    const Numbers bottom(top.size(), base);
    marks.push_back(plot::area({{"x", scale(curve.x)}, {"y", top}, {"y2", bottom}},
                               {colour::posterior, "", 0.3}));
    marks.push_back(
        plot::line({{"x", scale(curve.x)}, {"y", top}}, {colour::posterior, "", 1, 1.5}));
    names.push_back(fmt::format("{}", n - i));
  }
  return {"stages", fmt::format("{} after each row", p.name),
          "Each line is the density after the given number of rows, scaled to the same height.",
          plot::plot(fmt::format("Density of {} after each row", p.name),
                     {scale.title(p.name), false, scale(plots.stages.back().x.front()),
                      scale(plots.stages.back().x.back())},
                     {"Rows", false, {}, {}, names}, marks, 300)};
}

// Its interval by data set, with the target (Fig. 9).
Figure interval_figure(const PosteriorSummary& result) {
  const ParameterSummary& last = result.parameters.front();
  const AxisScale scale = scale_of(last);
  Numbers low, mid, high;
  std::vector<std::string> names;
  bool positive = true;
  for (const StageSummary& stage : result.stages) {
    const ParameterSummary& p = stage.parameters.front();
    low.push_back(scale(p.exact ? p.exact->q05 : p.q05));
    mid.push_back(scale(p.exact ? p.exact->q50 : p.q50));
    high.push_back(scale(p.exact ? p.exact->q95 : p.q95));
    positive = positive && low.back() > 0;
    names.push_back(fmt::format("{}", stage.rows));
  }
  const Numbers x = counted(names.size());
  const bool wide = positive && *std::max_element(high.begin(), high.end()) >
                                    20 * *std::min_element(low.begin(), low.end());
  const double target = scale(last.exact ? last.exact->mean : last.mean);
  AxisWindow later;
  for (std::size_t i = x.size() / 2; i < x.size(); ++i) {
    later.take(low[i]);
    later.take(high[i]);
  }
  const auto drawn = [&](const Numbers& values) {
    constexpr double decades = 1e6, spans = 20;
    return wide ? within(later.low / decades, later.high * decades, values)
                : within(later.low - later.margin(spans), later.high + later.margin(spans), values);
  };
  return {"interval", fmt::format("Interval of {} by row", last.name),
          fmt::format("5 % to 95 % and median{}. The line is the mean with all rows.",
                      wide ? ", on a logarithmic axis" : ""),
          plot::plot(fmt::format("Interval of {} after each row", last.name),
                     {"Rows", false, {}, {}, names}, {scale.title(last.name), wide},
                     {plot::horizontal_line(target, {colour::limit, "all rows", 1, 1.5, true}),
                      plot::ranges({{"x", x},
                                    {"y", drawn(low)},
                                    {"y2", drawn(high)},
                                    {"lower 5 %", low},
                                    {"upper 95 %", high}},
                                   {colour::posterior, "90 % interval", 0.85, 8}),
                      plot::points({{"x", x}, {"y", drawn(mid)}, {"median", mid}},
                                   {colour::measured, "median", 1, 0, false, 60})},
                     300)};
}

void append(std::vector<Figure>& all, std::vector<Figure> more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

}  // namespace

std::vector<Figure> parameter_figures(const PosteriorSummary& result, const Plots& plots) {
  std::vector<Figure> figures;
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    figures.push_back(belief_figure(result.parameters[i], plots.parameters[i]));
  }
  append(figures, joint_figures(result, plots));
  if (!plots.stages.empty()) {
    figures.push_back(stages_figure(result, plots));
    figures.push_back(interval_figure(result));
  }
  return figures;
}

}  // namespace wearwell
