#include "wearwell/models/formula_model/formula_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "wearwell/models/formula_model/formula_limit.h"
#include "wearwell/models/formula_model/formula_path_ahead.h"
#include "wearwell/models/formula_model/formula_process_spread.h"
#include "wearwell/models/formula_model/formula_spread.h"
#include "wearwell/present/plot.h"
#include "wearwell/prognosis/plural.h"

namespace wearwell::formula_model {
namespace {

namespace colour = plot::colour;
using Numbers = std::vector<double>;

constexpr std::size_t most_figures = 24, steps_ahead = 24, most_points = 200;

// The readings of a unit, or of all, in the units of the figure.
struct Readings {
  Numbers place, value;
};

struct Drawing {
  std::shared_ptr<const FormulaRows> rows;
  std::string along, noun, quantity;
  Unit axis, unit;
  std::vector<SpreadPath> paths;  // the first that of a new unit
  std::vector<std::string> of;
  std::vector<Readings> readings;
  std::vector<Numbers> traced;  // positions of rows, SI
  std::optional<double> limit;  // SI
  std::size_t left_out = 0;
  std::optional<ProcessLimit> process;  // with the mean of a process

  std::vector<html::Figure> draw(const WeightedDraws& draws) const;
};

// 90 % band and median of a path, in the units of the figure.
struct Band {
  Numbers x, low, middle, high;
};

// Axes of the small multiples.
struct Window {
  double x_low = INFINITY, x_high = -INFINITY, y_low = INFINITY, y_high = -INFINITY;

  void take(const Numbers& x, const Numbers& y) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      x_low = std::min(x_low, x[i]);
      x_high = std::max(x_high, x[i]);
      take_height(y[i]);
    }
  }
  void take_height(double y) {
    y_low = std::min(y_low, y);
    y_high = std::max(y_high, y);
  }
  double margin() const { return 0.08 * (y_high - y_low); }
};

Readings readings_of(const Asked& asked, const Measured& measured,
                     std::optional<std::size_t> unit) {
  Readings result;
  for (std::size_t i = 0; i < measured.observed.rows.size(); ++i) {
    const std::size_t row = measured.observed.rows[i];
    if (unit && asked.model->unit_of_row[row] != *unit) continue;
    if (measured.observed.responses[i].seen != Censoring::none) continue;
    result.place.push_back(from_si(asked.axis().unit.unit, asked.axis().values[row]));
    result.value.push_back(from_si(measured.unit, measured.observed.responses[i].at));
  }
  return result;
}

Band band_of(const Drawing& drawing, std::size_t i, const Spread& spread) {
  Band band;
  const auto add = [&](double place, const CellMixture& known) {
    const double ends[] = {known.quantile(0.05), known.quantile(0.5), known.quantile(0.95)};
    if (!std::all_of(ends, ends + 3, [](double each) { return std::isfinite(each); })) return;
    band.x.push_back(from_si(drawing.axis, place));
    band.low.push_back(from_si(drawing.unit, ends[0]));
    band.middle.push_back(from_si(drawing.unit, ends[1]));
    band.high.push_back(from_si(drawing.unit, ends[2]));
  };
  for (std::size_t k = 0; k < spread.traced.size(); ++k)
    add(drawing.traced[i][k], spread.traced[k]);
  for (std::size_t k = 0; k < spread.ahead.size(); ++k)
    add(drawing.paths[i].places[k], spread.ahead[k]);
  return band;
}

// With names of the marks for a legend, or without.
std::vector<plot::Json> marks_of(const Drawing& drawing, std::size_t i, const Band& band,
                                 bool named) {
  const auto name = [&](const char* words) { return named ? words : ""; };
  const std::string &along = drawing.along, &quantity = drawing.quantity;
  const Readings& seen = drawing.readings[i];
  std::vector<plot::Json> marks = {
      plot::area({{"x", band.x}, {"y", band.high}, {"y2", band.low}},
                 {colour::wide, name("90 % of the path"), 0.35}),
      plot::line({{"x", band.x}, {"y", band.middle}, {along, band.x}, {quantity, band.middle}},
                 {colour::posterior, name("median path")}),
      plot::points(
          {{"x", seen.place}, {"y", seen.value}, {along, seen.place}, {quantity, seen.value}},
          {colour::measured, name("readings"), 1, 0, false, named ? 35. : 20.})};
  if (drawing.limit) {
    marks.push_back(plot::horizontal_line(from_si(drawing.unit, *drawing.limit),
                                          {colour::limit, name("limit"), 1, 1.5, true}));
  }
  return marks;
}

html::Figure figure_of(const Drawing& drawing, std::size_t i, const Band& band) {
  const bool of_new = !drawing.paths[i].unit;
  const std::string caption =
      of_new ? fmt::format(
                   "90 % band of the path of a new {}, under the given conditions, with the "
                   "readings of all.",
                   drawing.noun)
             : "The path given its rows, and its forecast under the given conditions: 90 % band of "
               "the path, without measurement scatter.";
  return {
      fmt::format("path-{}-{}", drawing.quantity, i), html::capital(drawing.of[i]), caption,
      plot::plot(
          fmt::format("{} of {} along {}", drawing.quantity, drawing.of[i], drawing.along),
          {fmt::format("{} [{}]", html::capital(drawing.along), html::unit(drawing.axis.text))},
          {fmt::format("{} [{}]", html::capital(drawing.quantity), html::unit(drawing.unit.text))},
          marks_of(drawing, i, band, true), 280)};
}

// The paths of units as small multiples on common axes.
std::vector<html::Figure> panels_of(const Drawing& drawing, const std::vector<Band>& bands) {
  Window window;
  if (drawing.limit) window.take_height(from_si(drawing.unit, *drawing.limit));
  for (std::size_t i = 1; i < bands.size(); ++i) {
    window.take(bands[i].x, bands[i].middle);
    window.take(drawing.readings[i].place, drawing.readings[i].value);
  }
  const std::string quantity = html::capital(drawing.quantity);
  std::string caption = fmt::format(
      "{} [{}] against {} [{}], all on the same axes: readings, the median path and its 90 % band "
      "under the given conditions, without measurement scatter{}.",
      quantity, html::unit(drawing.unit.text), drawing.along, html::unit(drawing.axis.text),
      drawing.limit ? "; dashed: the failure threshold" : "");
  if (drawing.left_out > 0) {
    caption += fmt::format(" Of {} {}, those {} are drawn.", drawing.left_out + bands.size() - 1,
                           prognosis::plural(drawing.noun),
                           drawing.limit ? "nearest to the threshold" : "that come first");
  }
  std::vector<html::Figure> figures;
  for (std::size_t i = 1; i < bands.size(); ++i) {
    html::Figure figure{
        fmt::format("path-{}-{}", drawing.quantity, i), html::capital(drawing.of[i]), caption,
        plot::plot(fmt::format("{} of {} along {}", drawing.quantity, drawing.of[i], drawing.along),
                   {"", false, window.x_low, window.x_high},
                   {"", false, window.y_low - window.margin(), window.y_high + window.margin()},
                   marks_of(drawing, i, bands[i], false), 130)};
    figure.panel_of = fmt::format("{} of each {}", quantity, drawing.noun);
    figures.push_back(std::move(figure));
  }
  return figures;
}

std::vector<html::Figure> Drawing::draw(const WeightedDraws& draws) const {
  const std::vector<Spread> known = process ? process_spreads(*rows, *process, paths, draws)
                                            : spreads(*rows, paths, draws, most_points);
  std::vector<Band> bands;
  for (std::size_t i = 0; i < known.size(); ++i) bands.push_back(band_of(*this, i, known[i]));
  constexpr std::size_t fewest_multiples = 3;
  std::vector<html::Figure> figures = {figure_of(*this, 0, bands[0])};
  if (bands.size() > fewest_multiples) {
    for (html::Figure& each : panels_of(*this, bands)) figures.push_back(std::move(each));
  } else {
    for (std::size_t i = 1; i < bands.size(); ++i) figures.push_back(figure_of(*this, i, bands[i]));
  }
  return figures;
}

// The path; for a process with the scatter of its increments.
std::vector<formula::Wanted> path_parameters(const Measured& measured) {
  return {measured.wanted.begin(), measured.wanted.begin() + (measured.process ? 2 : 1)};
}

// Covers the requested positions and the median life.
double horizon(const Asked& asked, const LimitedPath& path, bool limited) {
  double farthest = path.begin + 1.2 * path.scale;
  for (const Quantity& at :
       asked.predict.quantities("at", formula::si_text(asked.axis().unit.powers))) {
    farthest = std::max(farthest, at.si());
  }
  if (!limited) return farthest;
  Crossing crossing(*path.next, path.rising, path.begin, path.scale);
  crossing.at().move_to(asked.start.data());
  double life = 0;
  crossing.solve(1, nullptr, &path.limit, &life);
  if (!std::isfinite(life)) return farthest;
  const double beyond = path.begin + 1.3 * (life - path.begin);
  return std::max(farthest, std::min(beyond, path.begin + 5 * path.scale));
}

void add_unit(const Asked& asked, const Measured& measured, const LimitedPath& axis, double far,
              std::optional<std::size_t> unit, Drawing& drawing) {
  const std::vector<formula::Wanted> wanted = path_parameters(measured);
  SpreadPath path{{axis.next, {}, 0}, unit, {}};
  Numbers traced;
  double from = axis.begin;
  if (unit) {
    path.path = seen_unit(asked, asked.predict, "along", wanted, *unit);
    if (measured.process) path.path.behind.reset();
    if (!measured.process)
      path.trace = make_trace(asked.model, asked.predict, "along", wanted, *unit);
    from = path.path.now;
    for (std::size_t row = 0; row < asked.model->data.table.rows; ++row) {
      if (path.trace && asked.model->unit_of_row[row] == *unit)
        traced.push_back(asked.axis().values[row]);
    }
    std::stable_sort(traced.begin(), traced.end());
  }
  for (std::size_t i = unit ? 0 : 1; i <= steps_ahead; ++i) {
    const double share = static_cast<double>(i) / steps_ahead;
    path.places.push_back(from + share * std::max(far - from, 0.1 * axis.scale));
  }
  path.rising = axis.rising;
  path.begin = axis.begin;
  path.scale = axis.scale;
  drawing.paths.push_back(std::move(path));
  drawing.of.push_back(unit ? asked.unit(*unit) : "new " + asked.noun);
  drawing.readings.push_back(readings_of(asked, measured, unit));
  drawing.traced.push_back(std::move(traced));
}

// The threshold, if it is of a measured path.
std::optional<double> limit_of(const Asked& asked, const Measured& measured, const Path& path) {
  const auto limits = asked.predict.table("limit");
  if (!limits) return {};
  const std::string name = limits->keys().front();
  if (measured.process) {
    if (name != measured.column) return {};
    return limits->required_quantity(name, formula::si_text(measured.powers)).si();
  }
  const auto limited =
      make_path(asked.model, *limits, name, {{"[predict] limit", name}}, true, asked.common);
  if (limited->program.text(0) != path.program.text(0)) return {};
  return limits->required_quantity(name, formula::si_text(limited->program.outputs()[0].powers))
      .si();
}

// All units, or if there are many those whose last reading is nearest to the threshold.
std::vector<std::size_t> drawn_units(const Asked& asked, const Measured& measured,
                                     const LimitedPath& path, const Drawing& drawing) {
  std::vector<std::size_t> units(asked.model->units.size());
  std::iota(units.begin(), units.end(), std::size_t{0});
  if (units.size() <= most_figures) return units;
  if (drawing.limit) {
    Numbers place(units.size(), -INFINITY), last(units.size(), path.rising ? -INFINITY : INFINITY);
    for (std::size_t i = 0; i < measured.observed.rows.size(); ++i) {
      const std::size_t row = measured.observed.rows[i], unit = asked.model->unit_of_row[row];
      if (measured.observed.responses[i].seen != Censoring::none) continue;
      if (asked.axis().values[row] < place[unit]) continue;
      place[unit] = asked.axis().values[row];
      last[unit] = measured.observed.responses[i].at;
    }
    std::stable_sort(units.begin(), units.end(), [&](std::size_t a, std::size_t b) {
      return path.rising ? last[a] > last[b] : last[a] < last[b];
    });
  }
  units.resize(most_figures);
  return units;
}

std::shared_ptr<const Drawing> drawing_of(const Asked& asked, const Measured& measured) {
  auto drawing = std::make_shared<Drawing>();
  drawing->rows = asked.rows;
  drawing->along = asked.axis().name;
  drawing->noun = asked.noun;
  drawing->quantity = measured.column;
  drawing->axis = asked.axis().unit.unit;
  drawing->unit = measured.unit;
  LimitedPath path;
  path.next =
      make_path(asked.model, asked.predict, "along", path_parameters(measured), true, asked.common);
  set_reach(asked, path);
  drawing->limit = limit_of(asked, measured, *path.next);
  path.limit = drawing->limit.value_or(0);
  const double far = horizon(asked, path, drawing->limit.has_value());
  add_unit(asked, measured, path, far, {}, *drawing);
  if (measured.process) {
    const auto column = static_cast<std::size_t>(&measured - asked.model->measured.data());
    drawing->process = ProcessLimit{column, path};
  }
  if (!asked.model->label && !path.next->goes_on() && !measured.process) return drawing;
  const std::vector<std::size_t> drawn = drawn_units(asked, measured, path, *drawing);
  for (const std::size_t unit : drawn) add_unit(asked, measured, path, far, unit, *drawing);
  drawing->left_out = asked.model->units.size() - drawn.size();
  return drawing;
}

}  // namespace

void add_path_figures(const Asked& asked, PosteriorStudy& study) {
  std::vector<std::shared_ptr<const Drawing>> all;
  for (const Measured& measured : asked.model->measured) {
    if (has_path(measured) || measured.process) all.push_back(drawing_of(asked, measured));
  }
  if (all.empty()) return;
  study.figures = [all](const Fit& fit) {
    std::map<std::string, std::vector<html::Figure>> figures;
    for (const auto& each : all) {
      std::vector<html::Figure> own = each->draw(fit.exact ? fit.exact->nodes : fit.pooled);
      figures["verdict"].push_back(std::move(own.front()));
      std::move(own.begin() + 1, own.end(), std::back_inserter(figures["predictions"]));
    }
    return figures;
  };
}

}  // namespace wearwell::formula_model
