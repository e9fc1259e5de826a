#include <fmt/format.h>

#include <algorithm>

#include "wearwell/models/formula_model/group_colour.h"
#include "wearwell/models/formula_model/returns_report.h"
#include "wearwell/present/plot.h"

namespace wearwell::formula_model {
namespace {

namespace colour = plot::colour;

// Not more names than an axis has room for.
plot::Axis period_axis(const AskedReturns& asked, int first, int last) {
  constexpr int most_ticks = 12;
  const PeriodNames& names = asked.returns->triangle.names;
  int step = 1;
  for (const int each : {1, 2, 3, 6, 12, 24, 60, 120}) {
    step = each;
    if ((last - first) / each <= most_ticks) break;
  }
  plot::Axis axis{html::capital(asked.period(1)) + " of return", false, first - 0.5, last + 0.5};
  for (int each = first; each <= last; ++each)
    if (each % step == 0 || first == last) axis.ticks.emplace_back(each, names.text(each));
  return axis;
}

constexpr double half_bar = 0.35;  // of a period

struct Band {
  std::vector<double> x, low, expected, high;
  void add(double at, const ReturnsCount& count) {
    x.push_back(at);
    low.push_back(count.count_low);
    expected.push_back(count.expected);
    high.push_back(count.count_high);
  }
  // One period alone is as wide as its bar: a line of one point is not seen.
  void widen() {
    if (x.size() != 1) return;
    for (auto* each : {&low, &expected, &high}) each->push_back(each->front());
    x = {x[0] - half_bar, x[0] + half_bar};
  }
};

void draw_band(Band band, const char* paint, const std::string& label,
               std::vector<plot::Json>& marks) {
  if (band.x.empty()) return;
  band.widen();
  marks.push_back(plot::area({{"x", band.x}, {"y", band.high}, {"y2", band.low}},
                             {paint, "90 % of the number, " + label, 0.25}));
  marks.push_back(plot::line({{"x", band.x}, {"y", band.expected}, {"expected", band.expected}},
                             {paint, label, 1, 2}));
}

plot::Json bars(const std::vector<const ReturnsPeriod*>& periods, const char* paint,
                const std::string& label) {
  plot::Columns data = {{"x", {}},  {"x2", {}},      {"y", {}},
                        {"y2", {}}, {"density", {}}, {"returned", {}}};
  constexpr double opacity = 0.55;
  for (const ReturnsPeriod* each : periods) {
    const double values[] = {each->at - half_bar,
                             each->at + half_bar,
                             static_cast<double>(*each->observed),
                             0,
                             opacity,
                             static_cast<double>(*each->observed)};
    for (std::size_t c = 0; c < data.size(); ++c) data[c].second.push_back(values[c]);
  }
  return plot::cells(data, {paint, label});
}

std::vector<const ReturnsPeriod*> observed_of(const std::vector<ReturnsPeriod>& periods) {
  std::vector<const ReturnsPeriod*> found;
  for (const ReturnsPeriod& each : periods)
    if (each.observed) found.push_back(&each);
  return found;
}

std::string caption(const AskedReturns& asked) {
  return fmt::format(
      "Bars are returns. The first line is what the fit expects of each {}, given what came back "
      "before; the second the forecast. Bands hold the whole number of returns with 90 %.",
      asked.period(1));
}

html::Figure returns_figure(const AskedReturns& asked, const ReturnsResult& result, int last) {
  std::vector<plot::Json> marks;
  marks.push_back(bars(observed_of(result.fitted), colour::measured, "returned"));
  const auto held = observed_of(result.forecast);
  if (!held.empty()) marks.push_back(bars(held, colour::limit, "returned, held out"));
  Band fitted, ahead;
  for (const ReturnsPeriod& each : result.fitted) fitted.add(each.at, each.number);
  for (const ReturnsPeriod& each : result.forecast) ahead.add(each.at, each.number);
  draw_band(fitted, colour::prior, "fitted", marks);
  draw_band(ahead, colour::posterior, "forecast", marks);
  return {"returns",
          fmt::format("Returns by {}", asked.period(1)),
          caption(asked),
          plot::plot(fmt::format("Returns by {}, observed and forecast", asked.period(1)),
                     period_axis(asked, result.fitted.front().at, last), {"Returns", false, 0, {}},
                     marks, 320, true),
          {},
          true};
}

html::Figure sum_figure(const AskedReturns& asked, const ReturnsResult& result, int last) {
  std::vector<double> x, observed, expected, later_x, later;
  double sum = 0, mean = 0;
  for (const ReturnsPeriod& each : result.fitted) {
    x.push_back(each.at);
    observed.push_back(sum += *each.observed);
    expected.push_back(mean += each.number.expected);
  }
  Band ahead;
  ReturnsCount now;
  now.expected = now.count_low = now.count_high = sum;
  if (!result.forecast.empty()) ahead.add(asked.returns->last(), now);
  double held = sum;
  for (const ReturnsPeriod& each : result.forecast) {
    ReturnsCount until = each.until;
    until.expected += sum;
    until.count_low += sum;
    until.count_high += sum;
    ahead.add(each.at, until);
    if (!each.observed) continue;
    later_x.push_back(each.at);
    later.push_back(held += *each.observed);
  }
  std::vector<plot::Json> marks;
  draw_band(ahead, colour::posterior, "forecast", marks);
  marks.push_back(plot::line({{"x", x}, {"y", expected}, {"expected", expected}},
                             {colour::prior, "fitted", 1, 2, true}));
  marks.push_back(plot::points({{"x", x}, {"y", observed}, {"returned", observed}},
                               {colour::measured, "returned"}));
  if (!later.empty())
    marks.push_back(plot::points({{"x", later_x}, {"y", later}, {"returned", later}},
                                 {colour::limit, "returned, held out"}));
  return {"returns-until",
          "Returns until each " + asked.period(1),
          fmt::format("Points are the returns so far; the dashed line adds up what the fit expects "
                      "of each {}. The band holds the whole number with 90 %.",
                      asked.period(1)),
          plot::plot(fmt::format("Sum of returns until each {}", asked.period(1)),
                     period_axis(asked, result.fitted.front().at, last), {"Returns", false, 0, {}},
                     marks, 320, true),
          {},
          true};
}

// By failure mode: what came back, what the fit expects and the forecast.
html::Figure modes_figure(const AskedReturns& asked, const ReturnsResult& result, int last) {
  std::vector<plot::Json> marks;
  for (std::size_t k = 0; k < asked.modes.size(); ++k) {
    const char* const paint = group_colour(k + 1);
    Band ahead;
    std::vector<double> x, observed, fitted_x, fitted;
    for (const ReturnsPeriod& each : result.fitted) {
      x.push_back(each.at);
      observed.push_back(each.by_mode[k].observed);
      fitted_x.push_back(each.at);
      fitted.push_back(each.by_mode[k].number.expected);
    }
    for (const ReturnsPeriod& each : result.forecast) {
      ahead.add(each.at, each.by_mode[k].number);
      if (!each.observed) continue;
      x.push_back(each.at);
      observed.push_back(each.by_mode[k].observed);
    }
    ahead.widen();
    if (!ahead.x.empty())
      marks.push_back(
          plot::area({{"x", ahead.x}, {"y", ahead.high}, {"y2", ahead.low}}, {paint, "", 0.2}));
    marks.push_back(plot::line({{"x", fitted_x}, {"y", fitted}, {"expected", fitted}},
                               {paint, "", 1, 2, true}));
    if (!ahead.x.empty())
      marks.push_back(
          plot::line({{"x", ahead.x}, {"y", ahead.expected}, {"expected", ahead.expected}},
                     {paint, "", 1, 2}));
    marks.push_back(
        plot::points({{"x", x}, {"y", observed}, {"returned", observed}}, {paint, asked.modes[k]}));
  }
  return {"returns-by-mode",
          fmt::format("Returns by {} and failure mode", asked.period(1)),
          "Points are returns whose failure mode is known. Dashed lines are what the fit expects, "
          "given what came back before; full lines the forecast. Bands hold the whole number of "
          "returns by the mode with 90 %.",
          plot::plot(fmt::format("Returns by {} and failure mode", asked.period(1)),
                     period_axis(asked, result.fitted.front().at, last), {"Returns", false, 0, {}},
                     marks, 320, true),
          {},
          true};
}

}  // namespace

std::vector<html::Figure> returns_figures(const AskedReturns& asked, const WeightedDraws& draws) {
  const ReturnsResult result = returns_result(asked, draws, {.modes = true});
  if (result.fitted.empty()) return {};
  const int last = result.forecast.empty() ? result.fitted.back().at : result.forecast.back().at;
  std::vector<html::Figure> figures = {returns_figure(asked, result, last),
                                       sum_figure(asked, result, last)};
  if (asked.modes.size() > 1)
    figures.insert(figures.begin() + 1, modes_figure(asked, result, last));
  return figures;
}

}  // namespace wearwell::formula_model
