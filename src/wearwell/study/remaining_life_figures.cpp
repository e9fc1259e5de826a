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

constexpr std::size_t least_units = 3, most_named = 40;

// The remaining useful lives of units, in one unit of life and to the same limit.
struct Fleet {
  std::string name, unit;
  std::string to;                   ///< "to wear = 100 um, force = 20 N"
  std::optional<std::string> from;  ///< "from 30 km on", if all count from there
  std::vector<const QuantitySummary*> units = {};

  const QuantityQuantiles& of(std::size_t i) const { return units[i]->best(); }
};

// Splits "to wear = 100 um from 30 km on" in two.
std::pair<std::string, std::string> parted(const std::string& at) {
  const std::size_t from = at.rfind(" from ");
  if (from == at.npos || !at.ends_with(" on")) return {at, ""};
  return {at.substr(0, from), at.substr(from + 1)};
}

std::vector<Fleet> fleets_of(const std::vector<QuantitySummary>& quantities) {
  std::vector<Fleet> fleets;
  for (const QuantitySummary& each : quantities) {
    if (!each.is_life || !each.name.starts_with("remaining") || each.of.starts_with("new "))
      continue;
    const auto [to, from] = parted(each.at);
    auto found = std::find_if(fleets.begin(), fleets.end(), [&](const Fleet& fleet) {
      return fleet.name == each.name && fleet.unit == each.unit && fleet.to == to;
    });
    if (found == fleets.end()) {
      fleets.push_back({each.name, each.unit, to, from});
      found = fleets.end() - 1;
    }
    if (found->from != from) found->from.reset();
    found->units.push_back(&each);
  }
  std::erase_if(fleets, [](const Fleet& fleet) { return fleet.units.size() < least_units; });
  for (Fleet& fleet : fleets) {
    std::stable_sort(fleet.units.begin(), fleet.units.end(), [](const auto* a, const auto* b) {
      return std::pair(a->best().b10, a->best().q50) < std::pair(b->best().b10, b->best().q50);
    });
  }
  return fleets;
}

// The end of the axis: it includes all medians, but one unit with a wide interval does not compress
// the others.
double end_of_axis(const Fleet& fleet, std::size_t count) {
  double end = 0, middle = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const QuantityQuantiles& q = fleet.of(i);
    if (std::isfinite(q.q95)) end = std::max(end, q.q95);
    if (std::isfinite(q.q50)) middle = std::max(middle, q.q50);
  }
  if (middle > 0) end = std::min(end, 3 * middle);
  return end > 0 ? 1.03 * end : 1;
}

std::string caption(const Fleet& fleet) {
  const std::string from = !fleet.from           ? ", from where each stands now"
                           : fleet.from->empty() ? ""
                                                 : ' ' + *fleet.from;
  return html::raised(fleet.to + from);
}

std::string title(const Fleet& fleet) {
  return fmt::format("{} [{}]", html::capital(fleet.name), html::unit(fleet.unit));
}

html::Figure named_figure(const Fleet& fleet, std::size_t count) {
  std::vector<std::string> names(count);
  Numbers y, low, middle, high, b10;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t row = count - 1 - i;  // the first is at the top
    names[row] = fleet.units[i]->of;
    y.push_back(static_cast<double>(row + 1));
    const QuantityQuantiles& q = fleet.of(i);
    low.push_back(q.q05);
    middle.push_back(q.q50);
    high.push_back(q.q95);
    b10.push_back(q.b10);
  }
  const double end = end_of_axis(fleet, count);
  const std::vector<plot::Json> marks = {
      plot::ranges({{"x", within(0, 2 * end, high)},
                    {"x2", within(0, 2 * end, low)},
                    {"y", y},
                    {"lower 5 %", low},
                    {"upper 95 %", high}},
                   {colour::wide, "90 % interval", 0.8, 7}),
      plot::points({{"x", middle}, {"y", y}, {"median", middle}},
                   {colour::posterior, "median", 1, 0, false, 55}),
      plot::points({{"x", b10}, {"y", y}, {"B10", b10}}, {colour::limit, "B10", 1, 0, false, 35})};
  const std::size_t all = fleet.units.size();
  html::Figure figure{
      "remaining-lives",
      count < all
          ? fmt::format("{}: the {} most urgent of {}", html::capital(fleet.name), count, all)
          : fmt::format("{}, most urgent first", html::capital(fleet.name)),
      html::capital(caption(fleet)) + ". One in ten fails before its B10.",
      plot::plot(fmt::format("Intervals of {} of each unit, most urgent first", fleet.name),
                 {title(fleet), false, 0.0, end}, {"", false, {}, {}, names}, marks,
                 static_cast<int>(std::max<std::size_t>(120, 21 * count)))};
  figure.wide = count > 20;
  return figure;
}

// For very many units: one point each, sorted by urgency.
html::Figure ranked_figure(const Fleet& fleet) {
  Numbers low, middle, high, b10;
  for (std::size_t i = 0; i < fleet.units.size(); ++i) {
    const QuantityQuantiles& q = fleet.of(i);
    low.push_back(q.q05);
    middle.push_back(q.q50);
    high.push_back(q.q95);
    b10.push_back(q.b10);
  }
  const Numbers x = counted(fleet.units.size());
  const double end = end_of_axis(fleet, fleet.units.size());
  const auto drawn = [&](const Numbers& values) { return within(0, 2 * end, values); };
  html::Figure figure{
      "remaining-lives-all",
      fmt::format("{} of all {} units", html::capital(fleet.name), fleet.units.size()),
      html::capital(caption(fleet)) + ". The table has the name of each.",
      plot::plot(
          fmt::format("{} of all units by urgency", html::capital(fleet.name)),
          {"Units, most urgent first", false, 1.0, x.back()}, {title(fleet), false, 0.0, end},
          {plot::ranges({{"x", x}, {"y", drawn(low)}, {"y2", drawn(high)}},
                        {colour::wide, "90 % interval", 0.5, 1}),
           plot::points({{"x", x}, {"y", drawn(middle)}, {"median", middle}},
                        {colour::posterior, "median", 1, 0, false, 8}),
           plot::line({{"x", x}, {"y", drawn(b10)}, {"B10", b10}}, {colour::limit, "B10", 1, 1.5})},
          300)};
  figure.wide = true;
  return figure;
}

}  // namespace

std::vector<html::Figure> remaining_life_figures(const PosteriorSummary& result) {
  std::vector<html::Figure> figures;
  for (const Fleet& fleet : fleets_of(result.quantities)) {
    std::vector<html::Figure> own = {named_figure(fleet, std::min(most_named, fleet.units.size()))};
    if (fleet.units.size() > most_named) own.push_back(ranked_figure(fleet));
    const std::size_t before = figures.size();
    for (html::Figure& each : own) {
      if (before > 0) each.id += fmt::format("-{}", before);
      figures.push_back(std::move(each));
    }
  }
  return figures;
}

}  // namespace wearwell
