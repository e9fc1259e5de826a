#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/present/plot.h"
#include "wearwell/study/axis_scale.h"
#include "wearwell/study/figures.h"

namespace wearwell {
namespace {

namespace colour = plot::colour;
using html::capital;
using html::Figure;
using plot::Json;

// The axis starts at zero unless a negative wear was measured.
bool never_negative(const Plots& plots) {
  return std::all_of(plots.measured.begin(), plots.measured.end(), [](double y) { return y >= 0; });
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
  if (plots.limit) {
    marks.push_back(plot::horizontal_line(*plots.limit, {colour::limit, "limit", 1, 1.5, true}));
  }
  marks.push_back(plot::points({{"x", plots.history_at},
                                {"y", plots.measured},
                                {at, plots.history_at},
                                {"measured", plots.measured}},
                               {colour::measured, "measured", 1, 0, false, 60}));
  std::string caption = fmt::format(
      "The line is the mean. With 90 % probability the inner band contains the true mean and the "
      "outer band one measurement. {}",
      plots.history_note);
  return {"history", fmt::format("{} against {}", capital(result.quantity), at), caption,
          plot::plot(fmt::format("{} against {} with its bands and the measured points",
                                 capital(result.quantity), at),
                     {capital(at), false, 0.0, h.at.back()},
                     {fmt::format("{} [{}]", capital(result.quantity), html::unit(plots.unit)),
                      false, never_negative(plots) ? std::optional(0.0) : std::nullopt},
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
                 {colour::posterior, "probability that the limit is reached"})};
  if (summary.now > 0) {
    marks.push_back(
        plot::vertical_line(summary.now, {colour::prior, "last inspection", 1, 1.5, true}));
  }
  const std::pair<double, double> marked[] = {{life.b1, 1}, {life.b10, 10}, {life.b50, 50}};
  for (const auto& [x, p] : marked) {
    if (!std::isfinite(x)) continue;
    marks.push_back(plot::points({{"x", {x}}, {"y", {p}}, {summary.unit, {x}}, {"percent", {p}}},
                                 {colour::limit, "", 1, 0, false, 60}));
    marks.push_back(plot::text(x, p, fmt::format("B{:.0f}", p), colour::limit));
  }
  return {"life",
          fmt::format("Life until {}",
                      html::given(summary.limit) + "\u00a0" + html::unit(summary.limit_unit)),
          "The probability that the limit is reached by the given life. One in ten reaches it "
          "before B10.",
          plot::plot("Probability that the limit is reached, against " + summary.unit,
                     {fmt::format("Life [{}]", html::unit(summary.unit)), false,
                      plots.life->x.front(), plots.life->x.back()},
                     {"Probability [%]", false, 0, 100}, marks, 340)};
}

// The prediction of each stage for the next inspection (Figs. 10 and 11).
Figure next_figure(const PosteriorSummary& result, const Plots& plots) {
  std::vector<std::string> names;
  Numbers ci05, ci95, pi05, pi95, measured;
  AxisWindow window;
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
  return {
      "next", "Predicted before each inspection",
      fmt::format("The prediction from the rows before each inspection, and the measured value. "
                  "Bars are clipped at the edge of the plot; the table has their ends."),
      plot::plot("Predicted and measured " + first.quantity + " at each inspection",
                 {fmt::format("Inspection at … {}", first.at_name), false, {}, {}, names},
                 {fmt::format("{} [{}]", capital(first.quantity), html::unit(first.unit)), false,
                  never_negative(plots) ? std::max(0.0, window.low - margin) : window.low - margin,
                  window.high + margin},
                 marks, 300)};
}

}  // namespace

std::vector<Figure> answer_figures(const PosteriorSummary& result, const Plots& plots) {
  std::vector<Figure> figures = remaining_life_figures(result);
  if (!plots.history.at.empty()) figures.push_back(history_figure(result, plots));
  if (result.life && plots.life) figures.push_back(life_figure(result, plots));
  return figures;
}

std::vector<Figure> prediction_figures(const PosteriorSummary& result, const Plots& plots) {
  std::vector<Figure> figures;
  const bool has_next =
      result.stages.size() > 2 &&
      std::all_of(result.stages.begin(), result.stages.end() - 1,
                  [](const StageSummary& stage) { return stage.predictions.size() > 1; });
  if (has_next) figures.push_back(next_figure(result, plots));
  return figures;
}

}  // namespace wearwell
