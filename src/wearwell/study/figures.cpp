#include "wearwell/study/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/present/plot.h"

namespace wearwell {
namespace {

namespace colour = plot::colour;
using html::capital;
using html::Figure;
using plot::Axis;
using plot::Columns;
using plot::Json;
using plot::Look;

using Numbers = std::vector<double>;

// Axes read best with numbers near 1: a parameter of 7e-4 is plotted in units of 1e-4.
struct Scale {
  double factor = 1;
  std::string unit;

  Numbers operator()(Numbers values) const {
    for (double& value : values) value *= factor;
    return values;
  }
  double operator()(double value) const { return value * factor; }
  std::string title(const std::string& name) const {
    return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
  }
};

Scale scale_for(double typical, const std::string& unit) {
  const std::string shown = html::unit(unit);
  if (typical == 0 || !std::isfinite(typical)) return {1, shown};
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(typical))));
  if (exponent >= -2 && exponent <= 5) return {1, shown};
  // Beyond that the factor itself would leave the range of a double.
  if (std::abs(exponent) > 300) return {1, shown};
  return {std::pow(10.0, -exponent),
          html::raised(fmt::format("10^{}", exponent)) + (shown.empty() ? "" : "\u00a0" + shown)};
}

Scale scale_of(const ParameterSummary& p) {
  return scale_for(p.exact ? p.exact->q50 : p.q50, p.unit);
}

Numbers counted(std::size_t n) {
  Numbers values;
  for (std::size_t i = 1; i <= n; ++i) values.push_back(static_cast<double>(i));
  return values;
}

struct Window {
  double low = INFINITY, high = -INFINITY;
  void take(double a) {
    if (!std::isfinite(a)) return;
    low = std::min(low, a);
    high = std::max(high, a);
  }
  double margin(double share) const { return share * (high - low); }
};

// Ends of bars far beyond the plot, of a stage that knows nothing, are drawn to where nobody sees
// the difference: browsers do not draw to 1e300.
Numbers within(double low, double high, Numbers values) {
  for (double& value : values) {
    if (!std::isnan(value)) value = std::clamp(value, low, high);
  }
  return values;
}

// Wear against cycles (Fig. 12 of An et al. 2011).
Figure history_figure(const PosteriorSummary& result, const Plots& plots) {
  const History& h = plots.history;
  const std::string at = plots.at_name;
  std::vector<Json> marks = {plot::area({{"x", h.at}, {"y", h.pi95}, {"y2", h.pi05}},
                                        {colour::wide, "90 % of measurements", 0.28}),
                             plot::area({{"x", h.at}, {"y", h.ci95}, {"y2", h.ci05}},
                                        {colour::posterior, "90 % of the mean", 0.38}),
                             plot::line({{"x", h.at}, {"y", h.mean}, {at, h.at}, {"mean", h.mean}},
                                        {colour::posterior, "", 1, 2})};
  if (result.life) {
    marks.push_back(
        plot::horizontal_line(result.life->limit, {colour::limit, "limit", 1, 1.5, true}));
  }
  marks.push_back(plot::points({{"x", plots.history_at},
                                {"y", plots.measured},
                                {at, plots.history_at},
                                {"measured", plots.measured}},
                               {colour::measured, "measured", 1, 0, false, 60}));
  std::string caption = fmt::format(
      "The line is the mean; the inner band holds the true mean, the outer band one measurement, "
      "with 90 % probability. {}",
      plots.history_note);
  return {"history", fmt::format("{} against {}", capital(plots.quantity), at), caption,
          plot::plot(fmt::format("{} against {} with its bands and the measured points",
                                 capital(plots.quantity), at),
                     {capital(at), false, 0.0, h.at.back()},
                     {fmt::format("{} [{}]", capital(plots.quantity), html::unit(plots.unit))},
                     marks, 340, true)};
}

Figure life_figure(const PosteriorSummary& result, const Plots& plots) {
  const LifeSummary& summary = *result.life;
  const Life& life = summary.best();
  Numbers percent = plots.life->y;
  for (double& p : percent) p *= 100;
  std::vector<Json> marks = {
      plot::area({{"x", plots.life->x}, {"y", percent}, {"y2", Numbers(percent.size(), 0.0)}},
                 {colour::posterior, "", 0.15}),
      plot::line({{"x", plots.life->x},
                  {"y", percent},
                  {summary.unit, plots.life->x},
                  {"percent", percent}},
                 {colour::posterior, "probability that the limit is reached"}),
      plot::vertical_line(summary.now, {colour::prior, "last inspection", 1, 1.5, true})};
  const std::pair<double, double> marked[] = {{life.b1, 1}, {life.b10, 10}, {life.b50, 50}};
  for (const auto& [x, p] : marked) {
    if (!std::isfinite(x)) continue;
    marks.push_back(plot::points({{"x", {x}}, {"y", {p}}, {summary.unit, {x}}, {"percent", {p}}},
                                 {colour::limit, "", 1, 0, false, 60}));
    marks.push_back(plot::text(x, p, fmt::format("B{:.0f}", p), colour::limit));
  }
  return {
      "life",
      fmt::format("Life until {}",
                  html::given(summary.limit) + "\u00a0" + html::unit(summary.limit_unit)),
      fmt::format("The probability that the limit is reached by then. B10: the {} that one in ten "
                  "does not survive.",
                  summary.unit),
      plot::plot("Probability that the limit is reached, against " + summary.unit,
                 {capital(summary.unit)}, {"Probability [%]", false, 0, 100}, marks, 300)};
}

// What each stage said of the next inspection (Figs. 10 and 11).
Figure next_figure(const PosteriorSummary& result) {
  std::vector<std::string> names;
  Numbers ci05, ci95, pi05, pi95, measured;
  Window window;
  for (std::size_t i = 0; i + 1 < result.stages.size(); ++i) {
    const PredictionSummary& next = result.stages[i].predictions[1];
    const Prediction& p = next.best();
    names.push_back(html::given(next.at));
    ci05.push_back(p.ci05);
    ci95.push_back(p.ci95);
    pi05.push_back(p.pi05);
    pi95.push_back(p.pi95);
    measured.push_back(next.measured.value_or(NAN));
    window.take(measured.back());
    if (2 * (i + 2) > result.stages.size() && result.stages[i].rows > 2) {
      window.take(p.pi05);
      window.take(p.pi95);
    }
  }
  const Numbers x = counted(names.size());
  const double margin = window.margin(0.05), reach = window.margin(1);
  const auto drawn = [&](const Numbers& values) {
    return within(window.low - reach, window.high + reach, values);
  };
  const PredictionSummary& first = result.stages.front().predictions.front();
  std::vector<Json> marks = {plot::ranges({{"x", x},
                                           {"y", drawn(pi05)},
                                           {"y2", drawn(pi95)},
                                           {"lower 5 %", pi05},
                                           {"upper 95 %", pi95}},
                                          {colour::wide, "90 % of measurements", 0.55, 8}),
                             plot::ranges({{"x", x},
                                           {"y", drawn(ci05)},
                                           {"y2", drawn(ci95)},
                                           {"lower 5 %", ci05},
                                           {"upper 95 %", ci95}},
                                          {colour::posterior, "90 % of the mean", 0.9, 8}),
                             plot::points({{"x", x}, {"y", measured}, {"measured", measured}},
                                          {colour::measured, "measured then", 1, 0, false, 70})};
  return {"next", "Predicted before each inspection",
          fmt::format("What the data sets before an inspection say of it, and what was then "
                      "measured. Bars that leave the plot are cut off; the table has their ends."),
          plot::plot("Predicted and measured " + first.quantity + " at each inspection",
                     {fmt::format("Inspection at … {}", first.at_name), false, {}, {}, names},
                     {fmt::format("{} [{}]", capital(first.quantity), html::unit(first.unit)),
                      false, window.low - margin, window.high + margin},
                     marks, 300)};
}

Figure belief_figure(const ParameterSummary& p, const ParameterPlots& plots) {
  const Scale scale = scale_of(p);
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
  return {"belief-" + p.name, fmt::format("{} ({})", capital(plots.meaning), p.name),
          fmt::format("Prior: {}.", html::raised(plots.prior_in_words)),
          plot::plot(fmt::format("Density of {} before and after the data", p.name),
                     {scale.title(p.name)}, {"Density", false, 0.0, {}, {}, false}, marks)};
}

// The densities of two parameters together, drawn and exact (Fig. 7).
std::vector<Figure> joint_figures(const PosteriorSummary& result, const Plots& plots) {
  std::vector<Figure> figures;
  const auto& parameters = result.parameters;
  constexpr Eigen::Index shown = 1200;
  for (std::size_t a = 0; a < parameters.size(); ++a) {
    for (std::size_t b = a + 1; b < parameters.size(); ++b) {
      const Scale xs = scale_of(parameters[a]), ys = scale_of(parameters[b]);
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
        figures.push_back(
            {"exact-joint", names + ", exact",
             "The density by quadrature, on the same axes: where it is dark, draws are to be.",
             plot::plot("Exact joint density of " + names, x, y,
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
  const Scale scale = scale_of(p);
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
  return {"stages", fmt::format("{} after each data set", p.name),
          "Each row is the density after so many data sets, drawn to the same height.",
          plot::plot(fmt::format("Density of {} after each data set", p.name),
                     {scale.title(p.name), false, scale(plots.stages.back().x.front()),
                      scale(plots.stages.back().x.back())},
                     {"Data sets", false, {}, {}, names}, marks, 300)};
}

// Its interval by data set, with the target (Fig. 9).
Figure interval_figure(const PosteriorSummary& result) {
  const ParameterSummary& last = result.parameters.front();
  const Scale scale = scale_of(last);
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
  Window later;
  for (std::size_t i = x.size() / 2; i < x.size(); ++i) {
    later.take(low[i]);
    later.take(high[i]);
  }
  const auto drawn = [&](const Numbers& values) {
    constexpr double decades = 1e6, spans = 20;
    return wide ? within(later.low / decades, later.high * decades, values)
                : within(later.low - later.margin(spans), later.high + later.margin(spans), values);
  };
  return {"interval", fmt::format("Interval of {} by data set", last.name),
          fmt::format("5 % to 95 % and median{}. The line is the mean with all data sets.",
                      wide ? ", on a logarithmic axis" : ""),
          plot::plot(fmt::format("Interval of {} after each data set", last.name),
                     {"Data sets", false, {}, {}, names}, {scale.title(last.name), wide},
                     {plot::horizontal_line(target, {colour::limit, "all data sets", 1, 1.5, true}),
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

// Measured data sets about what the fit predicts of them.
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
          "Measurements minus the fitted mean. Nine in ten should lie within the bars, and on both "
          "sides of zero without a pattern.",
          plot::plot("Measured minus fitted at each data set",
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
  const Scale scale = scale_of(p);
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
          "Good chains look alike and wander over the same range without a trend.",
          plot::plot("Trace of " + p.name + " for each chain", {"Draw"}, {scale.title(p.name)},
                     marks, 240, true)};
}

Figure chain_figure(const PosteriorSummary& result, const Plots& plots, std::size_t i) {
  const ParameterSummary& p = result.parameters[i];
  const ParameterPlots& drawn = plots.parameters[i];
  const Scale scale = scale_of(p);
  std::vector<Json> marks;
  for (std::size_t c = 0; c < std::min(chains_shown, drawn.histogram.density.size()); ++c) {
    Numbers y = drawn.histogram.density[c];
    y.push_back(y.back());
    marks.push_back(plot::steps({{"x", scale(drawn.histogram.edges)}, {"y", y}},
                                {chain_colour(c), fmt::format("chain {}", c + 1), 0.9, 1.2}));
  }
  return {"chains-" + p.name, "Histogram of " + p.name + " by chain",
          "Chains that agree have the same histogram but for noise.",
          plot::plot("Histogram of " + p.name + " for each chain", {scale.title(p.name)},
                     {"Density", false, 0.0, {}, {}, false}, marks, 240)};
}

void append(std::vector<Figure>& all, std::vector<Figure> more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

}  // namespace

std::vector<Figure> prediction_figures(const PosteriorSummary& result, const Plots& plots) {
  std::vector<Figure> figures;
  if (!plots.history.at.empty()) figures.push_back(history_figure(result, plots));
  if (result.life && plots.life) figures.push_back(life_figure(result, plots));
  const bool has_next =
      result.stages.size() > 2 &&
      std::all_of(result.stages.begin(), result.stages.end() - 1,
                  [](const StageSummary& stage) { return stage.predictions.size() > 1; });
  if (has_next) figures.push_back(next_figure(result));
  return figures;
}

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
