#include "wearwell/prob/gathered_responses.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "wearwell/base/stop_scope.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/gauss_of_points.h"

namespace wearwell {
namespace {

constexpr int nodes_of_cell = 6;
constexpr double cells_of_spread = 8;

// The standard deviation of a normal distribution with their quartiles: a few values far out do not widen it.
double spread_of(std::vector<double> values) {
  constexpr double quartiles = 1.349;
  const auto quantile = [&](std::size_t at) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(at);
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  const double low = quantile(values.size() / 4), high = quantile(3 * values.size() / 4);
  return (high - low) / quartiles;
}

// Cells of this width; of none only equal values are one.
std::vector<WeightedPoint> in_cells(std::vector<WeightedPoint> points, double width) {
  std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    check_stop();
    return a.at < b.at;
  });
  const auto cell = [&](const WeightedPoint& each) {
    return width > 0 ? std::floor(each.at / width) : each.at;
  };
  std::vector<WeightedPoint> all;
  for (std::size_t begin = 0; begin < points.size();) {
    std::size_t end = begin;
    while (end < points.size() && cell(points[end]) == cell(points[begin])) ++end;
    const auto nodes =
        gauss_of_points(std::span(points).subspan(begin, end - begin), nodes_of_cell);
    all.insert(all.end(), nodes.begin(), nodes.end());
    begin = end;
  }
  return all;
}

}  // namespace

std::vector<WeightedResponse> gathered_responses(std::span<const Response> responses,
                                                 std::span<const double> counts, bool positive) {
  const auto place = [&](double y) { return positive ? std::log(y) : y; };
  struct Kind {
    Censoring seen;
    double sign;
    std::vector<WeightedPoint> points = {};
  };
  Kind exact{Censoring::none, 1}, above{Censoring::right, 1}, below{Censoring::left, 1},
      entry{Censoring::right, -1};
  std::map<std::pair<double, double>, double> intervals;
  std::vector<double> places;
  std::vector<WeightedResponse> all;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const Response& y = responses[i];
    if (!std::isfinite(place(y.at))) {  // of no cell
      all.push_back({y, counts[i]});
      continue;
    }
    places.push_back(place(y.at));
    if (y.entry > -infinity) entry.points.push_back({place(y.entry), counts[i]});
    if (y.seen == Censoring::interval) {
      intervals[{y.at, y.until}] += counts[i];
      continue;
    }
    Kind& kind = y.seen == Censoring::none ? exact : y.seen == Censoring::right ? above : below;
    kind.points.push_back({places.back(), counts[i]});
  }
  const double width = places.empty() ? 0 : spread_of(std::move(places)) / cells_of_spread;
  for (Kind* kind : {&exact, &above, &below, &entry}) {
    for (const WeightedPoint& node : in_cells(std::move(kind->points), width)) {
      const double y = positive ? std::exp(node.at) : node.at;
      all.push_back({{.seen = kind->seen, .at = y}, kind->sign * node.weight});
    }
  }
  for (const auto& [ends, count] : intervals) {
    all.push_back({{.seen = Censoring::interval, .at = ends.first, .until = ends.second}, count});
  }
  return all;
}

bool can_be_gathered(const ResponseForm& form) {
  if (form.counted) return false;
  return std::none_of(form.family_parameters.begin(), form.family_parameters.end(),
                      [&](const ParameterForm& family_parameter) {
                        return form.positive && family_parameter.kind == ParameterKind::location;
                      });
}

}  // namespace wearwell
